"""Cholesky (LDL^T) factors that know their inertia, and a Newton step that uses it.

Where thin skin buckles, the tangent K of a displacement form has negative eigenvalues away from
equilibrium and a plain Newton step runs towards a saddle. Here (K + a M) d = -F is solved with a
lumped mass M of the thin part; ``a`` rises until the factor has no surplus negative pivots, and
falls to zero as the residual does. The residual is untouched: what converges is an equilibrium of
the unregularised problem.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass

import numpy as np
from mpi4py import MPI
from petsc4py import PETSc

from .cholesky import Cholesky


@dataclass(frozen=True)
class Regularisation:
    """When and how much to regularise.

    Attributes
    ----------
    mass : (n_owned,) array
        Lumped mass in mm^3 of each owned unknown; zero where nothing is added.
    longest_step
        Largest change in mm of a displacement in one iteration.
    displacements : (n_owned,) bool array
        Which unknowns are displacements.
    """

    mass: np.ndarray
    displacements: np.ndarray
    longest_step: float = 20.0


class InertiaCholesky:
    """A PETSc Python preconditioner: MUMPS LDL^T of the tangent, regularised where needed.

    Parameters
    ----------
    regularisation
        None: factorise as it is and count the negative pivots.
    expected_negative
        Number of negative pivots of a stable state: the pressures of a mixed form.
    prefix
        Prefix of the PETSc options of the inner factorisation.

    Attributes
    ----------
    amount
        Factor of the mass that is added at present.
    negative_pivots, error
        MUMPS' INFOG(12) and INFOG(1) of the last factor; a negative error: there is none.
    factorisations
        Number of factors so far.
    stale
        Whether the tangent is newer than the factor.
    incurable
        Whether more mass, raised ``most_in_vain`` times in a row by ``raises``, took away none of
        the surplus negative pivots of the last tangent, and they are more than ``tolerated``.
    tolerated
        Surplus negative pivots of the state that the solve starts from.
    part
        Called with a step; returns which part of it to take. None: all of it.
    """

    raises = 100.0
    most_in_vain = 3

    def __init__(
        self, regularisation: Regularisation | None, expected_negative: int, prefix: str
    ) -> None:
        self.regularisation = regularisation
        self.expected_negative = expected_negative
        self.amount = 0.0
        self.negative_pivots = 0
        self.error = 0
        self.factorisations = 0
        self.stale = True
        self.incurable = False
        self.tolerated = 0
        self.part: Callable[[PETSc.Vec], float] | None = None
        self._prefix = prefix
        self._inner: Cholesky | None = None
        self._unit_value: float | None = None
        self._diagonal: PETSc.Vec | None = None
        self._changed = False

    # -- called by PETSc ----------------------------------------------------------------------

    def setUp(self, pc: PETSc.PC) -> None:
        """Factorise a new tangent, with more mass until its inertia is that of a minimum."""
        # Adding mass changes the matrix, which PETSc would take for a new tangent.
        if not self.stale:
            return
        self.stale = False
        self._take(pc.getOperators()[1])
        self._factorise()
        if self.regularisation is None:
            return
        unit, least, in_vain = self._unit(), self.surplus, 0
        while self.surplus > 0 and in_vain < self.most_in_vain and self.error >= 0:
            self.amount = max(self.amount * self.raises, unit)
            self._factorise()
            in_vain = in_vain + 1 if self.surplus >= least else 0
            least = min(least, self.surplus)
        self.incurable = self.surplus > self.tolerated

    def apply(self, pc: PETSc.PC, b: PETSc.Vec, y: PETSc.Vec) -> None:
        """Solve, and shorten a step that is too long. Without a factor the step is NaN."""
        self.solve(b, y)
        if self.error < 0:
            return
        if self.regularisation is not None:
            length = self._length(y)
            if length > self.regularisation.longest_step:
                y.scale(self.regularisation.longest_step / length)
        if self.part is not None:
            y.scale(self.part(y))

    def solve(self, b: PETSc.Vec, y: PETSc.Vec) -> None:
        """Solve with the last factor, however long what comes out."""
        assert self._inner is not None
        self._inner.solve(b, y)

    def inspect(self, matrix: PETSc.Mat) -> None:
        """Factorise a tangent without mass, to count its negative pivots."""
        self._take(matrix)
        self.amount = 0.0
        self._factorise()

    def destroy(self, pc: PETSc.PC | None = None) -> None:
        """Free the factors."""
        if self._inner is not None:
            self._inner.destroy()
            self._diagonal.destroy()
            self._inner = self._diagonal = None

    def memory(self) -> dict[str, float]:
        """Return what the next solve inherits from those before; the same on all ranks."""
        found = {"tolerated_pivots": self.tolerated}
        return found | ({} if self._unit_value is None else {"mass_unit": self._unit_value})

    def recall(self, memory: Mapping[str, float]) -> None:
        """Take over what `memory` returned, also in an earlier run."""
        self.tolerated = int(memory["tolerated_pivots"])
        self._unit_value = memory.get("mass_unit", self._unit_value)

    def begin(self) -> None:
        """Forget the mass and the error that the solve before, perhaps one that failed, left."""
        self.amount, self.incurable, self.error = 0.0, False, 0

    # -- the rule -----------------------------------------------------------------------------

    @property
    def exists(self) -> bool:
        """Whether there is a factor to solve with."""
        return self._inner is not None and self._inner.error >= 0

    @property
    def surplus(self) -> int:
        """Negative pivots beyond those of a stable state."""
        return self.negative_pivots - self.expected_negative

    def relax(self, factor: float) -> None:
        """Divide the amount of mass after an iteration; below a thousandth of its unit: none."""
        self.amount /= factor
        if self.regularisation is not None and self.amount < 1e-3 * self._unit():
            self.amount = 0.0

    def _unit(self) -> float:
        """Return the smallest mass factor: it adds a ten-millionth of the mean stiffness."""
        if self._unit_value is None:
            mass = self.regularisation.mass
            comm = self._matrix.comm.tompi4py()
            diagonal = np.abs(self._diagonal.getArray(readonly=True))[mass > 0]
            self._unit_value = 1e-7 * comm.allreduce(diagonal.sum()) / comm.allreduce(mass.sum())
        return self._unit_value

    def _length(self, y: PETSc.Vec) -> float:
        values = np.abs(y.getArray(readonly=True)[self.regularisation.displacements])
        longest = float(values.max()) if len(values) else 0.0
        longest = longest if np.isfinite(longest) else np.inf
        return self._matrix.comm.tompi4py().allreduce(longest, op=MPI.MAX)

    def _take(self, matrix: PETSc.Mat) -> None:
        if self._diagonal is not None:
            self._diagonal.destroy()
        self._matrix, self._diagonal, self._changed = matrix, matrix.getDiagonal(), False

    def _factorise(self) -> None:
        if self._inner is None:
            self._inner = Cholesky(self._prefix)
        if self.amount > 0.0:
            diagonal = self._diagonal.copy()
            diagonal.array += self.amount * self.regularisation.mass
            self._matrix.setDiagonal(diagonal)
            self._matrix.assemble()
            diagonal.destroy()
            self._changed = True
        elif self._changed:
            self._matrix.setDiagonal(self._diagonal)
            self._matrix.assemble()
        self._inner.factorise(self._matrix)
        self.factorisations += 1
        self.error, self.negative_pivots = self._inner.error, self._inner.negative_pivots
