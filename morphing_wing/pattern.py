"""Which entries of a system's matrix its tangents set."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any

import numpy as np
from mpi4py import MPI
from petsc4py import PETSc
from scipy.sparse import coo_matrix, csr_matrix, vstack

from . import compat
from .blocks import Block


class Pattern:
    """The pattern of the matrix of several blocks.

    Parameters
    ----------
    comm
        Communicator of all meshes.
    independent, blocks
        The blocks that have unknowns of their own, and all of them, those first.
    first, size
        This rank's first number, and the global number of unknowns.
    """

    def __init__(
        self,
        comm: MPI.Comm,
        independent: Sequence[Block],
        blocks: Sequence[Block],
        first: int,
        size: int,
    ) -> None:
        self._comm, self._independent, self._blocks = comm, list(independent), list(blocks)
        self._first, self._size = first, size
        self._n_owned = sum(block.n_owned for block in self._independent)
        self._lasting: csr_matrix | None = None

    def rows(
        self, tangents: Sequence[tuple[int, int, Any]], free: Callable[[Block], np.ndarray]
    ) -> csr_matrix:
        """Return this rank's rows; those of the independent blocks are found once. Collective.

        Parameters
        ----------
        tangents
            Numbers of two blocks and the compiled form that couples them.
        free
            Returns a block's numbers, -1 for what is held or stands for nothing.
        """
        n = len(self._independent)
        if self._lasting is None:
            self._lasting = self._independent_rows([t for t in tangents if max(t[:2]) < n])
        found = [self._local_pattern(free, i, j) for i, j, _ in tangents if max(i, j) >= n]
        csr = self._lasting + self._as_rows(found) if found else self._lasting
        csr.sort_indices()
        return csr

    def _as_rows(self, found: Sequence[tuple[np.ndarray, np.ndarray]]) -> csr_matrix:
        row = np.concatenate([rows for rows, _ in found]) - self._first
        column = np.concatenate([columns for _, columns in found])
        shape = (self._n_owned, self._size)
        return coo_matrix((np.ones(len(row), dtype=bool), (row, column)), shape=shape).tocsr()

    def _independent_rows(self, tangents: Sequence[tuple[int, int, Any]]) -> csr_matrix:
        """Return the pattern of forms of independent blocks, the diagonal with it."""
        start, rows = self._first, []
        for b, block in enumerate(self._independent):
            n = block.n_owned
            diagonal = csr_matrix((np.ones(n, dtype=bool), start + np.arange(n), np.arange(n + 1)),
                                  shape=(n, self._size))
            parts = [self._independent_pattern(*tangent) for tangent in tangents if tangent[0] == b]
            # Small ones first: only the last sum is of the size of the largest.
            rows.append(sum(sorted(parts, key=lambda part: part.nnz), start=diagonal))
            start += n
        return vstack(rows, format="csr") if len(rows) > 1 else rows[0]

    def _independent_pattern(self, i: int, j: int, form: Any) -> csr_matrix:
        pattern = compat.sparsity(self._comm, form)
        column = self._of_columns(j).astype(PETSc.IntType)[pattern.indices]
        indptr = pattern.indptr
        present = column >= 0
        if not present.all():
            kept = np.concatenate([[0], np.cumsum(present)])
            column, indptr = column[present], kept[indptr]
        csr = csr_matrix((np.ones(len(column), dtype=bool), column, indptr),
                         shape=(len(indptr) - 1, self._size))
        unknown = self._of_rows(i) >= 0
        return csr if unknown.all() else csr[np.flatnonzero(unknown)]

    def _of_rows(self, b: int) -> np.ndarray:
        """Return the system's number of each dof of a block that this rank owns."""
        block = self._blocks[b]
        n = block.function.function_space.dofmap.index_map.size_local * block.block_size
        return block.numbers[:n]

    def _of_columns(self, b: int) -> np.ndarray:
        """Return the system's number of each dof of a block, in its own global numbering."""
        return np.concatenate(self._comm.allgather(self._of_rows(b)))

    def _local_pattern(
        self, free: Callable[[Block], np.ndarray], i: int, j: int
    ) -> tuple[np.ndarray, np.ndarray]:
        numbers = [_cell_numbers(self._blocks[b], free) for b in (i, j)]
        both = np.logical_and(*((part >= 0).any(axis=1) for part in numbers))
        rows, columns = (part[both] for part in numbers)
        shape = (len(rows), rows.shape[1], columns.shape[1])
        row = np.broadcast_to(rows[:, :, None], shape).ravel()
        column = np.broadcast_to(columns[:, None, :], shape).ravel()
        present = (row >= 0) & (column >= 0)
        pairs = np.unique(np.stack([row[present], column[present]]), axis=1)
        row, column = np.concatenate(self._comm.allgather(pairs), axis=1)
        mine = (row >= self._first) & (row < self._first + self._n_owned)
        return row[mine], column[mine]


def _cell_numbers(block: Block, free: Callable[[Block], np.ndarray]) -> np.ndarray:
    """Return the numbers of each local cell's unknowns, -1 for what is held or nothing."""
    dofmap, mesh = block.function.function_space.dofmap, block.function.function_space.mesh
    index_map = mesh.topology.index_map(mesh.topology.dim)
    n_cells = index_map.size_local + index_map.num_ghosts
    nodes = np.array([dofmap.cell_dofs(cell) for cell in range(n_cells)], dtype=np.int64)
    size = block.block_size
    dofs = nodes.reshape(n_cells, dofmap.dof_layout.num_dofs, 1) * size + np.arange(size)
    return free(block)[dofs.reshape(n_cells, dofs.shape[1] * size)]
