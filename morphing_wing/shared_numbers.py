"""Numbers that are unknowns of the whole system, seen by cells of a body."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
import ufl
from dolfinx import fem
from mpi4py import MPI

from . import compat
from .blocks import Block
from .system import EquilibriumSystem


class SharedNumbers:
    """A few unknowns, and what stands for them on cells of a body.

    Parameters
    ----------
    mesh
        The body's mesh.
    cells
        Local cells that see them.
    name
        Of the unknowns' function.
    size
        How many; None: one, a scalar.
    held
        Which of them keep their values.

    Attributes
    ----------
    blocks
        The unknowns, and what stands for them on the body's cells: the first to come before the
        local blocks of a system, the second among them.
    own, seen
        The numbers in UFL, on a mesh of their own and on the body's.
    mesh
        Their own mesh, one cell.
    """

    def __init__(
        self, mesh: Any, cells: np.ndarray, name: str, size: int | None = None,
        held: Sequence[int] = (),
    ) -> None:
        self._comm, self._cells = mesh.comm, cells
        self._size, shape = size or 1, () if size is None else (size,)
        ends = np.array([[0.0, 0.0, 0.0], [1.0, 0.0, 0.0]])
        self.mesh = compat.create_mesh(mesh.comm, "interval", np.array([[0, 1]]), ends)
        self.own = fem.Function(compat.discontinuous_space(self.mesh, 0, shape), name=name)
        self.seen = fem.Function(compat.discontinuous_space(mesh, 0, shape), name=f"{name}_seen")
        # The one cell's dofs are the numbers themselves.
        here = [i for i in held if i < len(self.own.x.array)]
        self.blocks = (Block(self.own, np.array(here, dtype=np.int32)),
                       Block(self.seen, local=True))

    def number(self, system: EquilibriumSystem) -> None:
        """Let the body's cells see the unknowns, once a system has given them their numbers."""
        seen, numbers = self.blocks[1], self.numbers
        table = np.full((len(self.seen.x.array) // self._size, self._size), -1, dtype=np.int64)
        for cell in self._cells:
            table[self.seen.function_space.dofmap.cell_dofs(cell)] = numbers
        system.renumber(seen, table.ravel())

    @property
    def numbers(self) -> np.ndarray:
        """What a system has given them, on every rank. Collective."""
        return self._everywhere(self.blocks[0].numbers)

    @property
    def values(self) -> np.ndarray:
        """The numbers' values, on every rank. Collective."""
        return self._everywhere(self.own.x.array)

    def _everywhere(self, local: np.ndarray) -> np.ndarray:
        total = np.zeros(self._size, dtype=local.dtype)
        owned = self.blocks[0].owned
        total[: len(owned)] = local[owned]
        return self._comm.allreduce(total, op=MPI.SUM)

    @property
    def measure(self) -> Any:
        """The measure of their own mesh, whose length is one."""
        return ufl.dx(domain=self.mesh, metadata={"quadrature_degree": 0})

    def constant(self, value: Any) -> Any:
        """Return a constant on their own mesh."""
        return compat.constant(self.mesh, value)
