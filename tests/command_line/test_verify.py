"""``morphing-wing verify``: prints what differs, and its status says whether all holds."""

import pytest

from morphing_wing import verification
from morphing_wing.cli import main
from morphing_wing.verification import PROBLEMS, Check, NoEquilibriumError, Problem
from morphing_wing.verify_command import verify

pytestmark = pytest.mark.quick


def problem(name, run, quick=False):
    return Problem(name, f"title of {name}", "theory", run, quick)


def right(comm):
    yield Check("length", 1.0001, 1.0, "mm", 1e-3)


def wrong(comm):
    yield Check("length", 1.0001, 1.0, "mm", 1e-3)
    yield Check("force", 1.1, 1.0, "N", 1e-3)


def failing(comm):
    yield Check("length", 1.0, 1.0, "mm", 1e-3)
    raise NoEquilibriumError("Newton used up its iterations")


@pytest.fixture(autouse=True)
def made_up(monkeypatch):
    found = {"right": problem("right", right, quick=True), "wrong": problem("wrong", wrong),
             "failing": problem("failing", failing)}
    monkeypatch.setattr(verification, "PROBLEMS", found)


@pytest.mark.parametrize("arguments, status, said", [
    (["right"], 0, "all 1 hold"), (["--quick"], 0, "all 1 hold"), (["wrong"], 4, "1 of 2 hold"),
    (["failing"], 4, "1 of 2 hold"), ([], 4, "3 of 5 hold")])
def test_status_and_last_line_say_whether_all_holds(arguments, status, said, capsys):
    assert main(["verify", *arguments]) == status
    assert capsys.readouterr().out.rstrip().splitlines()[-1] == said


def test_a_row_has_value_reference_error_and_verdict(capsys):
    main(["verify", "wrong"])
    [row] = [line for line in capsys.readouterr().out.splitlines() if "force" in line]
    assert row.split() == ["force", "in", "N", "1.1", "1", "1.0e-01", "1.0e-03", "DOES", "NOT",
                           "HOLD"]


def test_a_problem_without_a_solution_says_why(capsys):
    main(["verify", "failing"])
    assert "not solved: Newton used up its iterations" in capsys.readouterr().out


@pytest.mark.parametrize("arguments, sentence", [
    (["sphere"], "problem 'sphere': must be one of right, wrong, failing"),
    (["wrong", "--quick"], "--quick: none of the problems named is quick")])
def test_unknown_problems_are_refused(arguments, sentence, capsys):
    assert main(["verify", *arguments]) == 2
    assert capsys.readouterr().err.strip() == f"morphing-wing: {sentence}"


def test_help_names_all_problems_the_quick_ones_first():
    quick, others = (part.split(".")[0].replace("\n", " ").split(",")
                     for part in verify.__doc__.partition("Quick ones:")[2].split("Others:"))
    assert {name.strip() for name in quick} == {p.name for p in PROBLEMS.values() if p.quick}
    assert {name.strip() for name in others} == {p.name for p in PROBLEMS.values() if not p.quick}
