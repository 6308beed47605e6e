r"""A load that is an unknown: the displacement on which it works is given instead.

Past a limit point the load falls while its displacement grows; to give the displacement (a
chamber's volume, say) leads through it. The load is then the multiplier of

.. math:: \Pi = E(u) - \lambda \, (q(u) - q^*) ,

one more unknown of the same matrix, whose one more negative pivot is no loss of stability.
"""

from __future__ import annotations

from typing import Any

import numpy as np
import ufl
from dolfinx import fem
from mpi4py import MPI

from . import compat
from .blocks import Block
from .system import EquilibriumSystem


class LedLoad:
    """A load as an unknown, seen by all cells of a body.

    Parameters
    ----------
    mesh
        The body's mesh.
    cells
        Local cells at which the load acts.

    Attributes
    ----------
    blocks
        The unknown, and what stands for it on the body's cells: the first to come before the local
        blocks of a system, the second among them.
    seen
        The load as a UFL coefficient on the body's mesh.
    """

    def __init__(self, mesh: Any, cells: np.ndarray) -> None:
        self._comm = mesh.comm
        ends = np.array([[0.0, 0.0, 0.0], [1.0, 0.0, 0.0]])
        self._mesh = compat.create_mesh(mesh.comm, "interval", np.array([[0, 1]]), ends)
        self._value = fem.Function(compat.discontinuous_space(self._mesh, 0), name="load")
        self._given = compat.constant(self._mesh, 0.0)
        self.seen = fem.Function(compat.discontinuous_space(mesh, 0), name="load_seen")
        self._cells = cells
        self.blocks = (Block(self._value), Block(self.seen, local=True))

    def number(self, system: EquilibriumSystem) -> None:
        """Let the body's cells see the unknown, once a system has given it its number."""
        own, seen = self.blocks
        mine = own.numbers[own.owned]
        number = self._comm.allreduce(int(mine[0]) if len(mine) else -1, op=MPI.MAX)
        numbers = np.full(len(self.seen.x.array), -1, dtype=np.int64)
        for cell in self._cells:
            numbers[self.seen.function_space.dofmap.cell_dofs(cell)] = number
        system.renumber(seen, numbers)

    @property
    def potential(self) -> Any:
        """The load times the given displacement, a UFL functional."""
        measure = ufl.dx(domain=self._mesh, metadata={"quadrature_degree": 0})
        return self._value * self._given * measure

    def lead(self, displacement: float) -> None:
        """Give the displacement on which the load works."""
        self._given.value = displacement

    @property
    def value(self) -> float:
        """The load."""
        own = self.blocks[0]
        mine = self._value.x.array[own.owned]
        return self._comm.allreduce(float(mine.sum()) if len(mine) else 0.0)
