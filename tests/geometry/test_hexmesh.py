"""Swept blocks: what is solid, what surrounds a cavity, what is outside."""

import numpy as np
import pytest

from morphing_wing.geometry.hexmesh import (
    breakpoints,
    geometric,
    swept_blocks,
    two_sided,
    uniform,
)
from tests.geometry import hexahedra

pytestmark = pytest.mark.quick

LINES = (np.array([0.0, 1.0, 3.0, 4.0]), np.array([0.0, 0.5, 2.0, 3.0]), np.linspace(0, 3, 4))


def sides(midpoints, normals):
    return {f"{axis}{sign}": normals[:, i] * step > 0
            for i, axis in enumerate("xyz") for sign, step in (("-", -1), ("+", 1))}


def box_with_hole(mapping=None):
    """A box 4 x 3 x 3 whose middle block (2 x 1.5 x 1) is hollow and one corner block missing."""
    kind = np.ones((3, 3, 3), dtype=int)
    kind[1, 1, 1] = -1
    kind[2, 2, 2] = 0
    kind[0] = 2
    return swept_blocks(LINES, kind, {1: "body", 2: "end", -1: "hole"}, mapping, sides)


def test_named_faces_cover_the_boundary_once():
    mesh = box_with_hole()
    found = hexahedra.pairs(mesh, *mesh.facets)
    assert len(found) == len(set(found))
    assert set(found) == hexahedra.boundary(mesh)


def test_volume_and_areas_are_those_of_the_blocks():
    mesh = box_with_hole()
    assert hexahedra.volume(mesh) == pytest.approx(36.0 - 3.0 - 1.0, rel=1e-14)
    assert hexahedra.volume(mesh, "end") == pytest.approx(9.0, rel=1e-14)
    assert hexahedra.area(mesh, "hole") == pytest.approx(2 * (2 * 1.5 + 2 * 1 + 1.5), rel=1e-14)
    # A missing corner block moves areas inwards, but takes none away.
    total = sum(hexahedra.area(mesh, name) for name in mesh.facets if name != "hole")
    assert total == pytest.approx(2 * (4 * 3 + 4 * 3 + 3 * 3), rel=1e-14)


def test_regions_hold_every_cell_once():
    mesh = box_with_hole()
    cells = np.concatenate(list(mesh.regions.values()))
    assert sorted(cells) == list(range(len(mesh.cells)))
    assert len(mesh.cells) == 27 - 2


def test_a_hole_is_closed_and_encloses_its_volume_after_an_affine_map():
    A = np.array([[1.2, 0.3, -0.1], [0.2, 0.9, 0.4], [0.0, -0.2, 1.1]])
    mesh = box_with_hole(lambda x: x @ A.T + np.array([5.0, -7.0, 2.0]))
    total = hexahedra.area_vectors(mesh, "hole").sum(axis=0)
    np.testing.assert_allclose(total, 0.0, atol=1e-13)
    assert hexahedra.enclosed(mesh, "hole") == pytest.approx(3.0 * np.linalg.det(A), rel=1e-13)


def test_points_belong_to_a_cell_and_are_shared_by_neighbours():
    mesh = box_with_hole()
    assert set(mesh.cells.ravel()) == set(range(len(mesh.points)))
    assert len(np.unique(mesh.points, axis=0)) == len(mesh.points) == 4**3 - 1


@pytest.mark.parametrize("fractions, ratios", [
    (uniform(4), [1, 1, 1]),
    (geometric(4, 0.5), [0.5, 0.5, 0.5]),
    (two_sided(4, 3.0), [3, 1, 1 / 3]),
    (two_sided(5, 2.0), [2, 2, 0.5, 0.5]),
])
def test_fractions_run_from_0_to_1_with_their_ratio(fractions, ratios):
    assert (fractions[0], fractions[-1]) == pytest.approx((0.0, 1.0), abs=1e-15)
    lengths = np.diff(fractions)
    np.testing.assert_allclose(lengths[1:] / lengths[:-1], ratios)


def test_pieces_join_end_to_end():
    points, piece = breakpoints((2.0, uniform(2)), (1.0, uniform(1)), (4.0, geometric(2, 3.0)))
    np.testing.assert_allclose(points, [0, 1, 2, 3, 4, 7])
    np.testing.assert_array_equal(piece, [0, 0, 1, 2, 2])
