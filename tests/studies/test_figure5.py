"""Figure 5: formulas against finite elements, both halves."""

import json

import pandas as pd
import pytest
from mpi4py import MPI

from morphing_wing.errors import InputError
from morphing_wing.figure5 import FIDELITIES, figure5
from morphing_wing.ladder import LADDERS

pytestmark = pytest.mark.quick


@pytest.fixture(scope="module")
def study():
    """Return the formula and the frame: one rung of the spar, two of the rib."""
    only_ribs = pytest.MonkeyPatch()
    only_ribs.setitem(LADDERS, "spar", ("instant",))
    found = figure5(["instant", "draft"], 2, MPI.COMM_SELF)
    only_ribs.undo()
    return found


def test_the_formulas_have_the_known_angles(study):
    facts = {(fact["scene"], fact["fidelity"], fact["reading"]): fact for fact in study.facts()}
    assert facts["spar", "instant", ""]["last_angle_deg"] == pytest.approx(26.133, abs=1e-3)
    assert facts["rib", "instant", "square"]["slope"] == pytest.approx(1.94, abs=0.005)


def test_the_frame_is_linear_and_the_formula_apart_from_it_by_the_reading(study):
    facts = {fact["reading"]: fact for fact in study.facts() if fact["fidelity"] == "draft"}
    assert facts["flush"]["slope"] == pytest.approx(1.029, rel=0.002)
    for fact in facts.values():
        assert abs(fact["off_line"]) < 0.005
    assert facts["flush"]["formula_last"] == pytest.approx(0.139, abs=0.002)
    assert facts["square"]["formula_last"] == pytest.approx(0.022, abs=0.002)


def test_what_is_written_reads_back(study, tmp_path):
    study.save(tmp_path)
    assert {file.name for file in tmp_path.iterdir()} == {"table.csv", "summary.json", "fig5.png"}
    table = pd.read_csv(tmp_path / "table.csv")
    assert len(table) == 5 * 3 and {"torque_Nmm", "pressure_MPa"} < set(table)
    summary = json.loads((tmp_path / "summary.json").read_text())
    assert (summary["fidelity"], summary["dofs"], len(summary["curves"])) == ("draft", 1572, 5)
    assert summary["curve"] == [i for i in range(5) for _ in range(3)]


def test_the_usual_rungs_are_the_formula_and_one_of_each_ladder():
    for scene, rungs in FIDELITIES.items():
        assert rungs[0] == "instant" and set(rungs) < set(LADDERS[scene])


def test_unknown_rungs_are_refused():
    with pytest.raises(InputError, match="fidelity = 'best': must be one of instant, cell"):
        figure5(["best"])
