"""LDL^T factors by MUMPS, with more working space where its own guess was too small."""

from __future__ import annotations

from petsc4py import PETSc

SHORT_OF_SPACE = (-8, -9, -17, -20)
"""MUMPS' errors that more working space cures: pivots put off fill more than it foresaw."""

MOST_SPACE = 1000
"""Per cent beyond MUMPS' estimate (its ICNTL(14)) that are tried before giving up."""


class Cholesky:
    """A factor LDL^T, made anew as its matrix changes. All methods are collective.

    Parameters
    ----------
    prefix
        Prefix of the PETSc options, which go before what is set here.
    space
        Working space in per cent beyond MUMPS' estimate to begin with; None: MUMPS' own choice.

    Attributes
    ----------
    error
        MUMPS' INFOG(1) of the last factor; a negative one: there is none.
    negative_pivots
        Its INFOG(12).
    """

    def __init__(self, prefix: str, space: int | None = None) -> None:
        self._prefix, self._space = prefix, space
        self._pc: PETSc.PC | None = None
        self.error = self.negative_pivots = 0

    def factorise(self, matrix: PETSc.Mat) -> None:
        """Factorise a symmetric matrix, each time of the same pattern; see ``error``."""
        self._try(matrix)
        while self.error in SHORT_OF_SPACE and self._used < MOST_SPACE:
            self._space = min(2 * max(self._used, 50), MOST_SPACE)
            self._try(matrix)
            if self._used != self._space:  # an option holds it
                break
        if self.error < 0:
            self.destroy()  # PETSc would not try again with a factor that failed

    def _try(self, matrix: PETSc.Mat) -> None:
        if self.error < 0:
            self.destroy()
        if self._pc is None:
            self._pc = self._create(matrix)
        self._pc.setOperators(matrix)
        self._pc.setUp()
        factor = self._pc.getFactorMatrix()
        self.error, self.negative_pivots = factor.getMumpsInfog(1), factor.getMumpsInfog(12)
        self._used = factor.getMumpsIcntl(14)

    def _create(self, matrix: PETSc.Mat) -> PETSc.PC:
        pc = PETSc.PC().create(matrix.comm)
        pc.setOptionsPrefix(self._prefix)
        pc.setType("cholesky")
        pc.setFactorSolverType("mumps")
        pc.setOperators(matrix)
        pc.setFactorSetUpSolverType()
        factor = pc.getFactorMatrix()
        factor.setOptionsPrefix(self._prefix)
        factor.setMumpsIcntl(13, 1)  # a ScaLAPACK root would hide its pivots from the count
        if self._space is not None:
            factor.setMumpsIcntl(14, self._space)
        pc.setFromOptions()
        return pc

    @property
    def matrix(self) -> PETSc.Mat:
        """PETSc's matrix of the factor."""
        assert self._pc is not None
        return self._pc.getFactorMatrix()

    def solve(self, b: PETSc.Vec, y: PETSc.Vec) -> None:
        """Solve with the last factor; without one, ``y`` becomes NaN."""
        if self._pc is None:
            y.set(float("nan"))
        else:
            self._pc.apply(b, y)

    def destroy(self) -> None:
        """Free the factor."""
        if self._pc is not None:
            self._pc.destroy()
            self._pc = None
