"""Optimisation up a ladder of fidelities: what a rung finds, the next finer one corrects.

The formula's rung is searched as a whole. On every other rung a model of all that is known, see
`layered_model`, is searched in a box around the best design so far, and the design
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

import numpy as np

from .layered_model import LayeredModel, unknown_direction
from .problem import Problem
from .seen_designs import Found, Request, SeenDesigns

__all__ = ["climb"]

BEGIN, BEGIN_CORRECTED, DONE_AT, LARGEST, CLOSED = 0.25, 0.1, 0.1, 0.5, 0.01
"""Half widths of the box, of the variables' bounds: the first, without and with a corrected model;
where nothing gained is the end; the largest; and where the search is given up."""

TRUE = 0.7
"""Part of a promised gain that must come true for a model to be called good."""

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
        seen = SeenDesigns(problem, rung, model)
        yield from seen.ask(model.inside(problem.first), "start")
        if rung == "instant" and model.known[0]:
            found.append((yield from _by_formula(seen)))
            continue
        found.append((yield from _by_trust_region(seen, found[-1] if found else None)))
        model = seen.model


def _by_formula(seen: SeenDesigns) -> Search:
    """Search all of the formula, which costs nothing."""
    best = seen.promised(seen.below, np.full(len(seen.points[0]), 0.5), 0.5)
    yield from seen.ask(best, "candidate", float(seen.below(best[None])[0, 0]))
    return seen.found(seen.below, "the best of all between the bounds", True)


def _by_trust_region(seen: SeenDesigns, below: Found | None) -> Search:
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
        if gain < seen.problem.least_gain or seen.is_known(point):
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


def _support(seen: SeenDesigns, centre: np.ndarray, step: np.ndarray) -> np.ndarray:
    """Return the centre moved by a step, forwards or backwards: inside, and the better promise."""
    ways = np.array([np.clip(centre + step, 0.0, 1.0), np.clip(centre - step, 0.0, 1.0)])
    lengths = np.linalg.norm(ways - centre, axis=1)
    if lengths.min() < 0.5 * lengths.max():
        return ways[int(np.argmax(lengths))]
    merits = seen.merits(seen.below(ways), room=True)
    return ways[int(np.argmin(np.where(np.isfinite(merits), merits, np.inf)))]
