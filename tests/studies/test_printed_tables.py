"""Tables 2 and 3 computed: how near the formula and the frame come to what is printed."""

import json

import numpy as np
import pandas as pd
import pytest
from mpi4py import MPI

from morphing_wing import table3 as table3_module
from morphing_wing.errors import InputError
from morphing_wing.printed_tables import TABLE_2, TABLE_3
from morphing_wing.rib import Rib
from morphing_wing.table2 import table2
from morphing_wing.table3 import READINGS, readings_of, rib_of, table3
from morphing_wing.table_report import report

pytestmark = pytest.mark.quick


@pytest.fixture(scope="module")
def frame():
    return table3(["draft"], ["flush"], comm=MPI.COMM_SELF)


def means(study):
    levels = study.levels()
    computed = levels[levels["fidelity"] != "printed"]
    return {name: list(part["mean_deg"]) for name, part in computed.groupby("factor")}


def test_the_formula_is_what_table_2_was_printed_from():
    [found] = table2(["instant"], comm=MPI.COMM_SELF).misfits()
    assert found["rows"] == 9 and "fitted_torque_Nmm" not in found
    assert found["mean"] < 0.0025 and found["largest"] < 0.006 and found["largest_in_row"] == 6


def test_the_untested_best_combination_of_table_2_bends_more_than_any_row():
    study = table2(["instant"], comm=MPI.COMM_SELF)
    angles = study.table()["span_angle_deg"]
    assert len(angles) == 10 and angles.idxmax() == 9
    assert "By instant the untested combination bends by 18.41 deg" in study.sentences()[-1]


def test_the_flush_frame_has_the_level_means_of_table_3(frame):
    found, printed = means(frame), TABLE_3.levels.groupby("factor")["mean"].apply(list)
    for factor in ("T_rs/l_cs", "D_cs/l_rs"):
        assert found[factor] == pytest.approx(printed[factor], rel=0.03)
    assert found["alpha"] == pytest.approx(printed["alpha"], rel=0.06)
    [misfit] = frame.misfits()
    assert misfit["rms"] == pytest.approx(0.052, abs=0.002)


def test_the_moment_is_fitted_once_for_all_rows_by_least_squares(frame):
    table = frame.table()
    assert table["fitted_torque_Nmm"].nunique() == 1
    assert table["fitted_torque_Nmm"][0] == pytest.approx(38.57, abs=0.05)
    residuals = table["chord_angle_deg"] - table["printed_deg"]
    assert residuals @ table["deg_per_Nmm"] == pytest.approx(0.0, abs=1e-9)


def test_scaling_one_small_solve_is_as_good_as_solving_under_the_moment(frame):
    row = frame.table().iloc[0]
    rib = Rib(rib_of(row, "flush"), comm=MPI.COMM_SELF)
    solved = rib.bend(torque=row["fitted_torque_Nmm"])[-1]
    assert row["chord_angle_deg"] == pytest.approx(solved.measures["chord_angle_deg"], rel=0.005)
    assert row["energy_Nmm"] == pytest.approx(solved.energy_Nmm, rel=0.01)


def test_a_row_of_table_3_is_a_rib_of_the_printed_lengths():
    rib = rib_of(TABLE_3.rows.iloc[1], "square, bosses")
    assert (rib.shaft_length, rib.shaft_thickness, rib.pivot_diameter, rib.pivot_length) == (
        6.5, 1.5, 1.5, 5.0)
    assert (rib.crossing_angle, rib.n_cells, rib.section, rib.bosses) == (80.0, 6, "square", True)


def test_the_formula_knows_no_bosses():
    assert readings_of("instant") == ("flush", "square")
    assert readings_of("draft") == tuple(READINGS)


def test_a_row_that_cannot_be_modelled_is_told_and_the_others_are_fitted(monkeypatch, tmp_path):
    def picky(geometry, **keywords):
        if geometry.shaft_length == 4.5:
            raise InputError("shaft_length = 4.5 mm: must be longer, parts collide")
        return Rib(geometry, **keywords)

    monkeypatch.setattr(table3_module, "Rib", picky)
    study = table3(["instant"], ["flush"], comm=MPI.COMM_SELF)
    assert study.converged and study.misfits()[0]["rows"] == 6
    assert list(study.levels()["fidelity"].unique()) == ["printed"]  # no longer orthogonal
    assert sum("refused: shaft_length = 4.5 mm" in said for said in study.sentences()) == 3
    study.save(tmp_path)
    summary = json.loads((tmp_path / "summary.json").read_text())
    assert summary["chord_angle_deg"][2] is None and "refused" in summary
    assert any("refused" in column._cells for column in next(report(study)).columns)


def test_what_is_written_reads_back(frame, tmp_path):
    frame.save(tmp_path)
    assert {file.name for file in tmp_path.iterdir()} == {
        "table.csv", "levels.csv", "summary.json", "table3.png"}
    table = pd.read_csv(tmp_path / "table.csv")
    np.testing.assert_allclose(table["chord_angle_deg"], frame.table()["chord_angle_deg"])
    summary = json.loads((tmp_path / "summary.json").read_text())
    assert (summary["fidelity"], summary["dofs"], summary["converged"]) == ("draft", 1572, True)
    assert summary["series"][0]["fitted_torque_Nmm"] == pytest.approx(38.57, abs=0.05)
    assert summary["in_series"] == [0] * 9 and "numpy" in summary["versions"]


@pytest.mark.parametrize("study, scene", [(table2, "spar"), (table3, "rib")])
def test_unknown_rungs_are_refused(study, scene):
    with pytest.raises(InputError, match="fidelity = 'best': must be one of instant"):
        study(["best"])


def test_tables_are_complete():
    for printed in (TABLE_2, TABLE_3):
        assert len(printed.levels) == 9 and printed.rows["printed_deg"].notna().all()
