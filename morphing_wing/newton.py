"""Newton's method by PETSc SNES on an equilibrium system."""

from __future__ import annotations

import weakref
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from petsc4py import PETSc

from . import blas
from .burial import bury, register
from .inertia import InertiaCholesky, Regularisation
from .system import EquilibriumSystem

# PETSc 3.25 renamed it.
_NOT_A_NUMBER = getattr(PETSc.SNES.ConvergedReason, "DIVERGED_FNORM_NAN", None) or (
    PETSc.SNES.ConvergedReason.DIVERGED_FUNCTION_NANORINF
)
REASONS = {
    PETSc.SNES.ConvergedReason.DIVERGED_FUNCTION_DOMAIN: "an element turned inside out (J <= 0)",
    _NOT_A_NUMBER: "an element turned inside out (J <= 0)",
    PETSc.SNES.ConvergedReason.DIVERGED_LINEAR_SOLVE: "the tangent could not be factorised",
    PETSc.SNES.ConvergedReason.DIVERGED_MAX_IT: "Newton used up its iterations",
    PETSc.SNES.ConvergedReason.DIVERGED_DTOL: "the residual grew without bound",
    PETSc.SNES.ConvergedReason.DIVERGED_LINE_SEARCH: "the line search failed",
}


SMALLEST_FORCE = 1e-13
"""Residual in N below which a state is at rest whatever the loads: rounding."""


@dataclass(frozen=True)
class NewtonResult:
    """What one solve did.

    Attributes
    ----------
    converged
        Whether the residual fell below its tolerance, or the last step to rounding: below 1e-8
        of the unknowns' norm, with 1e-10 left by its ratio to the step before.
    reason
        In words why it stopped.
    iterations
        Number of Newton iterations.
    residual
        Norm of the last residual in N.
    negative_pivots
        Negative pivots of the last factor beyond those of the pressure unknowns.
    """

    converged: bool
    reason: str
    iterations: int
    residual: float
    negative_pivots: int


class Newton:
    """SNES on one reused matrix with MUMPS LDL^T; every option is open under ``prefix``.

    A solve from a state that the last one found begins with that one's factor: it costs nothing,
    and the tangent of that state under the new load is near to singular for some loads. Not so
    where mass or the way to touching limits steps: which way a skin buckles depends on the first.

    Parameters
    ----------
    system
        The equations.
    prefix
        PETSc options prefix, e.g. ``"wing_"``; the factorisation's is ``"wing_factor_"``.
    regularisation, expected_negative
        See `InertiaCholesky`.
    max_iterations
        Newton iterations after which a load step is given up.
    relative_tolerance
        Largest residual of a solution, relative to the force that `solve` is given; where rounding
        of stiff parts is larger, the last step decides, see `NewtonResult`.
    before_tangent
        Called before each tangent with the number of the iteration in the solve.
    admissible
        Called with the unknowns x and a step, which leads to x - step: returns which part of it to
        take.

    Attributes
    ----------
    reuses
        Whether a solve begins with the factor of the state before.
    """

    def __init__(
        self,
        system: EquilibriumSystem,
        prefix: str,
        regularisation: Regularisation | None = None,
        expected_negative: int = 0,
        max_iterations: int = 25,
        relative_tolerance: float = 1e-9,
        before_tangent: Callable[[int], None] | None = None,
        admissible: Callable[[PETSc.Vec, PETSc.Vec], float] | None = None,
    ) -> None:
        blas.check()
        self.system, self.prefix = system, prefix
        self.relative_tolerance = relative_tolerance
        # A strong reference to a method of the scene that owns this solver would be a cycle.
        self._before_tangent = before_tangent and weakref.WeakMethod(before_tangent)
        self._admissible = admissible and weakref.WeakMethod(admissible)
        self._tolerance = 0.0
        self.reuses = regularisation is None and admissible is None
        self._near = False  # whether the factor is, or nearly is, of the state `_found`
        self._b = system.x.duplicate()
        self._x = system.x.duplicate()
        self._found = system.x.duplicate()
        self.factor = InertiaCholesky(regularisation, expected_negative, prefix + "factor_")
        if admissible is not None:
            me = weakref.proxy(self)
            self.factor.part = lambda step: me._admissible()(me._snes.getSolution(), step)
        self._snes = self._create(prefix, max_iterations)
        register(self, system.comm, self.factor, self._snes)

    def _create(self, prefix: str, max_iterations: int) -> PETSc.SNES:
        snes = PETSc.SNES().create(self.system.comm)
        snes.setOptionsPrefix(prefix)
        snes.setType("newtonls")
        # Others stall on displacement forms and cost four times the iterations on mixed ones.
        options, line_search = PETSc.Options(prefix), "snes_linesearch_type"
        if not options.hasName(line_search):
            options.setValue(line_search, "basic")
        # PETSc's references to callbacks are invisible to Python's collector: keep them weak.
        me = weakref.proxy(self)
        snes.setFunction(lambda *a: me._function(*a), self._b)
        snes.setJacobian(lambda *a: me._jacobian(*a), self.system.matrix)
        # With a step tolerance PETSc may take a line search that met NaN for convergence.
        snes.setTolerances(stol=0.0, max_it=max_iterations)
        snes.setConvergenceTest(lambda *a: me._test(*a))
        ksp = snes.getKSP()
        ksp.setType("preonly")
        ksp.getPC().setType("python")
        ksp.getPC().setPythonContext(self.factor)
        snes.setFromOptions()
        return snes

    def solve(self, reference_force: float) -> NewtonResult:
        """Solve from the functions' present values; on failure they hold the last iterate.

        Parameters
        ----------
        reference_force
            Norm in N of the loads; the tolerance is relative to it.
        """
        bury(self.system.comm)
        self._tolerance = max(self.relative_tolerance * reference_force, SMALLEST_FORCE)
        self._smallest = self._step = np.inf
        self._taken = 0.0  # length of the last step
        self._fresh = False  # whether a tangent was assembled in this solve
        self.factor.begin()
        self.system.push(self._x)
        # Not where held unknowns have moved: that state is far from the one that was found.
        self._near = self._near and self._x.equal(self._found)
        self._snes.solve(None, self._x)
        self.system.pull(self._x)
        reason = self._snes.getConvergedReason()
        iterations = self._snes.getIterationNumber()
        # The factor is of the iterate before the last step: of another state where that was long.
        short = self._taken <= 0.01 * (self._x.norm() + 1.0)
        self._near = self.reuses and reason > 0 and short
        self._x.copy(self._found)
        if reason > 0 and (self.factor.amount > 0.0 or not self._fresh):
            # The last factor was of K + a M, which hides what K itself says of stability; or it is
            # of another state, perhaps one of a solve that failed.
            self._assemble(iterations)
            self.factor.inspect(self.system.matrix)
            if self.factor.error < 0:
                reason = PETSc.SNES.ConvergedReason.DIVERGED_LINEAR_SOLVE
        if reason > 0:
            self.factor.tolerated = max(self.factor.surplus, 0)
        return NewtonResult(
            converged=reason > 0,
            reason=self._words(reason),
            iterations=iterations,
            residual=self._snes.getFunctionNorm(),
            negative_pivots=self.factor.surplus,
        )

    def renew(self) -> None:
        """Take the system's new matrix, whose pattern may be another."""
        self.factor.destroy()
        me = weakref.proxy(self)
        self._snes.setJacobian(lambda *a: me._jacobian(*a), self.system.matrix)

    def linearise(self) -> InertiaCholesky:
        """Return the factor of the tangent at the functions' values, a converged state. Collective.

        Without mass, and of the state itself, where the last factor of `solve` is that of the
        iterate before: the derivative of the residual, but for the motion of contact places.
        """
        self._assemble(0)
        self.factor.inspect(self.system.matrix)
        self._near = self.reuses and self.factor.error >= 0
        self.system.push(self._found)
        return self.factor

    def _words(self, reason: int) -> str:
        if reason > 0:
            return "converged"
        if self.factor.error < 0:  # else it would pass for the NaN that PETSc makes of it
            return f"the tangent could not be factorised (MUMPS error {self.factor.error})"
        if self.factor.incurable:
            return "the way is unstable, and mass on the thin part does not help"
        return REASONS.get(reason, f"SNES reason {reason}")

    # -- called by PETSc ----------------------------------------------------------------------

    def _function(self, snes: PETSc.SNES, x: PETSc.Vec, out: PETSc.Vec) -> None:
        self.system.residual(x, out)

    def _jacobian(self, snes: PETSc.SNES, x: PETSc.Vec, A: PETSc.Mat, P: PETSc.Mat) -> None:
        self.system.pull(x)
        iteration = snes.getIterationNumber()
        self.factor.stale = not (self._near and iteration == 0 and self.factor.exists)
        if self.factor.stale:
            self._fresh = True
            self._assemble(iteration)
        else:
            self._announce(iteration)

    def _assemble(self, iteration: int) -> None:
        self._announce(iteration)
        self.system.tangent()

    def _announce(self, iteration: int) -> None:
        if self._before_tangent is not None:
            self._before_tangent()(iteration)

    def _test(self, snes: PETSc.SNES, iteration: int, norms: tuple[float, float, float]) -> int:
        reason = PETSc.SNES.ConvergedReason
        x_norm, step, residual = norms
        self._taken = step if iteration > 0 else 0.0
        if not np.isfinite(residual):
            return _NOT_A_NUMBER
        if residual <= self._tolerance:
            return reason.CONVERGED_FNORM_ABS
        if self.factor.incurable or self.factor.error < 0:
            return reason.DIVERGED_LINEAR_SOLVE
        if iteration > 0:
            unregularised = self.factor.amount == 0.0
            # Roundoff of stiff parts bounds the residual from below; then the step is what counts,
            # and what its ratio to the last one leaves: where contact moves that is no square.
            last, self._step = self._step, step
            size = x_norm + 1.0
            ratio = min(step / last, 1.0) if 0.0 < last < np.inf else 1.0
            known = last <= 1e-8 * size or step * ratio <= 1e-10 * size
            if unregularised and step <= 1e-8 * size and known:
                return reason.CONVERGED_SNORM_RELATIVE
            self.factor.relax(1e3 if residual < 0.1 * self._smallest else 10.0)
        self._smallest = min(self._smallest, residual)
        return reason.ITERATING
