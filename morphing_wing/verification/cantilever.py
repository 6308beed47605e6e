"""A straight bar of beams clamped at its start, under loads at its end."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import ufl
from mpi4py import MPI

from morphing_wing import compat
from morphing_wing.blocks import Block
from morphing_wing.frame import BeamFrame
from morphing_wing.geometry.frame import Frame, local_axes
from morphing_wing.geometry.section import Rectangle, Section
from morphing_wing.materials import RESIN, Elastic
from morphing_wing.newton import Newton
from morphing_wing.system import EquilibriumSystem

from .equilibrium import NoEquilibriumError

__all__ = ["Cantilever"]

SQUARE = Rectangle(1.0, 1.0)


class Cantilever:
    """The bar and its equations.

    Parameters
    ----------
    comm, cells
        Communicator; number of beams.
    length, direction
        Length in mm, and unit vector along the bar from the origin.
    section, material
        Of all beams.

    Attributes
    ----------
    beams, system
        The frame, and its equations.
    """

    def __init__(
        self,
        comm: MPI.Comm,
        cells: int,
        length: float = 10.0,
        direction: Sequence[float] = (1.0, 0.0, 0.0),
        section: Section = SQUARE,
        material: Elastic = RESIN,
    ) -> None:
        points = np.linspace(0.0, length, cells + 1)[:, None] * np.asarray(direction)
        bars = np.stack([np.arange(cells), np.arange(1, cells + 1)], axis=1)
        kinds = np.zeros(cells, dtype=int)
        kinds[-1] = 1
        frame = Frame(points, bars, kinds, ("shaft", "tail"), local_axes(points, bars),
                      ({"shaft": section, "tail": section},), np.zeros(cells, dtype=int),
                      np.array([0]), np.array([cells]))
        self.beams = beams = BeamFrame(comm, frame, material)
        w = beams.function
        at_root = np.linalg.norm(w.function_space.tabulate_dof_coordinates(), axis=1) < 1e-9
        clamped = (6 * np.flatnonzero(at_root)[:, None] + np.arange(6)).ravel()
        self.system = EquilibriumSystem(comm, [Block(w, clamped)])
        self._load = compat.constant(beams.mesh, np.zeros(6))
        self.system.set_energies(
            [beams.energy, -beams.at_ends("tail", ufl.inner(self._load, w))],
            [beams.tangent_correction])
        self.newton = Newton(self.system, "verification_beam_",
                             before_tangent=beams.iterate.before_tangent)

    def tip_after(self, load: Sequence[float]) -> np.ndarray:
        """Return u (mm) and theta of the tip under a dead force (N) and moment (N mm).

        Raises
        ------
        NoEquilibriumError
            If Newton does not converge.
        """
        self._load.value = np.asarray(load, dtype=float)
        result = self.newton.solve(float(np.linalg.norm(load)))
        if not result.converged:
            raise NoEquilibriumError(result.reason)
        self.beams.iterate.accept()
        return self.beams.end_values("tail", 0)
