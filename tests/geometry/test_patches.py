"""Integration points of patches that cut through facets: exact areas and moments."""

import numpy as np
import pytest

from morphing_wing.geometry.patches import joined, patch_points
from tests.geometry.test_facets import BOTH_DEGREES, sheet

pytestmark = pytest.mark.quick

BOX = np.array([[0.35, 0.2, -1.0], [2.6, 1.7, 1.0]])
"""Cuts all six facets of the sheet, and holds a part of each."""


def moments(points):
    """Area, first and second moments of a patch in x and y."""
    x, y, _ = points.place.T
    return [np.sum(points.area * f) for f in (1.0 + 0 * x, x, y, x * x, x * y, y * y)]


def box_moments(low, high):
    """Moments of a rectangle."""
    def line(axis):
        a, b = low[axis], high[axis]
        return [(b**k - a**k) / k for k in (1, 2, 3)]

    x, y = line(0), line(1)
    return [x[0] * y[0], x[1] * y[0], x[0] * y[1], x[2] * y[0], x[1] * y[1], x[0] * y[2]]


@BOTH_DEGREES
def test_area_and_moments_of_a_box_that_cuts_facets_are_exact(degree):
    points = patch_points(*sheet(degree), BOX)
    assert set(points.facet) == set(range(6))
    np.testing.assert_allclose(moments(points), box_moments(*BOX), rtol=1e-13)
    np.testing.assert_allclose(points.normal, [[0.0, 0.0, 1.0]] * len(points.area), atol=1e-14)
    assert (points.place >= BOX[0]).all() and (points.place <= BOX[1]).all()


@BOTH_DEGREES
def test_a_box_inside_one_facet_takes_no_other(degree):
    box = np.array([[1.25, 0.5, -1.0], [1.5, 0.75, 1.0]])
    points = patch_points(*sheet(degree), box)
    assert set(points.facet) == {1} and len(points.area) == 9
    np.testing.assert_allclose(moments(points), box_moments(*box), rtol=1e-13)


@BOTH_DEGREES
def test_a_box_that_holds_the_sheet_takes_all_of_it_and_one_beside_it_nothing(degree):
    nodes, rows = sheet(degree)
    everything = patch_points(nodes, rows, np.array([[-9.0] * 3, [9.0] * 3]))
    assert everything.area.sum() == pytest.approx(6.0, rel=1e-13)
    for low in ([3.1, 0.0, -1.0], [0.0, 0.0, 0.5]):
        nothing = patch_points(nodes, rows, np.array([low, [9.0, 9.0, 9.0]]))
        assert len(nothing.area) == len(nothing.facet) == 0
        assert nothing.shapes.shape == (0, (degree + 1) ** 2)


@BOTH_DEGREES
def test_shape_functions_of_the_points_give_their_places_back(degree):
    nodes, rows = sheet(degree)
    points = patch_points(nodes, rows, BOX)
    place = np.einsum("na,nai->ni", points.shapes, nodes[rows[points.facet]])
    np.testing.assert_allclose(place, points.place, atol=1e-14)


def test_points_integrate_products_of_quadratic_shape_functions_exactly():
    nodes, rows = sheet(2, n=(1, 1), size=(2.0, 2.0))
    points = patch_points(nodes, rows, np.array([[-9.0] * 3, [9.0] * 3]))
    mass = np.einsum("n,na,nb->ab", points.area, points.shapes, points.shapes)
    line = np.array([[4, 2, -1], [2, 16, 2], [-1, 2, 4]]) / 15.0
    np.testing.assert_allclose(mass, np.kron(line, line), atol=1e-14)


def test_a_sheet_that_is_curved_across_the_cut_has_its_own_area_and_normals():
    slope = 0.3
    nodes, rows = sheet(2, height=lambda x, y: slope * x)
    box = np.array([[0.5, 0.2, -9.0], [2.5, 1.7, 9.0]])
    points = patch_points(nodes, rows, box)
    assert points.area.sum() == pytest.approx(2.0 * 1.5 * np.hypot(1.0, slope), rel=1e-13)
    normal = np.array([-slope, 0.0, 1.0]) / np.hypot(1.0, slope)
    np.testing.assert_allclose(points.normal, [normal] * len(points.area), atol=1e-14)


def test_joined_patches_count_their_facets_on():
    nodes, rows = sheet(1)
    low, high = (patch_points(nodes, part, BOX) for part in (rows[:2], rows[2:]))
    both, one = joined([low, high], [0, 2]), patch_points(nodes, rows, BOX)
    for name in ("facet", "shapes", "place", "normal", "area"):
        np.testing.assert_array_equal(getattr(both, name), getattr(one, name))
