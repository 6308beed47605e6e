"""Work that loads do along a path of equilibria, from what is known at its states alone."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

__all__ = ["ExternalWork"]


class ExternalWork:
    r"""Sum of the loads' work over load steps, to fourth order in the steps.

    With loads :math:`\lambda` that go straight from one state to the next, their displacements
    :math:`q` and compliance :math:`C = \partial q/\partial\lambda`, the work of a step is

    .. math:: W = \int \lambda \cdot dq = \bar\lambda \cdot \Delta q
        - \tfrac{1}{12} \, \Delta\lambda \cdot (C_0 - C_1) \, \Delta\lambda,

    the integral of the cubic through :math:`f = \Delta\lambda \cdot q` and its slopes
    :math:`\Delta\lambda \cdot C \Delta\lambda` at both ends. A stable structure yields to its
    loads, so that f rises: slopes are kept between 0 and 3 :math:`\Delta f`, within which the cubic
    is monotone (Fritsch and Carlson 1980, SIAM J. Numer. Anal. 17, 238). Near a limit point, where
    the compliance has no bound, this is what keeps the sum sound.

    Parameters
    ----------
    led
        Whether volumes are given and pressures are unknowns: :math:`\lambda` are the volumes then,
        q minus the pressures, and the work is :math:`-\int q \cdot d\lambda`; a pressure may fall.

    Attributes
    ----------
    amount
        Work so far, N mm.
    """

    def __init__(self, led: bool = False) -> None:
        self.amount = 0.0
        self._led = led
        self._load: dict[str, float] = {}
        self._displacement: dict[str, float] = {}
        self._compliance: np.ndarray | None = None
        self._first: np.ndarray | None = None

    def stand(self, load: Mapping[str, float], displacement: Mapping[str, float]) -> None:
        """Go on from a state without work on the way to it; its compliance is not known yet.

        Parameters
        ----------
        load, displacement
            Of each load in use its value and the displacement on which it works.
        """
        if list(displacement) != self.names:
            self._first = None
        self._displacement = dict(displacement)
        self._load = {name: load[name] for name in displacement}
        self._compliance = None

    @property
    def names(self) -> list[str]:
        """Names of the loads that do work."""
        return list(self._displacement)

    @property
    def knows_compliance(self) -> bool:
        """Whether the compliance where it stands is known."""
        return self._compliance is not None

    def learn(self, compliance: np.ndarray) -> None:
        """Take over the compliance where it stands, see `add`."""
        if self._first is None:
            self._first = compliance
        self._compliance = compliance

    def stiffness_left(self, names: Sequence[str]) -> float:
        r"""Return how stiff it is against some of its loads, over how stiff it was at first.

        The least :math:`x \cdot C^{-1} x \,/\, x \cdot C_0^{-1} x` over all x, with the compliances
        now and where the first step began: 0 at a limit point of these loads. Not a number where
        one is not known.
        """
        if self._first is None or self._compliance is None:
            return float("nan")
        chosen = np.ix_(*2 * ([self.names.index(name) for name in names],))
        first, now = self._first[chosen], self._compliance[chosen]
        if not (np.isfinite(first).all() and np.isfinite(now).all()):
            return float("nan")
        return 1.0 / float(np.linalg.eigvals(np.linalg.solve(first, now)).real.max())

    def add(
        self, load: Mapping[str, float], displacement: Mapping[str, float], compliance: np.ndarray
    ) -> None:
        """Add the work of a step.

        Parameters
        ----------
        load, displacement
            See `stand`; the same names as there.
        compliance : (n, n) array
            Derivative of each displacement by each load at the end of the step, in the order of
            `names`; not finite where it is not known.
        """
        change = np.array([load[name] - self._load[name] for name in self.names])
        mean = np.array([0.5 * (load[name] + self._load[name]) for name in self.names])
        moved = np.array([displacement[name] - self._displacement[name] for name in self.names])
        trapezium = mean @ moved
        if self._led:
            trapezium -= sum(load[n] * displacement[n] - self._load[n] * self._displacement[n]
                             for n in self.names)
        self.amount += float(trapezium) - self._curvature(change, moved, compliance)
        self.stand(load, displacement)
        self.learn(compliance)

    def _curvature(self, change: np.ndarray, moved: np.ndarray, compliance: np.ndarray) -> float:
        """Return what the cubic's integral has beyond the trapezium's."""
        steepest = 3.0 * max(float(change @ moved), 0.0)
        slopes = [float(change @ c @ change) for c in (self._compliance, compliance)]
        if not np.isfinite(slopes).all():
            return 0.0
        before, after = slopes if self._led else np.clip(slopes, 0.0, steepest)
        return (before - after) / 12.0

    # -- for restarts -------------------------------------------------------------------------

    def memory(self) -> dict[str, Any]:
        """Return what the next step needs."""
        return {"amount_Nmm": self.amount, "names": self.names,
                "compliance": self._compliance.tolist()}

    def recall(self, memory: Mapping[str, Any]) -> None:
        """Take over what `memory` returned, standing where it did."""
        self.amount = memory["amount_Nmm"]
        if memory["names"] == self.names:
            self._compliance = np.array(memory["compliance"])
