"""A mesh of points: unknowns of others come together where no cell holds them all.

Each point is a cell of length one with a few numbers of its own. They stand for unknowns of other
functions: those of a node and of the facet that it touches, say. An energy of these numbers is
plain UFL, and its derivatives are compiled like all others.
"""

from __future__ import annotations

from typing import Any

import numpy as np
import ufl
from dolfinx import fem
from mpi4py import MPI

from . import compat
from .blocks import Block


class PointMesh:
    """Points of this rank alone, with ``size`` unknowns and ``data_size`` given numbers each.

    Attributes
    ----------
    function
        The unknowns.
    block
        Their numbers in a system, -1 at first: see `EquilibriumSystem.renumber`.
    """

    def __init__(self, n_points: int, size: int, data_size: int, name: str) -> None:
        # Without a cell there is no mesh; a point too many weighs nothing.
        n = max(n_points, 1)
        ends = np.stack([np.arange(n + 1.0), np.zeros(n + 1), np.zeros(n + 1)], axis=1)
        cells = np.stack([np.arange(n), np.arange(n) + 1], axis=1)
        self.mesh = compat.create_mesh(MPI.COMM_SELF, "interval", cells, ends)
        self.n_points = n_points
        self.function = fem.Function(compat.discontinuous_space(self.mesh, 0, (size,)), name=name)
        self._data = fem.Function(compat.discontinuous_space(self.mesh, 0, (data_size,)))
        self._cells = np.array([self.function.function_space.dofmap.cell_dofs(c)[0]
                                for c in range(n)])[:n_points]
        self.block = Block(self.function, local=True)

    @property
    def data(self) -> Any:
        """The given numbers, a UFL vector."""
        return self._data

    def set_data(self, rows: np.ndarray) -> None:
        """Set the given numbers of all points, (n_points, data_size)."""
        self._data.x.array.reshape(-1, rows.shape[1])[self._cells] = rows

    def values(self) -> np.ndarray:
        """Return the unknowns, (n_points, size)."""
        return self.function.x.array.reshape(-1, self.function.function_space.dofmap.index_map_bs)[
            self._cells]

    def as_dofs(self, rows: np.ndarray, fill: float = 0) -> np.ndarray:
        """Return rows (n_points, size) in the order of the function's dofs."""
        size = self.function.function_space.dofmap.index_map_bs
        table = np.full((len(self.function.x.array) // size, size), fill, dtype=rows.dtype)
        table[self._cells] = rows
        return table.ravel()

    def sum(self, integrand: Any) -> Any:
        """Return the sum of an integrand over all points, a UFL functional."""
        return integrand * ufl.dx(domain=self.mesh, metadata={"quadrature_degree": 0})
