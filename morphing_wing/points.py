"""A mesh of points: unknowns of others come together where no cell holds them all.

Each point is a cell of length one with a few numbers of its own. They stand for unknowns of other
functions: those of a node and of the facet that it touches, say. An energy of these numbers is
plain UFL, and its derivatives are compiled like all others.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
import ufl
from dolfinx import fem
from mpi4py import MPI

from . import compat
from .blocks import Block


class PointMesh:
    """Points with ``size`` unknowns and ``data_size`` given numbers each, shared out to the ranks.

    Attributes
    ----------
    mine : (n_mine,) int array
        Which of all points this rank has.
    function
        The unknowns.
    block
        Their numbers in a system, -1 at first: see `EquilibriumSystem.renumber`.
    """

    def __init__(self, comm: MPI.Comm, n_points: int, size: int, data_size: int, name: str) -> None:
        ends = np.zeros((2 * n_points, 3))
        ends[:, 0] = np.arange(n_points).repeat(2) * 2.0 + np.tile([0.0, 1.0], n_points)
        cells = np.arange(2 * n_points).reshape(n_points, 2)
        self.mesh = compat.create_mesh(comm, "interval", cells, ends)
        self.mine = compat.original_cells(self.mesh).astype(int)
        self.function = fem.Function(compat.discontinuous_space(self.mesh, 0, (size,)), name=name)
        self._data = fem.Function(compat.discontinuous_space(self.mesh, 0, (data_size,)))
        self._cells = np.array([self.function.function_space.dofmap.cell_dofs(c)[0]
                                for c in range(len(self.mine))], dtype=int)
        self.block = Block(self.function, local=True)

    @property
    def data(self) -> Any:
        """The given numbers, a UFL vector."""
        return self._data

    def set_data(self, rows: np.ndarray) -> None:
        """Set the given numbers of this rank's points, (n_mine, data_size)."""
        self._data.x.array.reshape(-1, rows.shape[1])[self._cells] = rows

    def values(self) -> np.ndarray:
        """Return the unknowns of this rank's points, (n_mine, size)."""
        return self.function.x.array.reshape(-1, self.function.function_space.dofmap.index_map_bs)[
            self._cells]

    def as_dofs(self, rows: np.ndarray) -> np.ndarray:
        """Return numbers (n_mine, size) in the order of the function's dofs."""
        size = self.function.function_space.dofmap.index_map_bs
        table = np.full((len(self.function.x.array) // size, size), -1, dtype=rows.dtype)
        table[self._cells] = rows
        return table.ravel()

    def gathered(self, values: np.ndarray) -> np.ndarray:
        """Return this rank's values (n_mine, ...) with the others', in order. Collective."""
        parts = self.mesh.comm.allgather((self.mine, values))
        order = np.argsort(np.concatenate([points for points, _ in parts]))
        return np.concatenate([part for _, part in parts])[order]

    def each(self, integrand: Any) -> Callable[[], np.ndarray]:
        """Return what evaluates an integrand at all points, in order. Collective, as that is."""
        space = compat.discontinuous_space(self.mesh, 0)
        function = fem.Function(space)
        form = compat.form(self.sum(integrand * ufl.TestFunction(space)))

        def values() -> np.ndarray:
            function.x.array[:] = 0.0
            compat.assemble_vector(form, function.x.array)
            return self.gathered(function.x.array[self._cells])

        return values

    def sum(self, integrand: Any) -> Any:
        """Return the sum of an integrand over all points, a UFL functional."""
        return integrand * ufl.dx(domain=self.mesh, metadata={"quadrature_degree": 0})
