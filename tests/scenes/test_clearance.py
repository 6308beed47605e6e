"""Gaps between made-up sides of a pocket and made-up ribs: signs, sizes, what is left out."""

import numpy as np
import pytest

from morphing_wing.clearance import SMALLEST_GAP, Clearance

pytestmark = pytest.mark.quick

X, Z = (line.ravel() for line in np.meshgrid(np.linspace(0, 10, 11), np.linspace(0, 6, 7)))
NOTHING = np.empty((0, 3))


def side(y):
    return np.stack([X, np.broadcast_to(y, X.shape), Z], axis=1)


def bar(y):
    """Points on the axis of one bar along the chord, in the middle of the span."""
    x = np.linspace(2, 8, 13)
    return np.stack([x, np.full_like(x, y), np.full_like(x, 3.0)], axis=1)


def dent(depth):
    """Heights of a dimple in the middle of the pocket."""
    return depth * np.exp(-((X - 5.0) ** 2 + (Z - 3.0) ** 2))


UPPER, LOWER = side(2.0), side(-1.0)
EMPTY = Clearance(UPPER, LOWER, NOTHING, 0.0)
RIBBED = Clearance(UPPER, LOWER, bar(0.0), 0.25)


def turned(points, degrees):
    """Points turned about z, displaced: gaps must not notice."""
    a = np.radians(degrees)
    R = np.array([[np.cos(a), -np.sin(a), 0], [np.sin(a), np.cos(a), 0], [0, 0, 1]])
    return points @ R.T + np.array([3.0, -20.0, 7.0])


def test_gap_of_parallel_sides_is_their_distance():
    assert EMPTY.smallest(UPPER, LOWER, NOTHING) == pytest.approx(3.0)


def test_gap_beside_a_rib_ends_at_the_bars_surface():
    assert RIBBED.smallest(UPPER, LOWER, bar(0.0)) == pytest.approx(1.0 - 0.25)
    assert RIBBED.smallest(UPPER, LOWER, bar(1.5)) == pytest.approx(0.5 - 0.25)


@pytest.mark.parametrize("depth, gap", [(1.0, 2.0), (2.9, 0.1), (3.1, -0.1), (4.0, -1.0)])
def test_gap_changes_its_sign_where_a_dimple_passes_through_the_other_side(depth, gap):
    dented = side(2.0 - dent(depth))
    assert EMPTY.smallest(dented, LOWER, NOTHING) == pytest.approx(gap, abs=1e-9)


@pytest.mark.parametrize("depth, through", [(0.7, False), (0.8, True)])
def test_gap_changes_its_sign_where_the_skin_reaches_a_bar(depth, through):
    dented = side(-1.0 + dent(depth))
    assert (RIBBED.smallest(UPPER, dented, bar(0.0)) < 0.0) == through


@pytest.mark.parametrize("y", [-1.3, 2.3])
def test_bar_pushed_out_through_either_side_has_a_negative_gap(y):
    assert RIBBED.smallest(UPPER, LOWER, bar(y)) == pytest.approx(-0.3 - 0.25)


@pytest.mark.parametrize("degrees", [30.0, -80.0, 175.0])
def test_gaps_turn_with_the_wing(degrees):
    bodies = [turned(points, degrees) for points in (UPPER, LOWER, bar(0.0))]
    assert RIBBED.smallest(*bodies) == pytest.approx(0.75)
    dented = [turned(side(2.0 - dent(4.0)), degrees), *bodies[1:]]
    assert RIBBED.smallest(*dented) < 0.0


def test_points_that_touch_by_design_are_left_out():
    closing = np.where(X > 9.5, -1.0 + 0.5 * SMALLEST_GAP, 2.0)
    clearance = Clearance(side(closing), LOWER, NOTHING, 0.0)
    assert clearance.smallest(side(closing), LOWER, NOTHING) == pytest.approx(3.0)
    crossed = np.where(X > 9.5, -1.1, 2.0)
    assert clearance.smallest(side(crossed), LOWER, NOTHING) == pytest.approx(3.0)


def test_sides_that_touch_everywhere_have_no_gap_to_watch():
    assert Clearance(side(-0.9), LOWER, NOTHING, 0.0).smallest(
        side(-0.9), LOWER, NOTHING) == np.inf
