"""Thick sphere and cylinder under inner pressure, B/A = 2, against the incompressible solution."""

import numpy as np
import pytest
from scipy.integrate import quad
from scipy.optimize import brentq

from morphing_wing.forms.kinematics import cofactor, deformation_gradient
from morphing_wing.geometry.hexmesh import HexMesh, geometric, swept_blocks, uniform
from morphing_wing.materials import DRAGON_SKIN_30, Yeoh
from tests.verification.solving import Equilibrium

A, B = 1.0, 2.0
C10, C20 = DRAGON_SKIN_30.coefficients
STIFF = Yeoh((C10, C20), bulk=1e5 * DRAGON_SKIN_30.shear_modulus)
MATERIALS = {"Q2/P1disc": STIFF, "Q2 reduced": DRAGON_SKIN_30}


def exact_pressure(lam_a, shape):
    """Return the pressure in MPa at an inner stretch; ``shape`` 3: sphere, 2: cylinder.

    The integral over the wall of W'(lam)/(lam^3 - 1) or W'/(lam^2 - 1).
    """
    def slope(lam):
        I1 = 2 * lam**2 + lam**-4 if shape == 3 else 1 + lam**2 + lam**-2
        dI1 = 4 * lam - 4 * lam**-5 if shape == 3 else 2 * lam - 2 * lam**-3
        return (C10 + 2 * C20 * (I1 - 3)) * dI1 / (lam**shape - 1)

    lam_b = (1 + (A / B) ** shape * (lam_a**shape - 1)) ** (1 / shape)
    return quad(slope, lam_b, lam_a)[0]


def cylinder(n=5, layers=4):
    """A quarter of a tube, 0.4 mm of its length; planes of symmetry at its ends."""
    lines = (A + (B - A) * geometric(layers, 1.3), uniform(n) * np.pi / 2, np.array([0.0, 0.4]))

    def mapping(grid):
        r, angle, z = grid.T
        return np.stack([r * np.cos(angle), r * np.sin(angle), z], axis=1)

    def faces(midpoints, normals):
        return {"inner": normals[:, 0] < 0, "y": (normals[:, 1] < 0), "x": normals[:, 1] > 0,
                "ends": normals[:, 2] != 0}

    return swept_blocks(lines, np.ones((layers, n, 1), int), {1: "wall"}, mapping, faces)


def octant(n=3, layers=3):
    """An eighth of a hollow sphere: three blocks, one for each face of a cube that meets there."""
    lines = (uniform(n), uniform(n), A + (B - A) * geometric(layers, 1.3))

    def faces(midpoints, normals):
        return {"inner": normals[:, 2] < 0, "first": normals[:, 0] < 0, "second": normals[:, 1] < 0}

    points, cells, facets = [], [], {name: [] for name in ("inner", "x", "y", "z")}
    for axis in range(3):
        def mapping(grid, axis=axis):
            direction = np.column_stack([np.tan(grid[:, :2] * np.pi / 4), np.ones(len(grid))])
            x = grid[:, 2:] * direction / np.linalg.norm(direction, axis=1)[:, None]
            return np.roll(x, axis, axis=1)

        block = swept_blocks(lines, np.ones((n, n, layers), int), {1: "wall"}, mapping, faces)
        first = len(cells) * n * n * layers
        names = {"inner": "inner", "first": "xyz"[axis], "second": "xyz"[(1 + axis) % 3]}
        for name, face in names.items():
            facets[face].append(block.facets[name] + np.array([first, 0]))
        cells.append(block.cells + sum(map(len, points)))
        points.append(block.points)
    points, cells = np.concatenate(points), np.concatenate(cells)
    _, kept, number = np.unique(np.round(points, 9) + 0.0, axis=0, return_index=True,
                                return_inverse=True)
    facets = {name: np.concatenate(found) for name, found in facets.items()}
    cells = number.ravel()[cells]
    return HexMesh(points[kept], cells, {"wall": np.arange(len(cells))}, facets)


def area_in_plane(body):
    """Inner volume of a tube whose ends stay in their planes: x . n with x in the plane, halved."""
    normal = cofactor(deformation_gradient(body.u)) * body.normal
    x = body.X + body.u
    return body.on_face("inner", -(x[0] * normal[0] + x[1] * normal[1]) / 2.0)


def pressure_at(problem, undeformed, lam, shape, first_guess):
    """Return the pressure in MPa that stretches the inside by ``lam``, from a first guess."""
    def excess(pressure):
        problem.pressure.value = pressure
        problem.solve()
        return (problem.enclosed() / undeformed) ** (1 / shape) - lam

    return brentq(excess, 0.97 * first_guess, 1.03 * first_guess, xtol=1e-7, rtol=1e-5)


@pytest.mark.parametrize("shape, lam, pressure", [
    (3, 1.1, 0.067164), (3, 1.25, 0.128834), (3, 1.5, 0.175436), (3, 2.0, 0.184329),
    (2, 1.25, 0.064448), (2, 1.5, 0.099831), (2, 2.0, 0.132634)])
@pytest.mark.quick
def test_closed_form_gives_the_known_pressures(shape, lam, pressure):
    assert exact_pressure(lam, shape) == pytest.approx(pressure, abs=6e-7)


@pytest.mark.parametrize("element", list(MATERIALS))
def test_sphere_takes_the_exact_pressure(element):
    held = {"x": 0, "y": 1, "z": 2}
    problem = Equilibrium(octant(), MATERIALS[element], element,
                          lambda body: body.chamber_volume("inner"), symmetry=held)
    undeformed = problem.enclosed()
    for lam in (1.25, 1.5):
        exact = exact_pressure(lam, 3)
        _lead_to(problem, 0.97 * exact)
        found = pressure_at(problem, undeformed, lam, 3, exact)
        assert found == pytest.approx(exact, rel=1e-3)


@pytest.mark.parametrize("element", list(MATERIALS))
def test_cylinder_takes_the_exact_pressure(element):
    held = {"x": 0, "y": 1, "ends": 2}
    problem = Equilibrium(cylinder(), MATERIALS[element], element, area_in_plane, symmetry=held)
    undeformed = problem.enclosed()
    for lam in (1.25, 1.5):
        exact = exact_pressure(lam, 2)
        _lead_to(problem, 0.97 * exact)
        found = pressure_at(problem, undeformed, lam, 2, exact)
        assert found == pytest.approx(exact, rel=1e-3)


def _lead_to(problem, pressure, steps=3):
    start = float(problem.pressure.value)
    for part in np.arange(1, steps + 1) / steps:
        problem.pressure.value = start + part * (pressure - start)
        problem.solve()
