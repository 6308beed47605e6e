r"""Land et al. 2015, problem 1: a beam of cardiac muscle bent by a pressure from below.

Land and others, Proc. R. Soc. A 471 (2015) 20150641: Guccione's transversely isotropic law,

.. math:: W = \tfrac{C}{2} (e^Q - 1), \quad
    Q = b_f E_{11}^2 + b_t (E_{22}^2 + E_{33}^2 + 2 E_{23}^2) + 2 b_{fs} (E_{12}^2 + E_{13}^2),

incompressible, fibres along the beam.
"""

from __future__ import annotations

from collections.abc import Iterator
from functools import cached_property
from typing import Any

import numpy as np
import ufl
from dolfinx import fem
from mpi4py import MPI

from morphing_wing.elastomer import Elastomer
from morphing_wing.forms.hyperelasticity import mixed_volumetric_energy
from morphing_wing.forms.kinematics import cofactor, deformation_gradient
from morphing_wing.materials import Yeoh

from .check import Check
from .equilibrium import Equilibrium, NoEquilibriumError
from .meshes import prism

__all__ = ["land", "tip_height"]

C, B_F, B_T, B_FS = 2e-3, 8.0, 2.0, 4.0  # MPa
PRESSURE = 4e-6  # MPa
MOST_ROUNDS = 60


class Muscle(Elastomer):
    """A body of Guccione's material, exactly incompressible; of its Yeoh material nothing is used.

    The pressure on an open face whose edges are free has no potential: its force is held as that
    of an earlier state, ``last``, which `tip_height` brings up to date.
    """

    @cached_property
    def energy(self) -> Any:
        """Stored energy in N mm, a UFL functional."""
        F = deformation_gradient(self.u)
        E = (ufl.transpose(F) * F - ufl.Identity(3)) / 2
        Q = (B_F * E[0, 0] ** 2 + B_T * (E[1, 1] ** 2 + E[2, 2] ** 2 + 2 * E[1, 2] ** 2)
             + 2 * B_FS * (E[0, 1] ** 2 + E[0, 2] ** 2))
        dx = self.volume_measure()
        return (C / 2 * (ufl.exp(Q) - 1) + mixed_volumetric_energy(F, self.p, 0.0)) * dx

    @cached_property
    def last(self) -> fem.Function:
        """The state that the pressure's force is taken from."""
        return fem.Function(self.function.function_space)


def _push(body: Muscle, pressure: Any) -> Any:
    force = -pressure * cofactor(deformation_gradient(ufl.split(body.last)[0])) * body.normal
    return body.on_face("z-", ufl.inner(force, body.u))


def tip_height(across: int, comm: MPI.Comm) -> float:
    """Return the deformed z in mm of the point (10, 0.5, 1), with Q2-Q1 elements.

    Raises
    ------
    NoEquilibriumError
        If the pressure's force does not settle.
    """
    n = (10 * across, across, across)
    problem = Equilibrium(comm, prism((10.0, 1.0, 1.0), n), Yeoh((C,)), "Q2/Q1", _push, body=Muscle,
                          clamped=("x-",))
    tip = np.array([10.0, 0.5, 1.0])
    steps = np.linspace(0.0, PRESSURE, 9)[1:]
    height = np.inf
    for number in range(MOST_ROUNDS):
        problem.load.value = steps[min(number, len(steps) - 1)]
        problem.solve()
        problem.body.last.x.array[:] = problem.body.function.x.array
        before, height = height, 1.0 + float(problem.at(tip)[2])
        if number >= len(steps) and abs(height - before) < 1e-6:
            return height
    raise NoEquilibriumError(f"the follower force still changed after {MOST_ROUNDS} rounds")


def land(comm: MPI.Comm) -> Iterator[Check]:
    """Yield the tip's height on two meshes."""
    for across, known in ((1, 4.1575), (2, 4.1695)):
        yield Check(f"Q2/Q1, {across} across: deformed height of the tip",
                    tip_height(across, comm), known, "mm", 1.2e-5)
