"""Where a function that rises from zero first takes a value: Newton's method on many at once."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

__all__ = ["first_crossing", "first_peak"]

Curve = Callable[[np.ndarray], tuple[np.ndarray, np.ndarray]]
"""Places -> values and slopes, each of shape (n,)."""

ACCURATE = 1e-9
"""Relative step after which Newton's method, which squares its errors, has nothing to gain."""

MOST = 100


def first_crossing(
    curve: Curve, target: np.ndarray, last: np.ndarray, concave: np.ndarray
) -> np.ndarray:
    """Return where each curve first takes its target, nan where it does not.

    Newton's method from zero, kept in a bracket. On concave curves it comes from below in steps
    that never pass the crossing, so that a slope of zero or a step past the end says that there is
    none; all others must rise up to their end.

    Parameters
    ----------
    curve
        Of n functions, each 0 at 0.
    target
        Shape (n,); nan where it is negative.
    last
        End of each curve, shape (n,).
    concave
        Whether each curve is concave, shape (n,); the others must not fall before their end.
    """
    lost = ~(target >= 0.0)
    if not concave.all():
        lost |= ~concave & (curve(last)[0] < target)
    found = np.zeros(target.shape, dtype=bool)
    place, low, high = np.zeros_like(target), np.zeros_like(target), np.array(last, dtype=float)
    with np.errstate(divide="ignore", invalid="ignore", over="ignore"):
        for _ in range(MOST):
            value, slope = curve(place)
            below = value < target
            low, high = np.where(below, place, low), np.where(below, high, place)
            new = place - (value - target) / slope
            # What has been found stays there: rounding would lead it out of its bracket.
            outside = ~found & ~((new >= low) & (new <= high))
            lost |= ~found & ((concave & outside) | (below & (slope <= 0.0)))
            new = np.where(outside, 0.5 * (low + high), new)
            close = np.abs(new - place) <= ACCURATE * new
            place = np.where(found, place, new)
            found |= close
            if (lost | found).all():
                break
    return np.where(lost, np.nan, place)


def first_peak(curve: Curve, last: float, concave: np.ndarray) -> np.ndarray:
    """Return where each curve first ceases to rise, the end where it does not.

    Parameters
    ----------
    curve
        Of n functions.
    last
        Their common end.
    concave
        Whether each curve is concave, shape (n,); of the others the slope is looked at in 500
        places, so that a fall of less than that width may be missed.
    """
    low = np.zeros(len(concave))
    high = np.full(len(concave), float(last))
    if not concave.all():
        rising = ~concave
        for place in np.linspace(0.0, last, 501)[1:]:
            falls = curve(np.full(len(concave), place))[1] <= 0.0
            high = np.where(rising & falls, place, high)
            rising &= ~falls
            low = np.where(rising, place, low)
            if not rising.any():
                break
    rises = curve(high)[1] > 0.0
    for _ in range(60):
        middle = 0.5 * (low + high)
        up = curve(middle)[1] > 0.0
        low, high = np.where(up, middle, low), np.where(up, high, middle)
    return np.where(rises, last, low)
