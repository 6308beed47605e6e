"""Homogeneous deformations: the patch test, rubber and resin in tension and shear."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence

import numpy as np
from dolfinx import fem
from mpi4py import MPI
from scipy.optimize import brentq

from morphing_wing.elements import ELEMENTS
from morphing_wing.geometry.hexmesh import HexMesh
from morphing_wing.geometry.tetmesh import TetMesh
from morphing_wing.materials import DRAGON_SKIN_30, RESIN, Elastic, Yeoh

from .check import Check
from .equilibrium import TETRAHEDRA, Equilibrium
from .meshes import SIDES, cube, tetrahedra

__all__ = ["computed_stress", "exact_resin_stress", "exact_stress", "homogeneous", "material_of",
           "patch", "patch_error", "principal_stress", "shear_stress"]

MILD = Yeoh(DRAGON_SKIN_30.coefficients, bulk=2.0)
OBLIQUE = np.array([[1.0, 0.3, -0.2], [0.0, 1.1, 0.25], [0.0, 0.0, 0.9]])


def material_of(element: str) -> Yeoh | Elastic:
    """Return what a body of an element is of: resin or mild rubber."""
    return RESIN if element == TETRAHEDRA else MILD


def grid_of(element: str) -> HexMesh | TetMesh:
    """Return a cube in the worst cells on which an element passes the patch test.

    One volumetric point a cell cannot integrate the volume's gradient of a warped hexahedron.
    Second-order tetrahedra may be curved.
    """
    if element == TETRAHEDRA:
        return tetrahedra()
    return cube(warp=0.0, affine=OBLIQUE) if element == "Q1 reduced" else cube()


def patch_error(element: str, grid: HexMesh | TetMesh, comm: MPI.Comm) -> float:
    """Return the largest deviation in mm from the homogeneous deformation of the boundary."""
    H = np.array([[0.25, 0.1, 0.0], [-0.1, -0.1, 0.15], [0.05, 0.0, 0.1]])
    problem = Equilibrium(comm, grid, material_of(element), element, clamped=SIDES)
    problem.displacement_function().interpolate(lambda x: H @ x)
    values = problem.body.function.x.array
    free = np.setdiff1d(np.arange(len(values)), problem.body.block.constrained)
    values[free] += 0.01 * np.random.default_rng(3).standard_normal(len(free))
    problem.body.function.x.scatter_forward()
    problem.solve()
    u = problem.body.displacement()
    expected = fem.Function(u.function_space)
    expected.interpolate(lambda x: H @ x)
    off = float(np.abs(u.x.array - expected.x.array).max(initial=0.0))
    return comm.allreduce(off, op=MPI.MAX)


def patch(comm: MPI.Comm) -> Iterator[Check]:
    """Yield the patch test of every element."""
    for element in (*ELEMENTS, TETRAHEDRA):
        yield Check(f"{element}: deviation", patch_error(element, grid_of(element), comm), 0.0,
                    "mm", 1e-12 if element == TETRAHEDRA else 1e-9)


def principal_stress(material: Yeoh, stretches: Sequence[float], k: int) -> float:
    """Return the nominal stress of Yeoh's rubber in principal stretches."""
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


def exact_stress(mode: str, material: Yeoh, lam: float) -> float:
    """Return the nominal stress along z in MPa where the free sides bear none."""
    stretches, _, guess = MODES[mode]
    free = 1 if mode == "equibiaxial" else 0
    t = brentq(lambda t: principal_stress(material, stretches(lam, t), free),
               0.9 * guess(lam), 1.2 * guess(lam), xtol=1e-15)
    return principal_stress(material, stretches(lam, t), 2)


def exact_resin_stress(mode: str, material: Elastic, lam: float) -> float:
    """Return the same of St Venant and Kirchhoff's law: Hooke's stress of Green's strain."""
    E, nu = material.E, material.nu
    modulus = {"uniaxial": E, "equibiaxial": E / (1.0 - nu), "planar": E / (1.0 - nu**2)}[mode]
    return lam * modulus * (lam**2 - 1.0) / 2.0


def _wave(x: np.ndarray) -> np.ndarray:
    """Return something that is zero on the faces of the unit cube only."""
    return np.prod(np.sin(np.pi * x), axis=0) * np.sin(3.0 * x[[1, 2, 0]])


def computed_stress(
    mode: str, material: Yeoh | Elastic, element: str, lam: float, grid: HexMesh | TetMesh,
    comm: MPI.Comm,
) -> float:
    """Return the nominal stress along z in MPa: inner forces' work on a stretch along z."""
    stretches, moved, guess = MODES[mode]
    held = {f"{axis}-": i for i, axis in enumerate("xyz")}
    held |= {face: "xyz".index(face[0]) for face in moved}
    problem = Equilibrium(comm, grid, material, element, symmetry=held)
    body, growth = problem.body, fem.Function(problem.body.function.function_space)
    before = np.ones(3)
    for step in np.linspace(1.0, lam, 2 + int(abs(lam - 1.0) / 0.3))[1:]:
        # Held faces move as wanted, all else to a first guess that is not in equilibrium.
        now = np.array(stretches(step, guess(step)))
        factors = now - before
        body.displacement_part(growth).interpolate(
            lambda x, factors=factors: factors[:, None] * (x + 0.1 * _wave(x)))
        body.function.x.array[:] += growth.x.array
        problem.solve()
        before = now
    return problem.force_along(lambda x: np.stack([0 * x[0], 0 * x[0], x[2]]))


def shear_stress(
    material: Yeoh | Elastic, element: str, shear: float, grid: HexMesh | TetMesh, comm: MPI.Comm
) -> float:
    """Return the shear stress in MPa of the unit cube sheared by its boundary: x moves with y."""
    problem = Equilibrium(comm, grid, material, element, clamped=SIDES)
    body, growth = problem.body, fem.Function(problem.body.function.function_space)
    steps = 2
    body.displacement_part(growth).interpolate(lambda x: shear / steps * np.stack(
        [x[1], 0 * x[0], 0 * x[0]]) + 0.02 * _wave(x))
    for _ in range(steps):
        body.function.x.array[:] += growth.x.array
        problem.solve()
    return problem.force_along(lambda x: np.stack([x[1], 0 * x[0], 0 * x[0]]))


def homogeneous(comm: MPI.Comm) -> Iterator[Check]:
    """Yield stresses of every element in tension, compression and simple shear."""
    C10, C20 = DRAGON_SKIN_30.coefficients
    for element in ELEMENTS:
        grid = cube(warp=0.0) if element == "Q1 reduced" else cube()
        for mode in MODES:
            for lam in (0.9, 2.0):
                yield Check(
                    f"{element}, {mode}, stretch {lam:g}: nominal stress",
                    computed_stress(mode, DRAGON_SKIN_30, element, lam, grid, comm),
                    exact_stress(mode, DRAGON_SKIN_30, lam), "MPa", 1e-8)
        yield Check(f"{element}, simple shear by 0.5: shear stress",
                    shear_stress(DRAGON_SKIN_30, element, 0.5, grid, comm),
                    2.0 * 0.5 * (C10 + 2.0 * C20 * 0.5**2), "MPa", 1e-8)
    incompressible = Yeoh((C10, C20), bulk=math.inf)
    for lam in (1.5, 2.0, 3.0, 4.0, 4.64):
        slope = C10 + 2.0 * C20 * (lam**2 + 2.0 / lam - 3.0)
        yield Check(f"incompressible, uniaxial, stretch {lam:g}: nominal stress",
                    computed_stress("uniaxial", incompressible, "Q2/P1disc", lam, cube(), comm),
                    2.0 * (lam - lam**-2) * slope, "MPa", 1e-6)
    for mode in MODES:
        for lam in (0.9, 1.1):
            yield Check(f"{TETRAHEDRA}, resin, {mode}, stretch {lam:g}: nominal stress",
                        computed_stress(mode, RESIN, TETRAHEDRA, lam, tetrahedra(), comm),
                        exact_resin_stress(mode, RESIN, lam), "MPa", 1e-8)
    # F S with F = I + shear e_x e_y, of which E_xy = shear/2 and E_yy = shear^2/2.
    shear, mu = 0.3, RESIN.shear_modulus
    yield Check(f"{TETRAHEDRA}, resin, simple shear by {shear:g}: shear stress",
                shear_stress(RESIN, TETRAHEDRA, shear, tetrahedra(), comm),
                mu * shear + (RESIN.lame_modulus / 2.0 + mu) * shear**3, "MPa", 1e-8)
