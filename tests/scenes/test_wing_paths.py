"""The wing's paths: mirrored loads, loads split into steps, work and energy."""

from dataclasses import replace

import numpy as np
import pytest

from morphing_wing.geometry.frame import local_axes
from morphing_wing.geometry.rib import RibGeometry
from tests.scenes.small_wing import NO_RIBS, NO_SKIN, SPAR, actuated, angles, wing

PRESSURE = 0.02
THIN_SKIN = {"n_cells": 4, "skin_thickness": 0.4}


@pytest.fixture
def mirrored_ribs(monkeypatch):
    """Return a function that turns all ribs built from now on upside down."""
    frame = RibGeometry.frame

    def upside_down(rib):
        found = frame(rib)
        points = found.points * np.array([1.0, -1.0, 1.0])
        return replace(found, points=points, axes=local_axes(points, found.bars))

    return lambda: monkeypatch.setattr(RibGeometry, "frame", upside_down)


@pytest.mark.parametrize("changes", [SPAR, NO_RIBS, NO_SKIN, {}],
                         ids=["spar alone", "no ribs", "no skin", "all"])
def test_lower_chambers_mirror_the_upper_ones(changes, mirrored_ribs):
    up = actuated(wing(**changes), upper=PRESSURE)[-1]
    mirrored_ribs()
    down = actuated(wing(**changes), lower=PRESSURE)[-1]
    assert up.measures["span_angle_deg"] > 0.5
    for name, value in angles(up).items():
        assert down.measures[name] == pytest.approx(-value, rel=1e-6), name
    assert down.energy_Nmm == pytest.approx(up.energy_Nmm, rel=1e-8)


def test_a_ribs_own_lack_of_symmetry_changes_the_span_angle_by_less_than_a_thousandth():
    # Its middle bars rise and its outer bars fall: upside down it is another rib.
    up, down = (actuated(wing(), **{row: PRESSURE})[-1] for row in ("upper", "lower"))
    assert down.measures["span_angle_deg"] == pytest.approx(
        -up.measures["span_angle_deg"], rel=1e-3)
    assert down.energy_Nmm == pytest.approx(up.energy_Nmm, rel=1e-3)
    assert down.energy_Nmm != pytest.approx(up.energy_Nmm, rel=1e-8)


@pytest.mark.parametrize("changes, loads", [
    ({}, {"upper": 0.04}),
    (NO_RIBS | {"n_cells": 6, "skin_thickness": 0.4}, {"upper": 0.04}),
    (NO_SKIN, {"cable": 0.2}),
    (THIN_SKIN, {"cable": 0.3}),
    (NO_SKIN, {"upper": 0.025, "cable": 0.2}),
], ids=["pressure", "thin skin", "cable", "cable, thin skin", "both"])
def test_any_split_of_the_loads_ends_in_the_same_state(changes, loads):
    one, four = (
        actuated(wing(**changes), **{name: np.linspace(0, value, n + 1)[1:]
                                     for name, value in loads.items()})[-1]
        for n in (1, 4)
    )
    assert max(map(abs, angles(one).values())) > 1.0
    for name, value in one.measures.items():
        assert four.measures[name] == pytest.approx(value, rel=1e-5, abs=1e-6), name
    assert four.energy_Nmm == pytest.approx(one.energy_Nmm, rel=1e-6)


def test_pressure_before_cable_ends_where_cable_before_pressure_does():
    first = actuated(wing(**NO_SKIN), upper=[0.02, 0.02], cable=[0.0, 0.1])[-1]
    last = actuated(wing(**NO_SKIN), upper=[0.0, 0.02], cable=[0.1, 0.1])[-1]
    for name, value in first.measures.items():
        assert last.measures[name] == pytest.approx(value, rel=1e-5), name
    for state in (first, last):
        assert state.external_work_Nmm == pytest.approx(state.energy_Nmm, rel=2e-3)


def test_unloaded_the_wing_is_straight_again():
    start, *_, end = actuated(wing(), upper=[0.0, 0.03, 0.0], cable=[0.0, 0.1, 0.0])
    assert end.energy_Nmm == pytest.approx(0.0, abs=1e-9)
    for name, value in start.measures.items():
        assert end.measures[name] == pytest.approx(value, abs=1e-6), name


@pytest.mark.parametrize("changes, loads", [
    ({}, {"upper": 0.03}), (NO_SKIN, {"cable": 0.1}), (NO_SKIN, {"upper": 0.02, "cable": 0.1}),
], ids=["pressure", "cable", "both"])
def test_external_work_is_the_stored_energy_to_the_fourth_order_of_the_steps(changes, loads):
    errors = []
    for n in (1, 2, 4):
        steps = {name: np.linspace(0, value, n + 1)[1:] for name, value in loads.items()}
        last = actuated(wing(**changes), **steps)[-1]
        errors.append(abs(last.external_work_Nmm / last.energy_Nmm - 1.0))
    orders = np.log2(np.array(errors[:-1]) / errors[1:])
    assert errors[0] < 2e-3
    assert orders == pytest.approx(4.0, abs=0.3)
