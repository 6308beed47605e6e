"""Numbers that are unknowns of the whole system, seen by cells of a body."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import Any

import numpy as np
import ufl
from dolfinx import fem
from mpi4py import MPI

from . import compat
from .blocks import Block
from .system import EquilibriumSystem


class SharedNumbers:
    """A few unknowns, or as many of each of several groups, and what stands for them on cells.

    Parameters
    ----------
    mesh
        The body's mesh.
    groups
        Of each group the local cells that see its numbers; no cell is in two.
    name
        Of the unknowns' function.
    size
        How many a group has; None: one, a scalar.
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
        Their own mesh, one cell a group.
    """

    def __init__(
        self, mesh: Any, groups: Sequence[np.ndarray], name: str, size: int | None = None,
        held: Sequence[int] = (),
    ) -> None:
        self._comm, self._groups = mesh.comm, groups
        self._size, shape = size or 1, () if size is None else (size,)
        n = len(groups)
        ends = np.zeros((2 * n, 3))
        ends[:, 0] = np.arange(n).repeat(2) * 2.0 + np.tile([0.0, 1.0], n)
        cells = np.arange(2 * n).reshape(n, 2)
        self.mesh = compat.create_mesh(mesh.comm, "interval", cells, ends)
        self._mine = compat.original_cells(self.mesh).astype(int)
        self.own = fem.Function(compat.discontinuous_space(self.mesh, 0, shape), name=name)
        self.seen = fem.Function(compat.discontinuous_space(mesh, 0, shape), name=f"{name}_seen")
        constrained = self._rows(self.own, range(len(self._mine)))[:, list(held)].ravel()
        self.blocks = (Block(self.own, constrained.astype(np.int32)), Block(self.seen, local=True))

    def number(self, system: EquilibriumSystem) -> None:
        """Let the body's cells see the unknowns, once a system has given them their numbers."""
        seen = np.full(len(self.seen.x.array), -1, dtype=np.int64)
        for cells, numbers in zip(self._groups, self.numbers, strict=True):
            seen[self._rows(self.seen, cells)] = numbers
        system.renumber(self.blocks[1], seen)

    @property
    def numbers(self) -> np.ndarray:
        """What a system has given them, (groups, size), on every rank. Collective."""
        return self._everywhere(self.blocks[0].numbers)

    @property
    def values(self) -> np.ndarray:
        """The numbers' values, (groups, size), on every rank. Collective."""
        return self._everywhere(self.own.x.array)

    def _everywhere(self, local: np.ndarray) -> np.ndarray:
        total = np.zeros((len(self._groups), self._size), dtype=local.dtype)
        total[self._mine] = local[self._rows(self.own, range(len(self._mine)))]
        return self._comm.allreduce(total, op=MPI.SUM)

    def each(self, values: np.ndarray) -> fem.Function:
        """Return the function on their own mesh that has a value (groups,) in each group."""
        function = fem.Function(compat.discontinuous_space(self.mesh, 0))
        for cell, group in enumerate(self._mine):
            function.x.array[function.function_space.dofmap.cell_dofs(cell)] = values[group]
        return function

    def _rows(self, function: fem.Function, cells: Iterable[int]) -> np.ndarray:
        """Return the dofs of a function's numbers in some cells, (cells, size)."""
        dofmap = function.function_space.dofmap
        first = np.array([dofmap.cell_dofs(cell)[0] for cell in cells], dtype=int)
        return self._size * first[:, None] + np.arange(self._size)

    @property
    def measure(self) -> Any:
        """The measure of their own mesh: of length one for each group."""
        return ufl.dx(domain=self.mesh, metadata={"quadrature_degree": 0})

    def constant(self, value: Any) -> Any:
        """Return a constant on their own mesh."""
        return compat.constant(self.mesh, value)
