"""Thick sphere and cylinder under inner pressure, outer radius twice the inner one."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import numpy as np
from mpi4py import MPI
from scipy.integrate import quad
from scipy.optimize import minimize_scalar

from morphing_wing.elastomer import Elastomer
from morphing_wing.forms.kinematics import cofactor, deformation_gradient
from morphing_wing.materials import DRAGON_SKIN_30, Yeoh

from .check import Check
from .equilibrium import Equilibrium, NoEquilibriumError
from .meshes import cylinder, octant

__all__ = ["exact_pressure", "limit_point", "thick_cylinder", "thick_sphere", "walls"]

A, B = 1.0, 2.0
STIFF = Yeoh(DRAGON_SKIN_30.coefficients, bulk=1e5 * DRAGON_SKIN_30.shear_modulus)
MATERIALS = {"Q2/P1disc": STIFF, "Q2 reduced": DRAGON_SKIN_30}


def exact_pressure(lam_a: float, shape: int) -> float:
    """Return the pressure in MPa of an incompressible wall at an inner stretch.

    The integral over the wall of W'(lam)/(lam^3 - 1) (``shape`` 3: sphere) or W'/(lam^2 - 1)
    (``shape`` 2: cylinder in plane strain).
    """
    C10, C20 = DRAGON_SKIN_30.coefficients

    def slope(lam: float) -> float:
        I1 = 2 * lam**2 + lam**-4 if shape == 3 else 1 + lam**2 + lam**-2
        dI1 = 4 * lam - 4 * lam**-5 if shape == 3 else 2 * lam - 2 * lam**-3
        return (C10 + 2 * C20 * (I1 - 3)) * dI1 / (lam**shape - 1)

    lam_b = (1 + (A / B) ** shape * (lam_a**shape - 1)) ** (1 / shape)
    return quad(slope, lam_b, lam_a)[0]


def _area_in_plane(body: Elastomer, pressure: Any) -> Any:
    """Pressure times the inner volume of a tube whose ends stay in their planes.

    x . n with x in the plane, halved, for the normal's volume has no part of the ends then.
    """
    normal = cofactor(deformation_gradient(body.u)) * body.normal
    x = body.X + body.u
    return body.on_face("inner", -pressure * (x[0] * normal[0] + x[1] * normal[1]) / 2.0)


def thick_sphere(element: str, comm: MPI.Comm) -> Equilibrium:
    """Return an eighth of the sphere, led by its inner volume."""
    return Equilibrium(comm, octant(A, B), MATERIALS[element], element,
                       lambda body, pressure: body.chamber_volume("inner", pressure),
                       led="inner", symmetry={"x": 0, "y": 1, "z": 2})


def thick_cylinder(element: str, comm: MPI.Comm) -> Equilibrium:
    """Return a quarter of the cylinder, led by its inner volume."""
    return Equilibrium(comm, cylinder(A, B), MATERIALS[element], element, _area_in_plane,
                       led="inner", symmetry={"x": 0, "y": 1, "ends": 2})


def limit_point(
    problem: Equilibrium, lowest: float, highest: float, steps: int = 8
) -> tuple[float, float]:
    """Return the largest load between two displacements, and the displacement there.

    Of the parabola through the largest of the loads on the way and those beside it.

    Raises
    ------
    NoEquilibriumError
        If the load is largest at an end.
    """
    problem.load_at(lowest, steps=4)
    q = np.linspace(lowest, highest, steps + 1)
    loads = np.array([problem.load_at(value) for value in q])
    i = int(loads.argmax())
    if not 0 < i < steps:
        raise NoEquilibriumError(f"no limit point between {lowest:g} and {highest:g}")
    a, b, c = np.polyfit(q[i - 1 : i + 2] - q[i], loads[i - 1 : i + 2], 2)
    return float(c - b**2 / (4.0 * a)), float(q[i] - b / (2.0 * a))


def walls(comm: MPI.Comm) -> Iterator[Check]:
    """Yield pressures at inner stretches, and the sphere's limit point."""
    for element in MATERIALS:
        for shape, make, name in ((3, thick_sphere, "sphere"), (2, thick_cylinder, "cylinder")):
            problem = make(element, comm)
            whole = problem.displacement()
            for lam in (1.25, 1.5, 2.0):
                yield Check(f"{element}, {name}, inner stretch {lam:g}: pressure",
                            problem.load_at(whole * lam**shape, steps=2),
                            exact_pressure(lam, shape), "MPa", 1e-3)
    problem = thick_sphere("Q2/P1disc", comm)
    whole = problem.displacement()
    pressure, volume = limit_point(problem, 1.6**3 * whole, 2.0**3 * whole)
    stretch = minimize_scalar(lambda lam: -exact_pressure(lam, 3), bounds=(1.1, 3.0),
                              method="bounded", options={"xatol": 1e-6}).x
    yield Check("Q2/P1disc, sphere: limit pressure", pressure, exact_pressure(stretch, 3), "MPa",
                5e-3)
    yield Check("Q2/P1disc, sphere: inner stretch at it", float(np.cbrt(volume / whole)), stretch,
                "", 2e-2)
