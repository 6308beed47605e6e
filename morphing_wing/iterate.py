"""What the tangent must remember of earlier iterates of a function."""

from __future__ import annotations

from dolfinx import fem


class Iterate:
    """The iterate before the present one, for mixed-point tangents.

    Attributes
    ----------
    last
        Function of the iterate whose stress the tangent starts from.
    step
        Function of the change from ``last`` to the present iterate; zero to keep that stress.
    """

    def __init__(self, function: fem.Function) -> None:
        self._function = function
        self.last = fem.Function(function.function_space)
        self.step = fem.Function(function.function_space)
        self._converged = function.x.array.copy()
        self._present = self._converged

    def before_tangent(self, iteration: int) -> None:
        """Call before each assembly; the first one of a solve keeps the converged stress."""
        present = self._function.x.array.copy()
        first = iteration == 0
        self.last.x.array[:] = self._converged if first else self._present
        self.step.x.array[:] = 0.0 if first else present - self._present
        self._present = present

    def accept(self) -> None:
        """Take the present values as converged."""
        self._converged = self._function.x.array.copy()
