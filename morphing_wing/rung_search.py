"""Optimisation up a ladder of fidelities: what a rung finds, the next finer one corrects.

The formula's rung is searched as a whole. On every other rung a model of all that is known, see
`morphing_wing.layered_model`, is searched in a box around the best design so far, and the design
that it promises is computed. Where the promise was good the box grows, where it was bad it shrinks
(a trust region; with radial basis functions as an error model after March and Willcox 2012). Before
a formula is trusted, points near the best design must span all directions; the slopes of a rung
that was searched so are trusted on the next one until a promise fails there. A rung is done when
the model, corrected there, promises nothing more.

The searches are generators that ask for designs and are sent outputs, so that they know nothing of
solvers, files and processes.
"""

from __future__ import annotations

from collections.abc import Generator
from dataclasses import dataclass, field
from functools import cached_property

import numpy as np

from morphing_wing.box_search import best_in_box
from morphing_wing.errors import InputError
from morphing_wing.layered_model import LayeredModel, unknown_direction
from morphing_wing.prices import prices
from morphing_wing.problem import HOLDS, Constraint, Problem

__all__ = ["Found", "Request", "climb"]

BEGIN, BEGIN_CORRECTED, DONE_AT, LARGEST, CLOSED = 0.25, 0.1, 0.1, 0.5, 0.01
"""Half widths of the box, of the variables' bounds: the first, with and without a corrected model;
where nothing gained is the end; the largest; and where the search is given up."""

EXACT = {"mass_g", "length_mm", "height_mm", "width_mm", "depth_mm"}
ROOM, EXACT_ROOM = 1e-3, 2e-5
"""Parts of a limit that models keep away from it: what is computed then holds it, though models err
and values are rounded."""

TRUE = 0.7
"""Part of a promised gain that must come true for a model to be called good."""

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
        See `morphing_wing.prices.prices`; empty where the goal is to match.
    residual
        Part of the goal's slope that active limits do not hold: next to 0 at an optimum.
    """

    rung: str
    values: np.ndarray
    reason: str
    settled: bool
    prices: dict[str, float]
    residual: float


Search = Generator[Request, "np.ndarray | None", Found]


def climb(
    problem: Problem, found: list[Found]
) -> Generator[Request, np.ndarray | None, None]:
    """Search rung after rung: yield designs, be sent their outputs, or None where there are none.

    Parameters
    ----------
    problem
        What is sought.
    found
        Each rung's find is appended as soon as it is searched.

    Raises
    ------
    InputError
        If the starting design cannot be computed on a rung.
    """
    model = LayeredModel(problem)
    for rung in problem.rungs:
        seen = _Seen(problem, rung, model)
        yield from seen.ask(model.inside(problem.first), "start")
        if rung == "instant" and model.known[0]:
            found.append((yield from _by_formula(seen)))
            continue
        found.append((yield from _by_trust_region(seen, found[-1] if found else None)))
        model = seen.model


@dataclass
class _Seen:
    """Designs that were computed on a rung, as points of the unit cube."""

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
        return self.problem.told(self.rung)

    @property
    def model(self) -> LayeredModel:
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
        return bool((np.abs(np.array(self.points) - point).max(axis=1) < NEAR).any())


def _by_formula(seen: _Seen) -> Search:
    """Search all of the formula, which costs nothing."""
    best = seen.promised(seen.below, np.full(len(seen.points[0]), 0.5), 0.5)
    yield from seen.ask(best, "candidate", float(seen.below(best[None])[0, 0]))
    return seen.found(seen.below, "the best of all between the bounds", True)


def _by_trust_region(seen: _Seen, below: Found | None) -> Search:
    """Search a corrected model in a box that moves with the best design."""
    if below is not None and not seen.is_known(seen.below.inside(below.values)):
        yield from seen.ask(seen.below.inside(below.values), "optimum below")
    corrected = below is not None and below.rung != "instant"
    trusted = corrected and not seen.problem.own_slopes
    radius = BEGIN_CORRECTED if corrected else BEGIN
    failed: list[np.ndarray] = []
    while seen.asked < seen.problem.evaluations:
        place = seen.best()
        centre = seen.points[place]
        direction = None if trusted else unknown_direction(
            np.array([*seen.points, *failed]), centre, radius)
        if direction is not None:
            support = _support(seen, centre, radius * direction)
            if not (yield from seen.ask(support, "support")):
                failed.append(seen.below.inside(seen.below.values(support)))
            continue
        model = seen.model
        point = seen.promised(model, centre, radius)
        now = seen.merits(seen.outputs[place][None])[0]
        promise = model(point[None])
        gain = now - seen.merits(promise)[0]
        if gain < seen.problem.tolerance or seen.is_known(point):
            if radius <= DONE_AT:
                slopes = f", by the slopes of {below.rung!r}" if trusted else ""
                return seen.found(
                    model, f"within {100 * radius:.0f} % of the bounds around it nothing promises "
                    f"{100 * seen.problem.tolerance:g} % more{slopes}",
                    bool(np.isfinite(gain)))
            radius = max(0.5 * radius, DONE_AT)
            continue
        if (yield from seen.ask(point, "candidate", float(promise[0, 0]))):
            kept = (now - seen.merits(seen.outputs[-1][None])[0]) / gain
        else:
            kept = -1.0
            failed.append(point)
        trusted = trusted and kept > TRUE
        far = np.abs(point - centre).max() > 0.9 * radius
        if kept > TRUE and far:
            radius = min(2.0 * radius, LARGEST)
        elif kept < 0.1:
            radius *= 0.5
        if radius < CLOSED:
            return seen.found(model, "what the model promises does not come true nearby", False)
    return seen.found(seen.model, f"{seen.asked} evaluations were made", False)


def _support(seen: _Seen, centre: np.ndarray, step: np.ndarray) -> np.ndarray:
    """Return the centre moved by a step, forwards or backwards: inside, and the better promise."""
    ways = np.array([np.clip(centre + step, 0.0, 1.0), np.clip(centre - step, 0.0, 1.0)])
    lengths = np.linalg.norm(ways - centre, axis=1)
    if lengths.min() < 0.5 * lengths.max():
        return ways[int(np.argmax(lengths))]
    merits = seen.merits(seen.below(ways), room=True)
    return ways[int(np.argmin(np.where(np.isfinite(merits), merits, np.inf)))]
