"""The designs that were computed on a rung, what they are worth, and what a model promises."""

from __future__ import annotations

from collections.abc import Generator
from dataclasses import dataclass, field
from functools import cached_property

import numpy as np

from morphing_wing.errors import InputError

from .box_search import best_in_box
from .layered_model import LayeredModel
from .prices import prices
from .problem import HOLDS, Constraint, Problem

__all__ = ["Found", "Request", "SeenDesigns"]

EXACT = {"mass_g", "length_mm", "height_mm", "width_mm", "depth_mm"}
ROOM, EXACT_ROOM = 1e-3, 2e-5
"""Parts of a limit that models keep away from it: what is computed then holds it, though models err
and values are rounded."""

NEAR = 1e-3
"""Points nearer than that to a known one, of the variables' bounds, tell nothing new."""


@dataclass(frozen=True)
class Request:
    """A design to compute.

    Attributes
    ----------
    rung
        Fidelity.
    values
        Of the variables.
    role
        "start", "optimum below" (of the rung before), "support" (for the model), "candidate".
    predicted
        What the model promises of the goal's output; None where there is no model.
    """

    rung: str
    values: np.ndarray
    role: str
    predicted: float | None = None


@dataclass(frozen=True)
class Found:
    """What the search of a rung has found.

    Attributes
    ----------
    rung
        Its fidelity.
    values
        Of the variables: the best design that was computed there.
    reason
        Why the search ended.
    settled
        Whether it ended because there was nothing more to gain.
    prices
        See `morphing_wing.optimization.prices.prices`; empty where the goal is to match.
    residual
        Part of the goal's slope that active limits do not hold: next to 0 at an optimum.
    """

    rung: str
    values: np.ndarray
    reason: str
    settled: bool
    prices: dict[str, float]
    residual: float


@dataclass
class SeenDesigns:
    """Designs that were computed on a rung, as points of the unit cube.

    Parameters
    ----------
    problem, rung
        What is sought, and the rung.
    below
        The model of the rungs before.
    """

    problem: Problem
    rung: str
    below: LayeredModel
    points: list[np.ndarray] = field(default_factory=list)
    outputs: list[np.ndarray] = field(default_factory=list)
    limits: dict[Constraint, float] = field(default_factory=dict)
    scale: float = 1.0
    asked: int = 0

    def ask(
        self, point: np.ndarray, role: str, predicted: float | None = None
    ) -> Generator[Request, np.ndarray | None, bool]:
        """Have a design computed, and return whether there is anything known of it."""
        values = self.below.values(np.clip(point, 0.0, 1.0))
        outputs = yield Request(self.rung, values, role, predicted)
        self.asked += 1
        told = [name in self.told for name in self.problem.outputs]
        if outputs is None or not np.isfinite(outputs[told]).all():
            if role == "start":
                raise InputError(f"base: must be a design that can be computed on the rung "
                                 f"{self.rung!r}")
            return False
        self.points.append(self.below.inside(values))
        self.outputs.append(np.asarray(outputs, dtype=float))
        if role == "start":
            self._measure()
        return True

    def _measure(self) -> None:
        start, goal = self.outputs[0], self.problem.goal
        self.limits = self.problem.limits(
            self.rung, dict(zip(self.problem.outputs, start.tolist(), strict=True)))
        self.scale = abs(start[0] if goal.target is None else goal.target) or 1.0

    @cached_property
    def told(self) -> tuple[str, ...]:
        """Outputs that the rung tells."""
        return self.problem.told(self.rung)

    @property
    def model(self) -> LayeredModel:
        """The model of the rungs before, corrected by what this one has told."""
        return self.below.with_layer(np.array(self.points), np.array(self.outputs))

    def judged(self, outputs: np.ndarray, room: bool = False) -> tuple[np.ndarray, np.ndarray]:
        """Return costs (n,) and violations (n, constraints), with some room to the limits."""
        problem = self.problem
        columns = []
        for c, limit in self.limits.items():
            exact = c.output in EXACT or self.rung == "instant"
            kept = (EXACT_ROOM if exact else ROOM) if room else -HOLDS
            columns.append(c.violation(outputs[:, problem.outputs.index(c.output)], limit) + kept)
        violations = np.stack(columns, axis=1) if columns else np.zeros((len(outputs), 0))
        return problem.goal.cost(outputs[:, 0], self.scale), violations

    def merits(self, outputs: np.ndarray, room: bool = False) -> np.ndarray:
        """Return costs with a penalty: what a trust region compares."""
        costs, violations = self.judged(outputs, room)
        return costs + 10.0 * violations.max(axis=1, initial=0.0)

    def best(self) -> int:
        """Return the place of the best design: one that holds all, else that passes least."""
        costs, violations = self.judged(np.array(self.outputs))
        return int(np.lexsort((costs, violations.max(axis=1, initial=0.0)))[0])

    def found(self, model: LayeredModel, reason: str, settled: bool) -> Found:
        """Return the best design, and by a model what each of its limits costs."""
        point, limits = self.points[self.best()], self.limits
        if self.problem.goal.kind == "match":
            worth, residual = {}, 0.0
        else:
            worth, residual = prices(
                self.problem, limits, self.scale, point, lambda x: self.judged(model(x)))
        return Found(self.rung, self.below.values(point), reason, settled, worth, residual)

    def promised(self, model: LayeredModel, centre: np.ndarray, radius: float) -> np.ndarray:
        """Return the model's best design in a box."""
        known = np.array([model.known[self.problem.outputs.index(c.output)] for c in self.limits],
                         dtype=bool)

        def pieces(points: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
            costs, violations = self.judged(model(points), room=True)
            return costs, np.where(known, violations, -1.0)

        return best_in_box(pieces, np.clip(centre - radius, 0.0, 1.0),
                           np.clip(centre + radius, 0.0, 1.0), [centre])

    def is_known(self, point: np.ndarray) -> bool:
        """Whether a design next to a point was computed."""
        return bool((np.abs(np.array(self.points) - point).max(axis=1) < NEAR).any())
