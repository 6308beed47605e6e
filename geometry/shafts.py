"""How near the neighbouring shafts of a rib's layers are to each other, wherever they have moved.

The two shafts are not joined: bent far enough they meet, a boss of the one and the flank of the
other. Shafts are taken for straight between their joints, as they nearly are.
"""

from __future__ import annotations

import numpy as np

from .rib import RibGeometry


def shaft_joints(rib: RibGeometry, layers: tuple[int, ...]) -> np.ndarray:
    """Return start, crossing and end of each shaft, shape (layers, n_cells, 3, 3), in mm."""
    return np.array([[[rib.joint(*key, layer) for key in (start, ("C", i), end)]
                      for i in range(1, rib.n_cells + 1)
                      for start, end in [rib.bar_ends(layer, i)]] for layer in layers])


def smallest_gap(rib: RibGeometry, joints: np.ndarray) -> float:
    """Return the smallest gap in mm between neighbouring shafts, below zero where they meet.

    Parameters
    ----------
    rib
        Its widths: a shaft is as wide as the cylinder at joints where that runs through it.
    joints : (layers, n_cells, 3, 3) array
        Deformed positions of what `shaft_joints` returns. Infinite for a rib of one cell.
    """
    half = 0.5 * rib.shaft_width
    boss = max(half, 0.5 * rib.pivot_diameter) if rib.runs_through else half
    first, second = joints[:, :-1], joints[:, 1:]
    found = [np.inf]
    for points, shafts in ((first, second), (second, first)):
        for part in (0, 1):
            a, b = shafts[:, :, part, None], shafts[:, :, part + 1, None]
            along = b - a
            t = ((points - a) * along).sum(axis=-1) / (along**2).sum(axis=-1)
            nearest = a + np.clip(t, 0.0, 1.0)[..., None] * along
            apart = np.linalg.norm(points - nearest, axis=-1)
            found.append(float(apart.min(initial=np.inf)) - boss - half)
    return min(found)
