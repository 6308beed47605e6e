"""Figure 7 run on a small wing: which curves, what is kept of them, what is written."""

import json
from dataclasses import replace

import pandas as pd
import pytest
from mpi4py import MPI

from morphing_wing.errors import InputError
from morphing_wing.figure7 import figure7
from morphing_wing.figure7_facts import KEYS
from morphing_wing.figure7_result import Curve, Figure7
from morphing_wing.geometry.wing import WingGeometry
from morphing_wing.newton import Newton, NewtonResult
from morphing_wing.path import Path
from morphing_wing.progress import Progress
from tests.scenes.small_wing import GEOMETRY, MESHING

# What goes with a skin must not hinder the curves without one.
SMALL = {"geometry": replace(GEOMETRY, skin_root="free"), "meshing": MESHING, "comm": MPI.COMM_SELF}
DOWN, UP = (Curve("pressure", False, d, "draft") for d in ("down", "up"))
PULLED, RAISED = (Curve("cables", False, d, "draft") for d in ("down", "up"))


@pytest.fixture(scope="module")
def study():
    begun, ended = [], []

    def begin(curve, wing):
        begun.append((curve, wing.has_skin, wing.geometry.cable_guide))
        return Progress(wing.comm)

    def done(study, curve, path):
        assert curve in study.paths and all(state.fields for state in path)
        ended.append(curve)

    found = figure7(pressures=[0.0, 0.01], tensions=[0.0, 0.02, 0.04], skins=[False],
                    directions=("down", "up"), begin=begin, done=done, **SMALL)
    found.begun, found.ended = begun, ended
    return found


def test_every_panel_is_run_in_both_directions_from_rest(study):
    assert list(study.paths) == study.ended == [DOWN, UP, PULLED, RAISED]
    guides = {curve: guide for curve, _, guide in study.begun}
    assert guides[PULLED] == (0.0, -100.0, 0.0) and guides[RAISED] == (0.0, 100.0, 0.0)
    assert not any(skin for _, skin, _ in study.begun)
    assert study.converged and study.reason == "every curve reached its last load"


@pytest.mark.parametrize("angle, down, up", [
    ("span_angle_deg", DOWN, UP), ("chord_angle_deg", PULLED, RAISED)])
def test_up_is_the_mirror_of_down(study, angle, down, up):
    there, back = (study.paths[curve][-1].measures[angle] for curve in (down, up))
    assert there > 0.5
    assert back == pytest.approx(-there, rel=1e-3)  # ribs have a handedness


def test_table_has_a_row_a_step_with_the_load_of_its_panel(study):
    table = study.table()
    assert len(table) == 10
    by = {Curve(*key): rows for key, rows in table.groupby(KEYS, sort=False)}
    assert by[UP]["load"].tolist() == by[UP]["pressure_MPa"].tolist() == [0.0, 0.01]
    assert by[RAISED]["load"].tolist() == by[RAISED]["cable_N"].tolist() == [0.0, 0.02, 0.04]
    for name in ("span_line_deg", "chord_line_deg", "largest_stretch", "rib_stress_MPa",
                 "newton_iterations", "negative_pivots", "step_seconds"):
        assert table[name].notna().all(), name
    assert by[DOWN]["largest_stretch"].iloc[-1] > 1.05
    assert by[PULLED]["rib_stress_MPa"].iloc[-1] > 1.0


def test_paths_are_kept_without_fields_and_without_the_wing(study):
    for path in study.paths.values():
        assert isinstance(path, Path)
        assert not any(state.fields for state in path)
        assert not hasattr(path.scene, "system")


def test_folder_has_picture_table_and_summary(study, tmp_path):
    study.save(tmp_path / "out")
    assert {file.name for file in (tmp_path / "out").iterdir()} == {
        "fig7.png", "table.csv", "summary.json"}
    summary = json.loads((tmp_path / "out" / "summary.json").read_text())
    table = pd.read_csv(tmp_path / "out" / "table.csv")
    assert len(table) == 10
    for name in ("pressure_MPa", "cable_N", "span_angle_deg", "chord_angle_deg",
                 "newton_iterations", "energy_Nmm"):
        assert summary[name] == pytest.approx(table[name].tolist())
    assert summary["curve"] == [0, 0, 1, 1, 2, 2, 2, 3, 3, 3]
    assert summary["curves"][3]["direction"] == "up" and summary["curves"][3]["steps"] == 3
    assert (summary["converged"], summary["fidelity"]) == (True, "draft")
    assert len(summary["facts"]["curves"]) == 4
    assert summary["parameters"]["geometry"]["n_cells"] == 2
    assert {"reason", "seconds", "versions", "dofs"} <= set(summary)


def test_a_curve_that_stops_is_kept_and_the_others_are_run(monkeypatch, tmp_path):
    solve, calls = Newton.solve, []

    def failing(newton, force):
        calls.append(force)
        if 2 < len(calls) < 13:  # all tries of a third point, with smaller and smaller steps
            return NewtonResult(False, "made to fail", 1, 1.0, 0)
        return solve(newton, force)

    monkeypatch.setattr(Newton, "solve", failing)
    study = figure7(pressures=[0.0, 0.005, 0.01], tensions=[0.0, 0.02], skins=[False], **SMALL)
    first, last = study.paths.values()
    assert not study.converged and (first.converged, last.converged) == (False, True)
    assert study.reason.startswith("pressure, no skin, down, draft: stopped after upper = 0.005")
    assert [state.load["upper_MPa"] for state in first] == [0.0, 0.005]
    study.save(tmp_path)
    assert json.loads((tmp_path / "summary.json").read_text())["converged"] is False


@pytest.mark.quick
def test_a_study_whose_first_step_failed_is_written_empty(tmp_path):
    study = Figure7(MPI.COMM_SELF)
    assert study.table().empty
    study.save(tmp_path)
    assert json.loads((tmp_path / "summary.json").read_text())["curve"] == []


@pytest.mark.quick
@pytest.mark.parametrize("changes, sentence", [
    ({"fidelities": ["best"]}, "fidelity = 'best': must be one of draft, standard"),
    ({"directions": ["left"]}, "direction = 'left': must be down or up"),
    ({"panels": ["B-3"]}, "panel = 'B-3': must be pressure or cables"),
    ({"geometry": WingGeometry.prototype(rib=None)}, "rib = None: must be a rib"),
    ({"geometry": WingGeometry.prototype(skin_thickness=None)}, "skin_thickness = None: must be"),
])
def test_what_cannot_be_run_is_refused_at_once(changes, sentence):
    with pytest.raises(InputError) as refused:
        figure7(**SMALL | changes)
    assert str(refused.value).startswith(sentence)
