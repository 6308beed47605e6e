"""``morphing-wing optimize``: what it prints, writes and returns; stopped, resumed, refused."""

import contextlib
import json
import os
import signal
import subprocess
import sys
import time

import pandas as pd
import pytest

from morphing_wing.built_in import built_in_problems
from morphing_wing.cli import main
from morphing_wing.interrupts import interrupts_noticed
from morphing_wing.optimization import optimum as study
from morphing_wing.optimization.problem_file import read_problem

pytestmark = pytest.mark.quick

BIN = os.path.join(os.path.dirname(sys.executable), "morphing-wing")
RIB = """scene = "rib-validation"
maximize = "chord_angle_deg"
rungs = ["instant", "draft"]
[base]
loads.torque = "10 N mm"
[variables]
geometry.shaft_thickness = { low = "1.1 mm", high = "1.5 mm" }
geometry.pivot_length = { low = "5.0 mm", high = "6.0 mm" }
[constraints]
mass_g = { max = "base" }
"""


@pytest.fixture
def rib(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "rib.toml").write_text(RIB)
    return tmp_path


def test_built_in_problems_are_listed_printed_and_whole(capsys):
    assert main(["optimize"]) == 0
    said = capsys.readouterr().out
    for name, text in built_in_problems().items():
        assert f"{name}  " in said and text.splitlines()[0].lstrip("# ") in said
        assert main(["optimize", name, "--print"]) == 0
        assert capsys.readouterr().out == text
        assert read_problem(name).rungs[0] == "instant"


def test_a_limit_that_the_formula_does_not_know_is_not_said_to_hold(rib, capsys):
    (rib / "rib.toml").write_text(RIB + 'rib_stress_MPa = { max = "35 MPa" }\n')
    assert main(["optimize", "rib.toml"]) == 0
    said = capsys.readouterr().out.splitlines()
    formula = [line for line in said if line.startswith("instant ")]
    assert formula and all("holds the limits it knows, not rib_stress_MPa" in line
                           for line in formula if "passes" not in line)
    assert any(line.startswith("draft ") and "holds all limits" in line for line in said)


def test_results_are_written_told_and_the_design_is_a_scene(rib, capsys):
    assert main(["optimize", "rib.toml"]) == 0
    said = capsys.readouterr().out
    assert "draft 1, start: chord_angle_deg" in said and "holds all limits" in said
    assert "Variables, on the rung 'draft'" in said and "Limits, on the rung 'draft'" in said
    folder = rib / "output" / "rib"
    assert sorted(file.name for file in folder.iterdir()) == [
        "design.toml", "optimum.png", "summary.json", "table.csv"]
    best = json.loads((folder / "summary.json").read_text())["best"]
    assert main(["solve", str(folder / "design.toml"), "--out", "again"]) == 0
    again = json.loads((rib / "again" / "summary.json").read_text())
    assert again["fidelity"] == best["rung"] == "draft"
    assert again["chord_angle_deg"][-1] == pytest.approx(best["chord_angle_deg"], rel=1e-12)


def test_a_stopped_run_leaves_what_it_found_and_resumes_to_the_same_end(
    rib, capsys, monkeypatch
):
    assert main(["optimize", "rib.toml", "--out", "whole"]) == 0
    computed = []

    def interrupted(*given):
        computed.append(given)
        if len(computed) == 5:
            raise KeyboardInterrupt
        return run_case(*given)

    run_case = study.run_case
    monkeypatch.setattr(study, "run_case", interrupted)
    assert main(["optimize", "rib.toml", "--out", "run"]) == 130
    said = capsys.readouterr()
    assert "what was found is in run, --resume goes on" in said.out
    assert said.err.strip() == "morphing-wing: interrupted"
    summary = json.loads((rib / "run" / "summary.json").read_text())
    assert len(pd.read_csv(rib / "run" / "table.csv")) == 4
    assert not summary["converged"] and summary["reason"].startswith("stopped before all rungs")
    assert (rib / "run" / "design.toml").exists() and (rib / "run" / "optimum.png").exists()
    assert main(["optimize", "rib.toml", "--out", "run", "--resume"]) == 0
    tables = [pd.read_csv(rib / name / "table.csv").drop(columns="seconds")
              for name in ("whole", "run")]
    pd.testing.assert_frame_equal(*tables)
    assert len(computed) == 1 + len(tables[0])


def test_ctrl_c_in_a_terminal_leaves_what_was_found(rib):
    process = subprocess.Popen([BIN, "optimize", "rib.toml", "--out", "run"], text=True,
                               stdout=subprocess.PIPE, stderr=subprocess.PIPE)
    patience = time.monotonic() + 100.0
    while not (rib / "run" / "table.csv").exists() and time.monotonic() < patience:
        time.sleep(0.05)
    process.send_signal(signal.SIGINT)
    _, error = process.communicate(timeout=100)
    assert process.returncode == 130 and error.splitlines()[-1] == "morphing-wing: interrupted"
    assert len(pd.read_csv(rib / "run" / "table.csv")) >= 1
    assert (rib / "run" / "optimum.png").exists()


def test_ctrl_c_that_something_swallows_is_raised_after_it():
    with pytest.raises(KeyboardInterrupt), interrupts_noticed():
        with contextlib.suppress(KeyboardInterrupt):
            signal.raise_signal(signal.SIGINT)
        went_on = True
    assert went_on
    with interrupts_noticed():
        pass
    assert signal.getsignal(signal.SIGINT) is signal.default_int_handler


def test_a_search_that_runs_out_of_designs_is_not_done(rib):
    angle = 'geometry.crossing_angle = { low = "80 deg", high = "100 deg" }\n[constraints]'
    (rib / "rib.toml").write_text("evaluations = 5\n" + RIB.replace("[constraints]", angle))
    assert main(["optimize", "rib.toml", "--out", "run"]) == 3
    summary = json.loads((rib / "run" / "summary.json").read_text())
    assert "5 evaluations were made" in summary["reason"] and not summary["converged"]


def test_another_problem_is_not_resumed(rib, capsys):
    assert main(["optimize", "rib.toml", "--out", "run", "--resume"]) == 2
    assert "--resume: run must hold the summary.json" in capsys.readouterr().err
    (rib / "rib.toml").write_text(RIB.replace('"instant", "draft"', '"instant"'))
    assert main(["optimize", "rib.toml", "--out", "run"]) == 0
    (rib / "rib.toml").write_text(RIB.replace("6.0 mm", "7.0 mm"))
    capsys.readouterr()
    assert main(["optimize", "rib.toml", "--out", "run", "--resume"]) == 2
    said = capsys.readouterr().err
    assert "--resume: run holds another problem, its variables must be the same" in said


def test_more_rungs_may_be_added_on_resuming(rib, capsys):
    (rib / "rib.toml").write_text(RIB.replace('"instant", "draft"', '"instant"'))
    assert main(["optimize", "rib.toml", "--out", "run"]) == 0
    (rib / "rib.toml").write_text(RIB)
    assert main(["optimize", "rib.toml", "--out", "run", "--resume"]) == 0
    assert set(pd.read_csv(rib / "run" / "table.csv")["rung"]) == {"instant", "draft"}
