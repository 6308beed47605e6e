"""A manufactured solution: how fast displacement and pressure converge with the mesh."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import numpy as np
import ufl
from mpi4py import MPI

from morphing_wing import compat
from morphing_wing.elastomer import Elastomer
from morphing_wing.elements import ELEMENTS
from morphing_wing.forms.hyperelasticity import volumetric_energy, yeoh_energy
from morphing_wing.forms.kinematics import deformation_gradient

from .check import Check
from .equilibrium import Equilibrium
from .homogeneous import MILD
from .meshes import SIDES, cube

__all__ = ["convergence", "errors"]

AMPLITUDE = 0.08
DEGREE = 7
"""Quadrature of the load and of the errors."""

PRESSURE_ORDERS = {"Q2/P1disc": 2.0, "Q2/Q1": 2.0, "Q1/P0": 1.0}


def _displacement(x: Any, of: Any) -> list[Any]:
    """Return the displacement in mm at points; ``of`` offers sin and cos."""
    return [AMPLITUDE * of.sin(2.0 * x[1] + x[2]), AMPLITUDE * of.cos(2.0 * x[2] - x[0]),
            AMPLITUDE * of.sin(3.0 * x[0] + x[1])]


def _work(body: Elastomer, part: Any) -> Any:
    """Return the work of the exact stress on the displacement: what the body force does."""
    F = ufl.variable(deformation_gradient(ufl.as_vector(_displacement(body.X, ufl))))
    density = yeoh_energy(F, MILD.coefficients) + volumetric_energy(F, MILD.bulk)
    stress = ufl.diff(density, F)
    return part * ufl.inner(stress, ufl.grad(body.u)) * body.volume_measure(DEGREE)


def errors(element: str, n: int, comm: MPI.Comm) -> dict[str, float]:
    """Return the L2 errors of the displacement, and of the pressure if the element has one."""
    problem = Equilibrium(comm, cube(n), MILD, element, _work, clamped=SIDES)
    problem.load.value = 1.0
    body = problem.body
    problem.displacement_function().interpolate(lambda x: np.array(_displacement(x, np)))
    problem.solve()
    exact = ufl.as_vector(_displacement(body.X, ufl))
    off = {"displacement": body.u - exact}
    if body.p is not None:
        off["pressure"] = body.p - MILD.bulk * (ufl.det(deformation_gradient(exact)) - 1.0)
    dx = body.volume_measure(DEGREE)
    return {name: np.sqrt(compat.assemble_scalar(comm, compat.form(ufl.inner(e, e) * dx)))
            for name, e in off.items()}


def convergence(comm: MPI.Comm) -> Iterator[Check]:
    """Yield the order of convergence of every element between two meshes."""
    for name, element in ELEMENTS.items():
        orders = {"displacement": element.degree + 1.0}
        if name in PRESSURE_ORDERS:
            orders["pressure"] = PRESSURE_ORDERS[name]
        coarse, fine = (errors(name, n, comm)
                        for n in ((3, 6) if element.degree == 2 else (6, 12)))
        for what, order in orders.items():
            yield Check(f"{name}: order of the {what}", np.log2(coarse[what] / fine[what]), order,
                        "", 0.1 / order)
