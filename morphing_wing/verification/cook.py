"""Cook's membrane in plane strain at finite strain: a tapered panel under a dead shear load."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import numpy as np
from mpi4py import MPI

from morphing_wing.elastomer import Elastomer
from morphing_wing.materials import Yeoh

from .check import Check
from .equilibrium import Equilibrium
from .meshes import cook as panel

__all__ = ["cook", "tip_deflection"]

MATERIAL = Yeoh((80.1938 / 2.0,), bulk=400942.0)
FORCE, EDGE = 100.0, 16.0  # N a mm of thickness, mm
CONVERGED = 6.93186
"""Deflection in mm of another code with Q2-Q1 at 32 a side."""


def _rise(body: Elastomer, force: Any) -> Any:
    """Force times the mean rise of the right edge."""
    return body.on_face("x+", force * body.u[1] / EDGE)


def tip_deflection(element: str, n: int, comm: MPI.Comm) -> float:
    """Return the rise in mm of the upper right corner, of n x n hexahedra."""
    problem = Equilibrium(comm, panel(n), MATERIAL, element, _rise, clamped=("x-",),
                          symmetry={"z-": 2, "z+": 2})
    for part in (0.5, 1.0):
        problem.load.value = part * FORCE
        problem.solve(FORCE)
    return float(problem.at(np.array([48.0, 60.0, 0.0]))[1])


def cook(comm: MPI.Comm) -> Iterator[Check]:
    """Yield the deflection of Q2-Q1 on three meshes, and of the default element on the finest."""
    for n, known in ((8, 6.92735), (16, 6.93110), (32, CONVERGED)):
        yield Check(f"Q2/Q1, {n} a side: deflection", tip_deflection("Q2/Q1", n, comm), known, "mm",
                    7e-7)
    yield Check("Q2/P1disc, 32 a side: deflection", tip_deflection("Q2/P1disc", 32, comm),
                CONVERGED, "mm", 1e-3)
