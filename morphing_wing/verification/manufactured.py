"""A manufactured solution: how fast displacement and pressure converge with the mesh."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import numpy as np
import ufl
from mpi4py import MPI
from scipy.spatial.transform import Rotation

from morphing_wing import compat
from morphing_wing.elements import ELEMENTS
from morphing_wing.forms.hyperelasticity import volumetric_energy, yeoh_energy
from morphing_wing.forms.kinematics import deformation_gradient
from morphing_wing.forms.resin import green_strain, resin_stress
from morphing_wing.materials import Elastic

from .check import Check
from .equilibrium import TETRAHEDRA, Equilibrium
from .homogeneous import MILD, material_of
from .meshes import SIDES, cube, tetrahedra, tube

__all__ = ["convergence", "errors"]

AMPLITUDE = 0.08
TURN = Rotation.from_rotvec(np.radians([40.0, -60.0, 50.0])).as_matrix()
DEGREE = 7
"""Quadrature of the load and of the errors."""

PRESSURE_ORDERS = {"Q2/P1disc": 2.0, "Q2/Q1": 2.0, "Q1/P0": 1.0}


def _displacement(x: Any, of: Any) -> list[Any]:
    """Return the displacement in mm at points, waves then turned; ``of`` offers sin and cos."""
    waved = [x[0] + AMPLITUDE * of.sin(2.0 * x[1] + x[2]),
             x[1] + AMPLITUDE * of.cos(2.0 * x[2] - x[0]),
             x[2] + AMPLITUDE * of.sin(3.0 * x[0] + x[1])]
    return [sum(TURN[i, j] * waved[j] for j in range(3)) - x[i] for i in range(3)]


def _work(body: Any, part: Any) -> Any:
    """Return the work of the exact stress on the displacement: what the body force does."""
    exact = ufl.as_vector(_displacement(body.X, ufl))
    F = ufl.variable(deformation_gradient(exact))
    if isinstance(body.material, Elastic):
        stress = F * resin_stress(green_strain(exact), *body.moduli)
    else:
        density = yeoh_energy(F, MILD.coefficients) + volumetric_energy(F, MILD.bulk)
        stress = ufl.diff(density, F)
    return part * ufl.inner(stress, ufl.grad(body.u)) * body.volume_measure(DEGREE)


def errors(element: str, n: int, comm: MPI.Comm) -> dict[str, float]:
    """Return the L2 errors of the displacement, and of the pressure if the element has one."""
    grid = tetrahedra(n) if element == TETRAHEDRA else cube(n)
    problem = Equilibrium(comm, grid, material_of(element), element, _work, clamped=SIDES)
    problem.load.value = 1.0
    body = problem.body
    problem.displacement_function().interpolate(lambda x: np.array(_displacement(x, np)))
    problem.solve()
    exact = ufl.as_vector(_displacement(body.X, ufl))
    off = {"displacement": body.u - exact}
    if element in PRESSURE_ORDERS:
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
    # Curved edges reach the order late: 2.98 where they are straight.
    coarse, fine = (errors(TETRAHEDRA, n, comm)["displacement"] for n in (4, 8))
    yield Check(f"{TETRAHEDRA}: order of the displacement", np.log2(coarse / fine), 3.0, "",
                0.2 / 3.0)
    # Volumes of arcs through three points err by the fourth power, as Simpson's rule does.
    coarse, fine = (0.75 * np.pi - tetrahedra(n, tube).volume() for n in (2, 4))
    yield Check(f"{TETRAHEDRA}: order of a tube's volume", np.log2(coarse / fine), 4.0, "",
                0.1 / 4.0)

