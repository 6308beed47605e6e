"""The largest stress in a resin body."""

from __future__ import annotations

import numpy as np
import ufl
from mpi4py import MPI

from . import compat
from .forms.resin import von_mises_stress
from .resin_body import ResinBody

__all__ = ["ResinStress"]


class ResinStress:
    """Von Mises' stress, the mean of each cell.

    In re-entrant corners, where pivots leave bars, it grows without bound as the mesh is refined:
    of two bodies compare meshes of one density.
    """

    def __init__(self, body: ResinBody) -> None:
        self._comm = body.comm
        space = compat.discontinuous_space(body.mesh, 0)
        v, dx = ufl.TestFunction(space), body.measure
        self._sum = compat.form(von_mises_stress(body.function, *body.moduli) * v * dx)
        self._volume = compat.form(v * dx)
        index_map = space.dofmap.index_map
        self._size, self._owned = index_map.size_local + index_map.num_ghosts, index_map.size_local

    def of_cells(self) -> np.ndarray:
        """Return the stress in MPa of each cell that this rank owns."""
        found, volume = np.zeros(self._size), np.zeros(self._size)
        compat.assemble_vector(self._sum, found)
        compat.assemble_vector(self._volume, volume)
        return found[: self._owned] / volume[: self._owned]

    def largest(self) -> float:
        """Return the largest stress in MPa. Collective."""
        return self._comm.allreduce(float(self.of_cells().max(initial=0.0)), op=MPI.MAX)
