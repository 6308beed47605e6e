"""Figure 6: one factor at a time, and what the paper says of it."""

import json

import numpy as np
import pandas as pd
import pytest
from mpi4py import MPI

from morphing_wing.errors import InputError
from morphing_wing.figure5_curves import Curve
from morphing_wing.figure6 import study as module
from morphing_wing.figure6.cases import read_cases, write_cases
from morphing_wing.figure6.points import PANELS
from morphing_wing.figure6.report import report
from morphing_wing.figure6.result import LINEAR_UP_TO
from morphing_wing.figure6.study import figure6
from morphing_wing.ladder import LADDERS
from morphing_wing.rib import Rib
from morphing_wing.table3 import rib_of

pytestmark = pytest.mark.quick

SPAR = PANELS["spar"]


@pytest.fixture(scope="module")
def formula():
    return figure6(["instant"], comm=MPI.COMM_SELF)


@pytest.fixture(scope="module")
def frame():
    """Return the rib's frame alone, beside the spar's formula."""
    only_ribs = pytest.MonkeyPatch()
    only_ribs.setitem(LADDERS, "spar", ("instant",))
    found = figure6(["instant", "draft"], ["flush"], MPI.COMM_SELF)
    only_ribs.undo()
    return found


# -- the points ---------------------------------------------------------------------------------


@pytest.mark.parametrize("panel", PANELS.values(), ids=PANELS)
def test_each_factor_has_six_values_and_the_others_stay_in_the_middle(panel):
    assert list(panel.points.groupby("factor", sort=False).size()) == [6, 6, 6]
    for factor, rows in panel.points.groupby("factor"):
        assert rows["value"].is_monotonic_increasing and rows["value"].is_unique
        assert set(panel.tabled[factor]) < set(rows[factor])
        for other in set(panel.levels) - {factor}:
            assert set(rows[other]) == {panel.middle[other]}
    assert len(panel.points[list(panel.levels)].drop_duplicates()) == 16


@pytest.mark.parametrize("panel", PANELS.values(), ids=PANELS)
def test_three_rows_of_the_papers_table_are_points(panel):
    printed = panel.points[panel.points["row"].notna()]
    assert sorted(printed["row"]) == [2, 4, 5]
    both = printed.merge(panel.table.rows, on=["row", *panel.levels])
    assert len(both) == 3 and (both["printed_deg_x"] == both["printed_deg_y"]).all()


# -- the study ----------------------------------------------------------------------------------


def test_the_formula_gives_l_s1_three_quarters_of_the_effect_of_h_t(formula):
    said = {claim["claim"]: claim for claim in formula.claims() if claim["scene"] == "spar"}
    little = said["l_s1 and l_c nearly have little effect"]
    assert not little["holds"] and "l_s1 has 75% of h_t's effect, l_c 10%" in little["figures"]
    assert said["the effect of h_t is quite prominent, the angle increases as h_t reduces"]["holds"]
    assert len(said) == 2  # a formula's walls do not balloon


def test_the_formula_of_the_spar_has_the_printed_rows(formula):
    part = formula.part(Curve("spar", "instant"))
    printed = part[part["printed_deg"].notna()]
    assert printed["span_angle_deg"].to_numpy() == pytest.approx(printed["printed_deg"], rel=0.004)


def test_the_middle_is_solved_once_and_a_point_of_every_factor(formula):
    assert [len(rows) for rows in formula.solved.values()] == [16, 16, 16]
    table = formula.table()
    assert len(table) == 3 * 18
    middle = table[(table["scene"] == "spar") & (table[list(SPAR.levels)] == pd.Series(
        SPAR.middle)).all(axis=1)]
    assert len(middle) == 3 and middle["span_angle_deg"].nunique() == 1
    assert list(middle["seconds"] > 0.0) == [True, False, False]


def test_the_moment_is_fitted_to_three_rows_and_angles_are_proportional_to_it(frame):
    part = frame.part(Curve("rib", "draft", "flush"))
    [moment] = part["fitted_torque_Nmm"].unique()
    printed = part[part["printed_deg"].notna()]
    off = printed["printed_deg"] - printed["chord_angle_deg"]
    assert off @ printed["deg_per_Nmm"] == pytest.approx(0.0, abs=1e-9)
    assert moment == pytest.approx(38.6, abs=0.8)  # near that of all nine rows
    row = part.loc[part["chord_angle_deg"].idxmax()]
    assert row["T_rs/l_cs"] == "0.75/5" and row["chord_angle_deg"] < LINEAR_UP_TO
    solved = Rib(rib_of(row, "flush"), comm=MPI.COMM_SELF).bend(torque=moment)[-1]
    assert solved.measures["chord_angle_deg"] == pytest.approx(row["chord_angle_deg"], rel=0.005)


def test_at_120_degrees_a_frame_has_one_per_cent_less_than_when_it_is_scaled():
    thin = Rib(rib_of({**PANELS["rib"].middle, "T_rs/l_cs": "0.75/5"}, "square"),
               comm=MPI.COMM_SELF)
    scaled, solved = (state.measures["chord_angle_deg"] for state in thin.bend(torque=[1.0, 17.0]))
    assert solved == pytest.approx(120.0, abs=1.0)
    assert solved / (17.0 * scaled) == pytest.approx(0.990, abs=0.001)


def test_flush_frames_have_what_the_paper_says_of_ribs(frame):
    assert [claim["holds"] for claim in frame.claims() if claim["fidelity"] == "draft"] == [
        True, True]


def test_a_rib_whose_parts_collide_is_told_and_the_others_are_computed(monkeypatch, tmp_path):
    def picky(geometry, **keywords):
        if geometry.crossing_angle == 60.0:
            raise InputError("crossing_angle = 60 degrees: must be larger, parts collide")
        return Rib(geometry, **keywords)

    monkeypatch.setattr(module, "Rib", picky)
    study = figure6(["instant"], ["square"], MPI.COMM_SELF)
    assert study.converged
    assert ("rib, instant, square, alpha = 60 degrees, refused: crossing_angle = 60 degrees: must "
            "be larger, parts collide") in study.sentences()
    study.save(tmp_path)
    summary = json.loads((tmp_path / "summary.json").read_text())
    assert summary["chord_angle_deg"][18] is None and summary["refused"][18] != ""
    assert [fact["points"] for fact in summary["sensitivities"]] == [6, 6, 6, 5, 6, 6]


def test_a_spar_that_stops_before_its_pressure_is_told_and_its_angle_is_missing(monkeypatch):
    monkeypatch.setattr(module, "PRESSURE", 5.0)
    study = figure6(["instant"], ["flush"], MPI.COMM_SELF)
    assert not study.converged
    table = study.table()
    stopped = table[table["stopped"] != ""]
    assert len(stopped) and stopped["span_angle_deg"].isna().all()
    assert any("the formula goes to" in said for said in study.sentences())
    assert list(report(study))  # told all the same


def test_a_run_goes_on_after_the_cases_that_were_solved_and_is_the_same(frame, tmp_path):
    write_cases(frame, tmp_path)
    before = read_cases(MPI.COMM_SELF, tmp_path)
    assert before == frame.solved  # to the last digit
    curve = Curve("rib", "draft", "flush")
    first = dict(list(before[curve].items())[:13])
    solved = []
    again = figure6(["draft"], ["flush"], MPI.COMM_SELF, before={
        curve: first, Curve("spar", "draft"): spars_made_up()},
        told=lambda study, curve, row: solved.append(row))
    assert len(solved) == 3
    ours, theirs = (study.part(curve).drop(columns="seconds") for study in (again, frame))
    pd.testing.assert_frame_equal(ours, theirs, check_exact=True)


def spars_made_up():
    """Return cases of a spar, so that none is solved."""
    return {levels: dict(zip(SPAR.levels, levels, strict=True)) | {
        "span_angle_deg": 1.0, "refused": "", "stopped": "", "seconds": 1.0, "dofs": 1,
        "newton_iterations": 1, "energy_Nmm": 1.0}
        for levels in SPAR.points[list(SPAR.levels)].itertuples(index=False, name=None)}


@pytest.mark.parametrize("text, sentence", [
    (None, "must hold a solved.csv"), ("", "must be a table of cases"),
    ("a,b\n1,2\n", "must be a table of cases"),
    ("scene,fidelity,reading,l_s1,l_c,h_t,refused,stopped\nspar,cell,,2.0,2.4,1.2,,\n",
     "a row of spar, cell lacks"),
    ("scene,fidelity,reading,refused,stopped\nwing,draft,,,\n", "must be a table of cases"),
])
def test_a_file_that_cannot_be_gone_on_from_is_refused(text, sentence, tmp_path):
    if text is not None:
        (tmp_path / "solved.csv").write_text(text)
    with pytest.raises(InputError, match=sentence):
        read_cases(MPI.COMM_SELF, tmp_path)


def test_what_is_written_reads_back(frame, tmp_path):
    frame.save(tmp_path)
    assert {file.name for file in tmp_path.iterdir()} == {
        "table.csv", "sensitivities.csv", "summary.json", "fig6.png"}
    table = pd.read_csv(tmp_path / "table.csv")
    np.testing.assert_allclose(table["chord_angle_deg"], frame.table()["chord_angle_deg"])
    assert list(table.groupby(["scene", "fidelity"]).size()) == [18, 18, 18]
    summary = json.loads((tmp_path / "summary.json").read_text())
    assert (summary["study"], summary["fidelity"], summary["converged"]) == ("fig6", "draft", True)
    assert summary["in_series"] == [i for i in range(3) for _ in range(18)]
    assert len(summary["factor"]) == 54 and "numpy" in summary["versions"]
    assert "not at hand" in summary["sentences"][0]


def test_unknown_rungs_and_readings_are_refused():
    with pytest.raises(InputError, match="fidelity = 'best': must be one of instant, cell"):
        figure6(["best"])
    with pytest.raises(InputError, match="reading = 'round': must be one of flush, square"):
        figure6(["instant"], ["round"])
