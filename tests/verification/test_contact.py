"""Two blocks pressed together: the patch test of contact, with meshes that match or do not."""

import numpy as np
import pytest
from scipy.optimize import brentq

from morphing_wing.geometry.hexmesh import HexMesh, swept_blocks, uniform
from morphing_wing.materials import DRAGON_SKIN_30, Yeoh
from morphing_wing.verification.homogeneous import principal_stress
from tests.verification.moved import Moved, pressing

SIZE, APART, STIFFNESS = 4.0, 0.5, 20.0
MATERIAL = Yeoh(DRAGON_SKIN_30.coefficients, bulk=2.0)


def block(n, low, upper):
    """A cube of n x 1 x n hexahedra whose underside lies at y = ``low``; its faces by name."""
    name, inside = ("upper", -1) if upper else ("lower", 1)

    def faces(midpoints, normals):
        return {"x": normals[:, 0] < 0, "z": normals[:, 2] < 0,
                f"{name}_inside": normals[:, 1] * inside > 0,
                f"{name}_outside": normals[:, 1] * inside < 0}

    lines = SIZE * uniform(n), low + SIZE * uniform(1), SIZE * uniform(n)
    return swept_blocks(lines, np.ones((n, 1, n), int), {1: "body"}, faces=faces)


def side_by_side(*grids):
    """Return several meshes as one whose parts do not hang together."""
    points, cells, regions, facets, n_points, n_cells = [], [], {}, {}, 0, 0
    for grid in grids:
        points.append(grid.points)
        cells.append(grid.cells + n_points)
        for name, found in grid.regions.items():
            regions.setdefault(name, []).append(found + n_cells)
        for name, found in grid.facets.items():
            facets.setdefault(name, []).append(found + np.array([n_cells, 0]))
        n_points, n_cells = n_points + len(grid.points), n_cells + len(grid.cells)
    return HexMesh(np.concatenate(points), np.concatenate(cells),
                   *({name: np.concatenate(found) for name, found in names.items()}
                     for names in (regions, facets)))


def pressed(element, n_lower, n_upper, by, both=False):
    """Two cubes on sliding planes, the upper one lowered until they are ``by`` mm shorter.

    The upper one's nodes oppose the lower one's facets, and the other way round with ``both``.
    """
    pairs = [("upper_inside", "lower_inside"), ("lower_inside", "upper_inside")][: 1 + both]
    grid = side_by_side(block(n_lower, 0.0, False), block(n_upper, SIZE + APART, True))
    scene = Moved(
        grid, MATERIAL, element, pressing(*pairs, stiffness=STIFFNESS / len(pairs)),
        symmetry={"x": 0, "z": 2, "lower_outside": 1, "upper_outside": 1})
    u = scene.body.displacement_part(scene.body.function)
    u.interpolate(lambda x: np.outer([0.0, 1.0, 0.0], np.where(x[1] > SIZE + 0.1, -APART, 0.0)))
    for part in np.linspace(0.0, 1.0, 5)[1:]:
        scene.move("upper_outside", 1, -APART - part * by)
        scene.solve()
    return scene


def exact_force(by):
    """Force in N of a column of both cubes that gets shorter by ``by`` mm, its sides free."""
    along = 1.0 - by / (2.0 * SIZE)
    across = brentq(lambda t: principal_stress(MATERIAL, (t, along, t), 0), 1.0, 2.0, xtol=1e-15)
    return -SIZE**2 * principal_stress(MATERIAL, (across, along, across), 1)


def pressures(scene):
    """Contact pressure in MPa at each node that has one."""
    contact = scene.part
    depth = -np.concatenate([gap for _, gap, _ in contact._found()])
    return STIFFNESS * np.maximum(depth, 0.0)


@pytest.mark.parametrize("n", [1, 2])
def test_matching_meshes_pass_a_uniform_stress(n):
    scene = pressed("Q1 enhanced", n, n, by=1.6)
    depth = scene.part.penetration()
    expected = exact_force(1.6 - depth)
    assert expected > 1.0
    assert scene.part.total_force() == pytest.approx(expected, rel=1e-8)
    assert -scene.reaction("upper_outside", 1) == pytest.approx(expected, rel=1e-8)
    assert scene.reaction("lower_outside", 1) == pytest.approx(expected, rel=1e-8)
    assert depth == pytest.approx(expected / SIZE**2 / STIFFNESS, rel=1e-8)
    np.testing.assert_allclose(pressures(scene), STIFFNESS * depth, rtol=1e-7)


# Elements of the nodes' side and of the facets' side; deviation of the force; scatter (standard
# deviation over mean) of the pressure. Each node acts where it stands, which a coarse side that
# faces a fine one passes on badly; from both sides at half the stiffness it is fair.
@pytest.mark.parametrize("nodes, facets, both, deviation, scatter", [
    (3, 2, False, 0.01, 0.12), (2, 3, False, 0.04, 0.22), (3, 2, True, 0.01, 0.35)])
def test_meshes_that_do_not_match_pass_the_force(nodes, facets, both, deviation, scatter):
    scene = pressed("Q1 enhanced", facets, nodes, by=1.6, both=both)
    found = pressures(scene)
    expected = exact_force(1.6 - found.mean() / STIFFNESS)
    assert scene.part.total_force() == pytest.approx(expected, rel=deviation)
    assert found.std() < scatter * found.mean()
    assert -scene.reaction("upper_outside", 1) == pytest.approx(
        scene.reaction("lower_outside", 1), rel=1e-4)
