"""Homogeneous deformations: the patch test, and the paper's Yeoh rubber in tension.

One volumetric point a cell ("Q1 reduced") cannot integrate the volume's gradient of a warped
hexahedron: that element passes on parallelepipeds, and on others in the limit of refinement.
"""

import numpy as np
import pytest
import ufl
from dolfinx import fem
from scipy.optimize import brentq

from morphing_wing import compat
from morphing_wing.elements import ELEMENTS
from morphing_wing.geometry.hexmesh import swept_blocks, uniform
from morphing_wing.materials import DRAGON_SKIN_30, Yeoh
from tests.verification.solving import Equilibrium

EACH_ELEMENT = pytest.mark.parametrize("element", list(ELEMENTS))
MILD = Yeoh(DRAGON_SKIN_30.coefficients, bulk=2.0)
IDENTITY = np.eye(3)
SIDES = tuple(f"{axis}{sign}" for axis in "xyz" for sign in "-+")


def cube(warp=0.08, n=3, affine=IDENTITY):
    """The unit cube in n^3 hexahedra, distorted inside by ``warp``, then all of it by a matrix."""
    def mapping(x):
        inside = np.prod(4.0 * x * (1.0 - x), axis=1)[:, None]
        distorted = x + warp * inside * np.stack([
            np.cos(5 * x[:, 1] + x[:, 2]), np.sin(4 * x[:, 2] - x[:, 0]),
            np.cos(6 * x[:, 0] + 2 * x[:, 1])], axis=1)
        return distorted @ affine.T

    def faces(midpoints, normals):
        return {f"{axis}{sign}": normals[:, i] * step > 0
                for i, axis in enumerate("xyz") for sign, step in (("-", -1), ("+", 1))}

    kind = np.ones((n, n, n), dtype=int)
    return swept_blocks((uniform(n),) * 3, kind, {1: "body"}, mapping, faces)


def patch_error(element, grid):
    """Largest deviation in mm from the homogeneous deformation that the boundary imposes."""
    H = np.array([[0.25, 0.1, 0.0], [-0.1, -0.1, 0.15], [0.05, 0.0, 0.1]])
    problem = Equilibrium(grid, MILD, element, clamped=SIDES)
    function = problem.displacement_function()
    function.interpolate(lambda x: H @ x)
    values = problem.body.function.x.array
    free = np.setdiff1d(np.arange(len(values)), problem.body.block.constrained)
    values[free] += 0.01 * np.random.default_rng(3).standard_normal(len(free))
    problem.solve()
    u = problem.body.displacement()
    expected = fem.Function(u.function_space)
    expected.interpolate(lambda x: H @ x)
    assert np.ptp(expected.x.array) > 0.3
    return np.abs(u.x.array - expected.x.array).max()


@pytest.mark.parametrize("element", [name for name in ELEMENTS if name != "Q1 reduced"])
def test_patch_of_distorted_hexahedra_deforms_homogeneously(element):
    assert patch_error(element, cube()) < 1e-9


@EACH_ELEMENT
def test_patch_of_oblique_hexahedra_deforms_homogeneously(element):
    shear = np.array([[1.0, 0.3, -0.2], [0.0, 1.1, 0.25], [0.0, 0.0, 0.9]])
    assert patch_error(element, cube(warp=0.0, affine=shear)) < 1e-9


def test_one_volumetric_point_passes_the_patch_test_in_the_limit_of_refinement():
    errors = [patch_error("Q1 reduced", cube(n=n)) for n in (6, 12)]
    assert 1e-5 < errors[0] < 1e-3
    assert errors[1] < errors[0] / 3


def principal_stress(material, stretches, k):
    """Nominal stress of Yeoh's rubber in principal stretches."""
    a = np.array(stretches)
    J, I1 = a.prod(), (a**2).sum()
    slope = sum(i * C * (J ** (-2 / 3) * I1 - 3.0) ** (i - 1)
                for i, C in enumerate(material.coefficients, start=1))
    isochoric = 2.0 * slope * J ** (-2 / 3) * (a[k] - I1 / (3.0 * a[k]))
    return isochoric + material.bulk * (J - 1.0) * J / a[k]


# Principal stretches by the given one and the free one; faces that are moved, beside the planes
# of symmetry; the free stretch of an incompressible body.
MODES = {
    "uniaxial": (lambda lam, t: (t, t, lam), ("z+",), lambda lam: lam**-0.5),
    "equibiaxial": (lambda lam, t: (lam, t, lam), ("x+", "z+"), lambda lam: lam**-2),
    "planar": (lambda lam, t: (t, 1.0, lam), ("y+", "z+"), lambda lam: 1.0 / lam),
}


def exact_stress(mode, material, lam):
    """Nominal stress along z in MPa with the free sides' stretch from their zero stress."""
    stretches, moved, guess = MODES[mode]
    free = 1 if mode == "equibiaxial" else 0
    t = brentq(lambda t: principal_stress(material, stretches(lam, t), free),
               0.9 * guess(lam), 1.2 * guess(lam), xtol=1e-15)
    return principal_stress(material, stretches(lam, t), 2)


def wave(x):
    """Something that is zero on the faces of the unit cube only."""
    return np.prod(np.sin(np.pi * x), axis=0) * np.sin(3.0 * x[[1, 2, 0]])


def computed_stress(mode, material, element, lam, grid):
    """Nominal stress along z in MPa: the stored energy's derivative by a stretch along z."""
    stretches, moved, guess = MODES[mode]
    held = {f"{axis}-": i for i, axis in enumerate("xyz")}
    held |= {face: "xyz".index(face[0]) for face in moved}
    problem = Equilibrium(grid, material, element, symmetry=held)
    body, growth = problem.body, fem.Function(problem.body.function.function_space)
    before = np.ones(3)
    for step in np.linspace(1.0, lam, 2 + int(abs(lam - 1.0) / 0.3))[1:]:
        # Held faces move as wanted, all else to a first guess that is not in equilibrium.
        now = np.array(stretches(step, guess(step)))
        factors = now - before
        part = body.displacement_part(growth)
        part.interpolate(lambda x, factors=factors: factors[:, None] * (x + 0.1 * wave(x)))
        body.function.x.array[:] += growth.x.array
        problem.solve()
        before = now
    v = fem.Function(body.function.function_space)
    body.displacement_part(v).interpolate(
        lambda x: np.stack([0 * x[0], 0 * x[0], x[2]]))
    work = compat.form(ufl.derivative(body.energy, body.function, v))
    return compat.assemble_scalar(body.comm, work)


@pytest.mark.parametrize("element", ["Q2/P1disc", "Q2/Q1", "Q1/P0"])
@pytest.mark.parametrize("mode", list(MODES))
@pytest.mark.parametrize("lam", [0.9, 1.5, 3.0])
def test_stress_of_mixed_forms_with_free_sides_is_the_closed_forms(element, mode, lam):
    computed = computed_stress(mode, DRAGON_SKIN_30, element, lam, cube())
    assert computed == pytest.approx(exact_stress(mode, DRAGON_SKIN_30, lam), rel=1e-9)


@pytest.mark.parametrize("element, grid", [
    ("Q2 reduced", cube()), ("Q1 reduced", cube(warp=0.0)), ("Q1 enhanced", cube())])
@pytest.mark.parametrize("mode", list(MODES))
@pytest.mark.parametrize("lam", [0.9, 1.5, 2.0])
def test_stress_of_displacement_forms_with_free_sides_is_the_closed_forms(element, grid, mode, lam):
    computed = computed_stress(mode, DRAGON_SKIN_30, element, lam, grid)
    assert computed == pytest.approx(exact_stress(mode, DRAGON_SKIN_30, lam), rel=1e-9)


def test_enhanced_strains_have_no_hourglasses_in_strong_compression():
    # `Equilibrium.solve` refuses negative pivots.
    computed = computed_stress("uniaxial", DRAGON_SKIN_30, "Q1 enhanced", 0.4, cube(warp=0.0))
    assert computed == pytest.approx(exact_stress("uniaxial", DRAGON_SKIN_30, 0.4), rel=1e-9)


@pytest.mark.parametrize("lam, stress", [
    (1.5, 0.2453), (2.0, 0.3999), (3.0, 0.6231), (4.0, 0.7754), (4.64, 0.8357)])
def test_incompressible_rubber_has_the_papers_uniaxial_stress(lam, stress):
    incompressible = Yeoh(DRAGON_SKIN_30.coefficients, bulk=1e8 * DRAGON_SKIN_30.shear_modulus)
    computed = computed_stress("uniaxial", incompressible, "Q2/P1disc", lam, cube())
    assert computed == pytest.approx(stress, abs=5e-5)
    slope = 0.117 - 2 * 0.0006865 * (lam**2 + 2 / lam - 3)
    assert computed == pytest.approx(2 * (lam - lam**-2) * slope, rel=1e-6)
