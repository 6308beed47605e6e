r"""Thin membranes past their limit points: a spherical balloon and a clamped flat circle.

The balloon of reference radius R and thickness T has the closed form

.. math:: p = \frac{4 T}{R} (\lambda^{-1} - \lambda^{-7}) \frac{dW}{dI_1} .

The circle's figures come from the equations of equilibrium of an axially symmetric membrane, shot
from its middle to the clamped rim.
"""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
from mpi4py import MPI
from scipy.optimize import minimize_scalar

from morphing_wing.materials import DRAGON_SKIN_30

from .check import Check
from .equilibrium import Equilibrium
from .meshes import disc, octant
from .thick_walls import STIFF, limit_point

__all__ = ["balloon", "circle", "membranes"]

THICKNESS = 0.01
"""Wall in mm; the balloon's mean radius and the circle's are 1 mm."""


def balloon(comm: MPI.Comm) -> Equilibrium:
    """Return an eighth of a thin balloon, led by its inner volume."""
    grid = octant(1.0 - THICKNESS / 2, 1.0 + THICKNESS / 2, n=3, layers=1)
    return Equilibrium(comm, grid, STIFF, "Q2/P1disc",
                       lambda body, pressure: body.chamber_volume("inner", pressure),
                       led="inner", symmetry={"x": 0, "y": 1, "z": 2})


def balloon_pressure(stretch: float) -> float:
    """Return p R/(T C10) of the balloon at a stretch."""
    C10, C20 = DRAGON_SKIN_30.coefficients
    slope = C10 + 2.0 * C20 * (2.0 * stretch**2 + stretch**-4 - 3.0)
    return 4.0 * (1.0 / stretch - stretch**-7) * slope / C10


def circle(comm: MPI.Comm, n: int = 8) -> Equilibrium:
    """Return a quarter of a flat membrane clamped at its rim, led by the volume above its plane.

    The pressure pushes on the upper face, down; the volume that this face encloses with the plane
    z = 0 is the pressure's displacement.
    """
    return Equilibrium(comm, disc(1.0, THICKNESS, n), STIFF, "Q2/P1disc",
                       lambda body, pressure: body.chamber_volume("top", pressure),
                       led="top", clamped=("rim",), symmetry={"x": 0, "y": 1})


def membranes(comm: MPI.Comm) -> Iterator[Check]:
    """Yield limit pressures, and the deformation at them."""
    C10 = DRAGON_SKIN_30.coefficients[0]
    problem = balloon(comm)
    whole = problem.displacement()
    pressure, volume = limit_point(problem, 1.25**3 * whole, 1.5**3 * whole)
    stretch = minimize_scalar(lambda lam: -balloon_pressure(lam), bounds=(1.05, 2.0),
                              method="bounded", options={"xatol": 1e-6}).x
    yield Check("balloon: limit pressure, p R/(T C10)", pressure / (THICKNESS * C10),
                balloon_pressure(stretch), "", 2e-2)
    yield Check("balloon: stretch at it", float(np.cbrt(volume / whole)), stretch, "", 2e-2)
    problem = circle(comm)
    for volume in (0.002, 0.01, 0.05, 0.2):
        problem.load_at(volume)
    pressure, volume = limit_point(problem, 0.4, 0.8)
    yield Check("clamped circle: limit pressure, p a/(T C10)", pressure / (THICKNESS * C10),
                3.59783, "", 2e-2)
    problem.load_at(volume, steps=4)
    rise = -float(problem.at(np.array([0.0, 0.0, 0.0]))[2])
    yield Check("clamped circle: rise at it over a", rise, 1.08548, "", 2e-2)
