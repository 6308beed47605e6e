"""One set of equations from several finite-element functions and their energies.

Every unknown has one number in one PETSc vector. A block maps its function's rank-local dofs to
those numbers: one to one for an independent field, many to one for a *local* block, whose dofs
stand for unknowns of others (those of a face and of the rib's end glued to it, say). Energies then
couple fields by plain UFL: residual and tangent are their derivatives, and the map adds them up.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
import ufl
from mpi4py import MPI
from petsc4py import PETSc

from . import compat
from .blocks import Block
from .pattern import Pattern


class EquilibriumSystem:
    """Residual and tangent of a sum of energies, in one PETSc vector and one PETSc matrix.

    Parameters
    ----------
    comm
        Communicator of all meshes.
    blocks
        Independent blocks first, then local ones, which stand for nothing until `renumber`.
    """

    def __init__(self, comm: MPI.Comm, blocks: Sequence[Block]) -> None:
        self.comm = comm
        self.blocks = list(blocks)
        self._n_independent = sum(not block.local for block in blocks)
        self._number_independent()
        for block in self.blocks[self._n_independent :]:
            block.numbers = np.full(len(block.function.x.array), -1, dtype=np.int64)
        self.n_owned = sum(block.n_owned for block in self.blocks[: self._n_independent])
        self._find_held()
        self.x = PETSc.Vec().createMPI((self.n_owned, None), comm=comm)
        self._lay_out()
        self._build_scatter()
        self._matrix: PETSc.Mat | None = None
        independent = self.blocks[: self._n_independent]
        self._pattern = Pattern(comm, independent, self.blocks, self._first, self.size)
        self._residuals: list[Any] = []
        self._tangents: list[tuple[int, int, Any]] = []
        self._energies: list[Any] = []

    # -- the functional -----------------------------------------------------------------------

    def set_energies(
        self,
        energies: Sequence[Any],
        tangent_corrections: Sequence[Any | None] | Mapping[int, Any | None] = (),
    ) -> None:
        """Set the functional to a sum of energies, UFL functionals.

        Each is compiled on its own: a load or a part that comes or goes makes nothing else new.
        ``tangent_corrections[i]`` is a bilinear form of block i, added to the tangent of the first
        energy that depends on that block, or None: every block that stores energy has an entry.
        """
        self._residuals, self._tangents = [], []
        self._energies = list(energies)
        given = tangent_corrections
        corrections = dict(given if isinstance(given, Mapping) else enumerate(given))
        for energy in energies:
            for i, block in enumerate(self.blocks):
                residual = _derivative(energy, block.function, 0)
                if residual is None:
                    continue
                self._residuals.append((i, compat.form(residual)))
                # A potential that is linear, as a weight's is, has no tangent; stored ones are not.
                stored = i in corrections
                expanded = residual if stored else ufl.algorithms.expand_derivatives(residual)
                depends_on = expanded.coefficients()
                for j, other in enumerate(self.blocks):
                    tangent = _derivative(residual, other.function, 1)
                    if tangent is None or other.function not in depends_on:
                        continue
                    correction = corrections.pop(i, None) if i == j else None
                    if correction is not None:
                        tangent = tangent + correction
                    self._tangents.append((i, j, compat.form(tangent)))
        assert not any(corrections.values()), "a correction of a block that no energy depends on"
        if self._matrix is None:
            self._matrix = self._create_matrix()

    def renumber(self, block: Block, numbers: np.ndarray) -> None:
        """Let a local block's dofs stand for other unknowns. Collective; the matrix is a new one.

        Parameters
        ----------
        block
            The block; its function then holds the present values of those unknowns.
        numbers
            Global number of each local dof, -1 for one that stands for nothing.
        """
        block.numbers = numbers
        block.function.x.array[:] = 0.0
        for old in (self._scatter, self._local, self._matrix):
            if old is not None:
                old.destroy()
        self._lay_out()
        self._build_scatter()
        self._matrix = None
        if self._tangents:
            self._matrix = self._create_matrix()
        self.share()

    def share(self) -> None:
        """Hand the independent blocks' values on to the local ones. Collective."""
        x = self.x.duplicate()
        self.push(x)
        self.pull(x)
        x.destroy()

    @property
    def matrix(self) -> PETSc.Mat:
        """The one matrix of this system."""
        assert self._matrix is not None
        return self._matrix

    @property
    def size(self) -> int:
        """Global number of unknowns, constrained ones included."""
        return self.x.getSize()

    @property
    def free(self) -> np.ndarray:
        """Which of this rank's unknowns are not held, as a mask."""
        free = np.ones(self.n_owned, dtype=bool)
        free[self._constrained_rows - self._first] = False
        return free

    # -- moving between the vector and the functions ------------------------------------------

    def pull(self, x: PETSc.Vec) -> None:
        """Copy unknowns from the vector into all functions, ghosts included."""
        self._scatter.scatter(x, self._local, addv=False, mode=PETSc.ScatterMode.FORWARD)
        values = self._local.getArray(readonly=True)
        for block, (positions, source) in zip(self.blocks, self._pulled, strict=True):
            block.function.x.array[positions] = values[source]
            if block.refresh is not None:
                block.refresh()

    def push(self, x: PETSc.Vec) -> None:
        """Copy the functions' owned values into the vector."""
        start = 0
        array = x.getArray()
        for block in self.blocks[: self._n_independent]:
            array[start : start + block.n_owned] = block.function.x.array[block.owned]
            start += block.n_owned

    def gather(self, local: Sequence[np.ndarray | None], out: PETSc.Vec) -> None:
        """Add rank-local arrays of the blocks (None: nothing) into a zeroed vector."""
        self._local.set(0.0)
        values = self._local.getArray()
        for array, (positions, source) in zip(local, self._added, strict=True):
            if array is not None:
                np.add.at(values, source, array[positions])
        out.set(0.0)
        self._scatter.scatter(self._local, out, addv=True, mode=PETSc.ScatterMode.REVERSE)

    # -- assembly -----------------------------------------------------------------------------

    def residual(self, x: PETSc.Vec, out: PETSc.Vec) -> None:
        """Evaluate the residual; constrained rows are zero."""
        self.pull(x)
        local: list[np.ndarray | None] = [None] * len(self.blocks)
        for i, form in self._residuals:
            if local[i] is None:
                local[i] = np.zeros_like(self.blocks[i].function.x.array)
            compat.assemble_vector(form, local[i])
        self.gather(local, out)

    def tangent(self) -> PETSc.Mat:
        """Assemble the tangent at the functions' present values."""
        A = self.matrix
        A.zeroEntries()
        for i, j, form in self._tangents:
            rows, columns = self._index_sets[i], self._index_sets[j]
            sub = A.getLocalSubMatrix(rows, columns)
            compat.assemble_matrix(sub, form)
            A.restoreLocalSubMatrix(rows, columns, sub)
        A.assemblyBegin(PETSc.Mat.AssemblyType.FLUSH)
        A.assemblyEnd(PETSc.Mat.AssemblyType.FLUSH)
        for row in self._constrained_rows:
            A.setValue(row, row, 1.0, addv=PETSc.InsertMode.INSERT_VALUES)
        A.assemble()
        return A

    def energies(self) -> list[float]:
        """Evaluate each energy, in N mm, over all ranks."""
        forms = map(compat.form, self._energies)
        return [compat.assemble_scalar(self.comm, form) for form in forms]

    # -- numbering ----------------------------------------------------------------------------

    def _number_independent(self) -> None:
        independent = self.blocks[: self._n_independent]
        total = sum(block.n_owned for block in independent)
        start = self.comm.exscan(total) or 0
        self._first = start
        for block in independent:
            # Ghosts learn their numbers from their owners by a scatter of the function itself.
            values = block.function.x.array.copy()
            block.function.x.array[:] = -1.0
            block.function.x.array[block.owned] = start + np.arange(block.n_owned)
            block.function.x.scatter_forward()
            block.numbers = np.rint(block.function.x.array).astype(np.int64)
            block.function.x.array[:] = values
            start += block.n_owned

    def _find_held(self) -> None:
        """Find the unknowns that are held: this rank's, and all ranks'."""
        owned = np.arange(self._first, self._first + self.n_owned)
        free = [self._free(block) for block in self.blocks[: self._n_independent]]
        self._constrained_rows = np.setdiff1d(owned, np.concatenate(free)).astype(PETSc.IntType)
        self._held = np.concatenate(self.comm.allgather(self._constrained_rows))

    def _free(self, block: Block) -> np.ndarray:
        numbers = block.numbers.copy()
        numbers[np.isin(numbers, self._held) if block.local else block.constrained] = -1
        return numbers

    def _lay_out(self) -> None:
        """Line up all blocks' numbers."""
        ends = np.cumsum([0, *(len(block.numbers) for block in self.blocks)])
        self._spans = list(zip(ends[:-1], ends[1:], strict=True))
        self._free_numbers = np.concatenate([self._free(block) for block in self.blocks])

    def _build_scatter(self) -> None:
        # Local blocks are told of what is held; their energies do no work on it.
        seen = [block.numbers if block.local else self._free(block) for block in self.blocks]
        wanted = np.unique(np.concatenate(seen))
        wanted = wanted[wanted >= 0].astype(PETSc.IntType)
        self._local = PETSc.Vec().createSeq(len(wanted))
        self._scatter = PETSc.Scatter().create(
            self.x,
            PETSc.IS().createGeneral(wanted, comm=self.comm),
            self._local,
            PETSc.IS().createStride(len(wanted), 0, 1, comm=MPI.COMM_SELF),
        )
        free = [self._free_numbers[start:end] for start, end in self._spans]
        self._pulled, self._added = (
            [(np.flatnonzero(part >= 0), np.searchsorted(wanted, part[part >= 0]))
             for part in parts] for parts in (seen, free))

    # -- the matrix ---------------------------------------------------------------------------

    def _create_matrix(self) -> PETSc.Mat:
        csr = self._pattern.rows(self._tangents, self._free)
        A = PETSc.Mat().createAIJ(
            ((self.n_owned, None), (self.n_owned, None)),
            csr=(csr.indptr.astype(PETSc.IntType), csr.indices.astype(PETSc.IntType)),
            comm=self.comm,
        )
        A.setOption(PETSc.Mat.Option.SYMMETRIC, True)
        A.setOption(PETSc.Mat.Option.NEW_NONZERO_ALLOCATION_ERR, True)
        # Number -1 drops what is added to a constrained row or column: symmetry is kept.
        A.setLGMap(
            PETSc.LGMap().create(self._free_numbers.astype(PETSc.IntType), comm=self.comm)
        )
        self._index_sets = [self._index_set(b) for b in range(len(self.blocks))]
        return A

    def _index_set(self, b: int) -> PETSc.IS:
        start, end = self._spans[b]
        return PETSc.IS().createStride(end - start, start, 1, comm=MPI.COMM_SELF)


def _derivative(form: Any, function: Any, number: int) -> Any | None:
    if function not in form.coefficients():
        return None
    argument = ufl.classes.Argument(function.function_space, number)
    return ufl.derivative(form, function, argument)
