"""The best point of a cheap model in a box: a dense sample, then SQP from its best points."""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np
from scipy.optimize import minimize
from scipy.stats import qmc

__all__ = ["Pieces", "best_in_box"]

Pieces = Callable[[np.ndarray], tuple[np.ndarray, np.ndarray]]
"""Points (n, d) -> costs (n,), and violations (n, constraints): at most 0 where they hold."""

SAMPLES = 4096
STARTS = 4
STEP = 1e-6
HOLDS = 1e-8


def best_in_box(
    pieces: Pieces, low: np.ndarray, high: np.ndarray, starts: Sequence[np.ndarray] = (),
    samples: int = SAMPLES,
) -> np.ndarray:
    """Return the point of least cost that holds all constraints; if none does, the nearest to it.

    Parameters
    ----------
    pieces
        The model, cheap and vectorised. Not a number where there is nothing.
    low, high
        The box, shape (d,).
    starts
        Points to begin from beside those of the sample; they are moved into the box.
    samples
        Points of the Sobol' sequence to look at, a power of 2.
    """
    sobol = qmc.Sobol(len(low), seed=0).random(samples)
    points = np.vstack([low + sobol * (high - low),
                        *(np.clip(start, low, high)[None] for start in starts)])
    order = np.lexsort(_ranked(pieces, points))
    chosen = [points[-1 - i] for i in range(len(starts))]
    for point in points[order]:
        if len(chosen) == STARTS + len(starts):
            break
        if all(np.abs(point - other).max() > 0.1 * (high - low).max() for other in chosen):
            chosen.append(point)
    found = np.array([*chosen, points[order[0]],
                      *(_climbed(pieces, point, low, high) for point in chosen)])
    return found[np.lexsort(_ranked(pieces, found))[0]]


def _ranked(pieces: Pieces, points: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return the keys by which points are sorted: violation first, then cost."""
    costs, violations = pieces(points)
    over = violations.max(axis=1, initial=0.0)
    over = np.where(over <= HOLDS, 0.0, over)
    lost = ~(np.isfinite(costs) & np.isfinite(over))
    return np.where(lost, np.inf, costs), np.where(lost, np.inf, over)


def _climbed(pieces: Pieces, start: np.ndarray, low: np.ndarray, high: np.ndarray) -> np.ndarray:
    """Return where SLSQP ends; slopes by central differences, of all points in one call."""
    d = len(start)
    steps = STEP * np.vstack([np.zeros(d), np.eye(d), -np.eye(d)])
    last: dict[str, np.ndarray] = {}

    def at(x: np.ndarray) -> dict[str, np.ndarray]:
        # SLSQP asks for cost, limits and the slopes of both one after the other.
        if "x" not in last or not np.array_equal(x, last["x"]):
            costs, over = pieces(x + steps)
            last.update(
                x=x.copy(), cost=costs[0], over=over[0],
                cost_slope=(costs[1 : d + 1] - costs[d + 1 :]) / (2 * STEP),
                over_slope=(over[1 : d + 1] - over[d + 1 :]) / (2 * STEP))
        return last

    try:
        found = minimize(
            lambda x: at(x)["cost"], start, jac=lambda x: at(x)["cost_slope"], method="SLSQP",
            bounds=list(zip(low, high, strict=True)),
            constraints={"type": "ineq", "fun": lambda x: -at(x)["over"],
                         "jac": lambda x: -at(x)["over_slope"].T},
            options={"maxiter": 100, "ftol": 1e-10})
    except ValueError:  # where the model ends
        return start
    return np.clip(found.x, low, high) if np.isfinite(found.x).all() else start
