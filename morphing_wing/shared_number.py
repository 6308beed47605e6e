"""A number that is an unknown of the whole system, seen by cells of a body."""

from __future__ import annotations

from typing import Any

import numpy as np
import ufl
from dolfinx import fem
from mpi4py import MPI

from . import compat
from .blocks import Block
from .system import EquilibriumSystem


class SharedNumber:
    """One unknown, and what stands for it on cells of a body.

    Parameters
    ----------
    mesh
        The body's mesh.
    cells
        Local cells that see it.
    name
        Of the unknown's function.

    Attributes
    ----------
    blocks
        The unknown, and what stands for it on the body's cells: the first to come before the local
        blocks of a system, the second among them.
    own, seen
        The number in UFL, on a mesh of its own and on the body's.
    """

    def __init__(self, mesh: Any, cells: np.ndarray, name: str) -> None:
        self._comm = mesh.comm
        ends = np.array([[0.0, 0.0, 0.0], [1.0, 0.0, 0.0]])
        self._mesh = compat.create_mesh(mesh.comm, "interval", np.array([[0, 1]]), ends)
        self.own = fem.Function(compat.discontinuous_space(self._mesh, 0), name=name)
        self.seen = fem.Function(compat.discontinuous_space(mesh, 0), name=f"{name}_seen")
        self._cells = cells
        self.blocks = (Block(self.own), Block(self.seen, local=True))

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
    def value(self) -> float:
        """The number. Collective."""
        own = self.blocks[0]
        mine = self.own.x.array[own.owned]
        return self._comm.allreduce(float(mine.sum()) if len(mine) else 0.0)

    @property
    def measure(self) -> Any:
        """The measure of the unknown's own mesh, whose length is one."""
        return ufl.dx(domain=self._mesh, metadata={"quadrature_degree": 0})

    def constant(self, value: float) -> Any:
        """Return a constant on the unknown's own mesh."""
        return compat.constant(self._mesh, value)
