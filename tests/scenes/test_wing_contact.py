"""A wing whose skin meets itself or a rib: held apart with contact, told of without."""

import numpy as np
import pytest

from tests.scenes.small_wing import NO_RIBS, actuated, move_elastomer, wing

MEETS_A_RIB = {"n_cells": 4, "skin_thickness": 0.3, "rib_positions": (0.75,)}
TENSIONS = [0.1, 0.15, 0.3]


def test_without_contact_the_tension_is_told_at_which_the_skin_passes_through_a_rib():
    path = actuated(wing(contact=False, **MEETS_A_RIB), cable=TENSIONS)
    found = {s.load["cable_N"]: s.measures for s in path if s.requested}
    assert [found[t]["contact"] for t in TENSIONS] == [0.0, 0.0, 1.0]
    assert all((m["gap_mm"] < 0.0) == (m["contact"] == 1.0) for m in found.values())
    assert found[0.3]["gap_mm"] < -0.1


def test_with_contact_the_rib_presses_on_the_skin_and_stays_outside():
    with_contact = actuated(wing(**MEETS_A_RIB), cable=TENSIONS)
    without = actuated(wing(contact=False, **MEETS_A_RIB), cable=TENSIONS)
    found = {s.load["cable_N"]: s.measures for s in with_contact if s.requested}
    assert [found[t]["touching"] for t in TENSIONS] == [0.0, 0.0, 1.0]
    assert found[0.15]["contact_force_N"] == 0.0 < found[0.3]["contact_force_N"]
    # One per cent of the skin's thickness.
    assert found[0.3]["gap_mm"] > -0.01 * MEETS_A_RIB["skin_thickness"]
    assert found[0.3]["penetration_mm"] == pytest.approx(-found[0.3]["gap_mm"], abs=1e-4)
    # What holds the skin back stiffens the wing.
    assert with_contact[-1].measures["chord_angle_deg"] < (
        without[-1].measures["chord_angle_deg"] - 0.1)


def test_before_anything_touches_contact_changes_nothing():
    with_contact, without = (
        actuated(wing(contact=contact), upper=[0.01, 0.02])[-1] for contact in (True, False))
    assert with_contact.measures["touching"] == 0.0
    assert with_contact.energy_Nmm == pytest.approx(without.energy_Nmm, rel=1e-8)
    assert with_contact.newton_iterations == without.newton_iterations


def test_any_split_of_the_load_ends_in_the_same_contact():
    one, two = (actuated(wing(**MEETS_A_RIB), cable=steps)[-1] for steps in ([0.3], [0.2, 0.3]))
    for name, value in one.measures.items():
        assert two.measures[name] == pytest.approx(value, rel=1e-4, abs=1e-6), name


@pytest.mark.quick
@pytest.mark.parametrize("changes", [{}, NO_RIBS], ids=["on a rib", "on the other side"])
@pytest.mark.parametrize("part, contact", [(0.0, 0.0), (0.5, 0.0), (1.1, 1.0)])
def test_upper_skin_pushed_through_is_contact(changes, part, contact):
    scene = wing(contact=False, **changes)
    # Half-way along the pocket, by a part of the way down to the lower skin or the rib's top.
    x_dent = 0.5 * (scene.geometry.spar_end + scene.geometry.pocket_end)
    inner = float(scene.geometry.section.half_thickness(x_dent)) - 1.0
    rib = scene.geometry.rib
    way = 2.0 * inner if rib is None else inner - 0.5 * (rib.height + rib.shaft_width)

    def dent(points):
        x, y, _ = points.T
        down = np.where((x > 78.0) & (y > 1e-6), np.exp(-((x - x_dent) / 15.0) ** 2), 0.0)
        return -part * way * np.outer(down, [0.0, 1.0, 0.0])

    move_elastomer(scene, dent)
    assert scene._measures()["contact"] == contact
