"""Which rung "auto" takes, from figures made up here and from those in the package."""

import math
from dataclasses import replace

import pytest

from morphing_wing import ladder, spar_rungs, wing
from morphing_wing.errors import InputError
from morphing_wing.geometry.spar import SparGeometry, SparMeshing
from morphing_wing.ladder import LADDERS, errors_of, pick
from morphing_wing.spar import Spar
from morphing_wing.spar_cell import SparCell
from morphing_wing.spar_rungs import pick_of

pytestmark = pytest.mark.quick

ROWS = [("instant", 2, 0.3, 1e-3), ("draft", 2, -0.06, 1.0), ("draft", 2, 0.01, math.inf),
        ("standard", 2, 0.01, 9.0), ("instant", 20, -0.15, 1e-3), ("standard", 20, -0.005, 9.0),
        ("draft", 20, 0.04, 1.0), ("cell", 2, 0.001, 10.0), ("cell", 20, 0.04, 2.0)]


@pytest.fixture
def made_up(monkeypatch):
    names = ("fidelity", "n_cells", "error", "seconds")
    rows = [dict(zip(names, row, strict=True)) for row in ROWS]
    monkeypatch.setattr(ladder, "_measured", lambda scene: rows)


@pytest.mark.parametrize("n_cells, tolerance, rung, error", [
    (20, 0.2, "instant", 0.15), (20, 0.05, "draft", 0.04), (20, 0.005, "standard", 0.005),
    (19, 0.05, "standard", 0.01), (2, 0.06, "draft", 0.06), (1, 0.02, "standard", 0.01),
    (50, 0.05, "draft", 0.04),
])
def test_auto_takes_the_cheapest_that_was_accurate_enough(made_up, n_cells, tolerance, rung, error):
    found = pick("spar", "auto", tolerance, n_cells)
    assert (found.fidelity, found.error) == (rung, error)


def test_without_figures_auto_is_refused(monkeypatch):
    monkeypatch.setattr(ladder, "_measured", lambda scene: [])
    with pytest.raises(InputError, match="until 'tradeoff wing --keep' has measured them"):
        pick("wing", "auto", 0.1)


def test_a_named_rung_keeps_its_name_and_tells_its_error(made_up):
    assert pick("spar", "draft", n_cells=2) == ladder.Pick("draft", 0.06)
    assert pick("spar", "reference", n_cells=2).error is None


def test_auto_may_be_held_to_some_rungs(made_up):
    assert pick("spar", "auto", 0.2, 20, ("draft", "standard")).fidelity == "draft"


@pytest.mark.parametrize("arguments, sentence", [
    (("best",), "fidelity = 'best': must be one of instant, cell, draft, standard, reference, or "
                "auto"),
    (("draft", 0.01), "tolerance = 0.01: must be left out unless fidelity is 'auto'"),
    (("auto", 0.0), "tolerance = 0: must be a relative error of the angle greater than 0"),
    (("auto", "1 %"), "tolerance = '1 %': must be a relative error of the angle greater than 0"),
    (("auto", 0.001, 20), "tolerance = 0.001: must be at least 0.005, the measured error of the "
                          "most accurate rung, standard"),
])
def test_what_cannot_be_picked_is_refused(made_up, arguments, sentence):
    with pytest.raises(InputError) as refused:
        pick("spar", *arguments)
    assert str(refused.value) == sentence


@pytest.mark.parametrize("scene", LADDERS)
def test_all_rungs_were_measured(scene):
    errors = errors_of(scene, 20)
    assert set(errors) == set(LADDERS[scene])
    assert all(0.0 < error < 0.6 for error in errors.values())
    # One cell of a rib is meshed finer than a whole one.
    best = "cell" if scene == "rib" else LADDERS[scene][-1]
    assert errors[best] == min(errors.values())


def test_all_rungs_with_a_mesh_are_those_of_the_ladder():
    assert LADDERS["spar"] == ("instant", "cell", *spar_rungs.FIDELITIES)
    assert LADDERS["wing"] == tuple(wing.FIDELITIES)


def test_a_rung_that_failed_is_never_accurate_enough(monkeypatch):
    rows = [{"fidelity": "draft", "n_cells": 1, "error": error, "seconds": 1.0}
            for error in (0.01, float("nan"))]
    monkeypatch.setattr(ladder, "_measured", lambda scene: rows)
    with pytest.raises(InputError, match="must be at least inf"):
        pick("wing", "auto", 0.5)


@pytest.mark.parametrize("fidelity", ["instant", "cell"])
def test_errors_are_not_told_of_chambers_longer_than_any_that_was_measured(fidelity):
    geometry = SparGeometry.validation(1)
    assert pick_of(geometry, fidelity).error > 0.0
    assert pick_of(replace(geometry, cavity_length=20.0), fidelity).error is None


@pytest.mark.parametrize("options", [{"element": "Q1/P0"}, {"meshing": SparMeshing.plain()}])
def test_errors_are_not_told_of_other_meshes_and_auto_takes_none(options):
    assert Spar(SparGeometry.validation(1), fidelity="draft", **options).error_estimate is None
    with pytest.raises(InputError, match="must be left out where fidelity is 'auto'"):
        Spar(SparGeometry.validation(1), fidelity="auto", **options)


def test_what_was_measured_is_in_the_order_of_its_cost():
    assert list(errors_of("spar", 2))[:2] == ["instant", "draft"]
    assert list(errors_of("spar", 20))[-2:] == ["standard", "reference"]


def test_a_scene_takes_the_rung_and_says_how_far_it_is_off():
    geometry = SparGeometry.validation(20)
    scene = Spar(geometry, fidelity="auto", tolerance=0.01)
    assert type(scene) is SparCell and scene.fidelity == "cell"
    path = scene.inflate(upper=1e-3)
    assert 0.0 < path.summary()["error_estimate"] < 0.01


def test_where_a_cell_will_not_do_a_whole_spar_is_taken():
    scene = Spar(SparGeometry.validation(2), fidelity="auto", tolerance=0.2, contact=True)
    assert type(scene) is Spar and scene.fidelity == "draft"
