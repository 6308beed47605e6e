"""Places on facets: interpolation, projection against known places, shares of the area."""

import numpy as np
import pytest

from morphing_wing.geometry.facets import (
    BEYOND,
    closest,
    gaps,
    node_areas,
    project,
    shape_functions,
)

pytestmark = pytest.mark.quick

BOTH_DEGREES = pytest.mark.parametrize("degree", [1, 2])
PLACES = np.random.default_rng(5).uniform(-1.0, 1.0, (40, 2))


def lattice(degree):
    """Natural coordinates of a facet's nodes."""
    line = np.linspace(-1.0, 1.0, degree + 1)
    return np.array([(a, b) for b in line for a in line])


def plane_facet(degree, origin=(0.0, 0.0, 0.0), first=(2.0, 0.0, 0.0), second=(0.0, 3.0, 0.0)):
    """Nodes of the parallelogram with two half sides around an origin."""
    xi = lattice(degree)
    return np.array(origin) + xi[:, :1] * np.array(first) + xi[:, 1:] * np.array(second)


def sheet(degree, n=(3, 2), size=(3.0, 2.0), height=lambda x, y: 0.0 * x):
    """Nodes and facets of a sheet over a rectangle, normals up."""
    steps = [degree * k for k in n]
    x, y = (np.linspace(0.0, s, k + 1) for s, k in zip(size, steps, strict=True))
    Y, X = (part.ravel() for part in np.meshgrid(y, x, indexing="ij"))
    rows = []
    for j in range(n[1]):
        for i in range(n[0]):
            rows.append([(degree * j + b) * (steps[0] + 1) + degree * i + a
                         for b in range(degree + 1) for a in range(degree + 1)])
    return np.stack([X, Y, height(X, Y)], axis=1), np.array(rows)


# -- shape functions -----------------------------------------------------------------------------


@BOTH_DEGREES
def test_shape_functions_sum_up_to_one_and_their_derivatives_to_nothing(degree):
    N, first, second = shape_functions(degree, PLACES)
    np.testing.assert_allclose(N.sum(axis=1), 1.0, atol=1e-14)
    np.testing.assert_allclose(first.sum(axis=1), 0.0, atol=1e-14)
    np.testing.assert_allclose(second.sum(axis=1), 0.0, atol=1e-14)


@BOTH_DEGREES
def test_shape_functions_are_one_at_their_node_and_zero_at_others(degree):
    N, *_ = shape_functions(degree, lattice(degree))
    np.testing.assert_allclose(N, np.eye((degree + 1) ** 2), atol=1e-15)


@BOTH_DEGREES
def test_shape_functions_interpolate_products_of_their_degree_with_their_derivatives(degree):
    def value(xi):
        s, t = xi.T
        return (1 + s) * (2 - t) if degree == 1 else (1 + s - 3 * s**2) * (2 - t + t**2)

    N, first, second = shape_functions(degree, PLACES)
    nodal, h = value(lattice(degree)), 1e-6
    np.testing.assert_allclose(N @ nodal, value(PLACES), atol=1e-13)
    for found, axis in ((first, 0), (second, 1)):
        step = h * np.eye(2)[axis]
        slope = (value(PLACES + step) - value(PLACES - step)) / (2 * h)
        np.testing.assert_allclose(found @ nodal, slope, atol=1e-8)


# -- one facet -----------------------------------------------------------------------------------


@BOTH_DEGREES
def test_projection_finds_the_place_under_a_point_on_a_tilted_oblique_facet(degree):
    nodes = plane_facet(degree, (1.0, 2.0, 3.0), (2.0, 0.5, 0.3), (-0.4, 1.5, 0.8))
    normal = np.cross([2.0, 0.5, 0.3], [-0.4, 1.5, 0.8])
    normal /= np.linalg.norm(normal)
    N, *_ = shape_functions(degree, PLACES)
    height = np.linspace(-1.0, 2.0, len(PLACES))
    points = N @ nodes + height[:, None] * normal
    stack = np.broadcast_to(nodes, (len(points), *nodes.shape))
    xi = project(stack, points)
    np.testing.assert_allclose(xi, PLACES, atol=1e-12)
    np.testing.assert_allclose(gaps(stack, points, xi), height, atol=1e-12)


@pytest.mark.parametrize("depth", [0.2, -0.2])
def test_projection_finds_the_place_under_a_point_on_a_curved_facet(depth):
    nodes, rows = sheet(2, n=(1, 1), size=(2.0, 2.0), height=lambda x, y: 0.1 * x**2 - 0.05 * x * y)
    N, first, second = shape_functions(2, PLACES)
    normal = np.cross(first @ nodes[rows[0]], second @ nodes[rows[0]])
    normal /= np.linalg.norm(normal, axis=1)[:, None]
    points = N @ nodes[rows[0]] + depth * normal
    stack = np.broadcast_to(nodes[rows[0]], (len(points), 9, 3))
    xi = project(stack, points)
    np.testing.assert_allclose(xi, PLACES, atol=1e-9)
    np.testing.assert_allclose(gaps(stack, points, xi), depth, atol=1e-9)


def test_a_facet_is_continued_over_its_edges_but_not_far():
    nodes = plane_facet(1)[None]
    near, far = (project(nodes, np.array([[2.0 * s, 0.0, 1.0]]))[0, 0] for s in (1.1, 5.0))
    assert near == pytest.approx(1.1, abs=1e-12)
    assert far == BEYOND


# -- surfaces ------------------------------------------------------------------------------------


@BOTH_DEGREES
def test_the_facet_under_each_point_of_a_flat_sheet_is_found_with_its_gap(degree):
    nodes, rows = sheet(degree)
    random = np.random.default_rng(1)
    points = random.uniform([0.0, 0.0, -0.3], [3.0, 2.0, 0.3], (200, 3))
    at = closest(points, nodes, rows)
    np.testing.assert_array_equal(
        at.facet, np.floor(points[:, 0]) + 3 * np.floor(points[:, 1]))
    np.testing.assert_allclose(at.gap, points[:, 2], atol=1e-12)
    np.testing.assert_allclose(at.xi, 2.0 * (points[:, :2] % 1.0) - 1.0, atol=1e-12)


@BOTH_DEGREES
def test_on_a_shared_edge_the_first_of_its_facets_is_taken_whatever_rounding_says(degree):
    nodes, rows = sheet(degree)
    edge = np.array([[1.0, y, 0.2] for y in (0.25, 0.5, 0.75)] + [[2.0, 1.0, -0.2]])
    noise = 1e-12 * np.random.default_rng(2).standard_normal((20, *edge.shape))
    for disturbed in edge + noise:
        at = closest(disturbed, nodes, rows)
        np.testing.assert_array_equal(at.facet, [0, 0, 0, 1])
        np.testing.assert_allclose(at.gap, edge[:, 2], atol=1e-11)


@BOTH_DEGREES
def test_points_beyond_the_boundary_have_no_facet_and_no_gap(degree):
    nodes, rows = sheet(degree)
    # A facet is one millimetre long: it is continued by a tenth of one.
    at = closest(np.array([[3.05, 1.0, 0.1], [3.3, 1.0, 0.1], [1.0, -9.0, 0.0]]), nodes, rows)
    np.testing.assert_array_equal(at.facet >= 0, [True, False, False])
    np.testing.assert_array_equal(at.gap, [pytest.approx(0.1), np.inf, np.inf])


def test_distance_from_a_curved_sheet_is_that_from_its_circle():
    radius, n = 10.0, 8
    nodes, rows = sheet(2, n=(n, 1), size=(4.0, 1.0))
    angle = (nodes[:, 0] - 2.0) / radius
    nodes = np.stack([radius * np.sin(angle), nodes[:, 1], radius * np.cos(angle)], axis=1)
    angle = np.linspace(-0.19, 0.19, 50)
    for distance in (-0.5, 0.5):
        r = radius + distance
        points = np.stack([r * np.sin(angle), 0.4 + 0.0 * angle, r * np.cos(angle)], axis=1)
        np.testing.assert_allclose(closest(points, nodes, rows).gap, distance, atol=2e-6)


@pytest.mark.parametrize("degree, share", [
    (1, np.full(4, 0.25)), (2, np.outer([1, 4, 1], [1, 4, 1]).ravel() / 36.0)])
def test_shares_of_a_rectangle_are_the_forces_of_a_uniform_pressure(degree, share):
    nodes = plane_facet(degree, (1.0, 2.0, 3.0), (0.0, 2.0, 0.0), (1.5, 0.0, 2.0))
    area = 4.0 * 2.0 * 2.5
    found = node_areas(nodes, np.arange(len(nodes))[None])
    np.testing.assert_allclose(found, area * share, rtol=1e-13)


@BOTH_DEGREES
def test_shares_of_a_sheet_add_up_at_the_nodes_of_several_facets(degree):
    nodes, rows = sheet(degree)
    area = node_areas(nodes, rows)
    assert area.sum() == pytest.approx(6.0, rel=1e-13)
    corner, inner = (area[np.linalg.norm(nodes - p, axis=1).argmin()]
                     for p in ([0.0, 0.0, 0.0], [1.0, 1.0, 0.0]))
    assert inner == pytest.approx(4.0 * corner, rel=1e-13)
