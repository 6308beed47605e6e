"""The deflection line of an arc: what a protractor may read in place of the end's rotation."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

__all__ = ["arc_line"]


def arc_line(angle: ArrayLike) -> np.ndarray:
    """Return the deflection line in degrees of an arc that ends turned by an angle in radians.

    Half the angle where that is small: (1 - cos a) / a over the length of the arc.
    """
    angle = np.asarray(angle, dtype=float)
    small = np.abs(angle) < 1e-6
    sunk = np.where(small, 0.5 * angle, (1.0 - np.cos(angle)) / np.where(small, 1.0, angle))
    return np.degrees(np.arctan(sunk))
