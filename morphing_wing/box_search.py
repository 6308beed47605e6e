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
STARTS = 6
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

    def slopes(point: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        steps = STEP * np.eye(d)
        costs, violations = pieces(np.vstack([point + steps, point - steps]))
        return (costs[:d] - costs[d:]) / (2 * STEP), (violations[:d] - violations[d:]) / (2 * STEP)

    try:
        found = minimize(
            lambda x: pieces(x[None])[0][0], start, jac=lambda x: slopes(x)[0], method="SLSQP",
            bounds=list(zip(low, high, strict=True)),
            constraints={"type": "ineq", "fun": lambda x: -pieces(x[None])[1][0],
                         "jac": lambda x: -slopes(x)[1].T},
            options={"maxiter": 200, "ftol": 1e-10})
    except ValueError:  # where the model ends
        return start
    return np.clip(found.x, low, high) if np.isfinite(found.x).all() else start
