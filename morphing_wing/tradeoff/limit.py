"""Where a sequence of meshes leads."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

__all__ = ["limit"]


def limit(density: Sequence[float], values: Sequence[float]) -> tuple[float, float]:
    """Return a and q of the least squares' fit of values by a - c density^-q.

    Parameters
    ----------
    density
        Elements along a length, of four meshes at least; q is sought between 0.5 and 4.
    values
        What was computed on them.
    """
    n, values = np.asarray(density, dtype=float), np.asarray(values, dtype=float)
    assert len(n) > 3, "three meshes fit any order"

    def fit(q: float) -> tuple[float, float]:
        basis = np.stack([np.ones_like(n), n**-q], axis=1)
        found, *_ = np.linalg.lstsq(basis, values, rcond=None)
        return float(np.linalg.norm(basis @ found - values)), float(found[0])

    order = min(np.linspace(0.5, 4.0, 71), key=lambda q: fit(q)[0])
    return fit(order)[1], float(order)
