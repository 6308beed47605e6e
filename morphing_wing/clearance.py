"""Whether the skin passes through itself or a rib: without contact forces nothing hinders it."""

from __future__ import annotations

import numpy as np
from scipy.spatial import cKDTree

SMALLEST_GAP = 0.3
"""Pairs of points closer than this (mm) in the undeformed wing meet by design: tail, bonds."""

_NEIGHBOURS = 8


class Clearance:
    """Smallest distances between the two sides of the pocket, and between them and the ribs.

    Both sides are graphs over the (x, z) plane in the undeformed wing.

    Parameters
    ----------
    upper, lower : (n, 3) arrays
        Undeformed points on the inner sides of the upper and the lower skin, mm.
    axes : (m, 3) array
        Undeformed points on the axes of the ribs' bars, mm; may be empty.
    radius
        Half the height of a bar, mm.
    """

    def __init__(
        self, upper: np.ndarray, lower: np.ndarray, axes: np.ndarray, radius: float
    ) -> None:
        bodies = {"upper": upper, "lower": lower, "axes": axes}
        self._rings = {"upper": _rings(upper), "lower": _rings(lower)}
        self._pairs = []
        for a, b, offset in (("upper", "lower", 0.0), ("axes", "lower", radius),
                             ("axes", "upper", radius)):
            if len(bodies[a]):
                distance, _ = cKDTree(bodies[b]).query(bodies[a])
                free = np.flatnonzero(distance - offset > SMALLEST_GAP)
                self._pairs.append((a, b, offset, free))

    def smallest(self, upper: np.ndarray, lower: np.ndarray, axes: np.ndarray) -> float:
        """Return the smallest gap in mm of the deformed points; negative: they passed through.

        Parameters
        ----------
        upper, lower, axes
            Deformed points in the order of the undeformed ones.
        """
        bodies = {"upper": upper, "lower": lower, "axes": axes}
        into_pocket = {"upper": _normals(upper, self._rings["upper"]),
                       "lower": -_normals(lower, self._rings["lower"])}
        smallest = np.inf
        for a, b, offset, free in self._pairs:
            if len(free):
                points = bodies[a][free]
                _, nearest = cKDTree(bodies[b]).query(points)
                apart = points - bodies[b][nearest]
                gaps = np.sum(apart * into_pocket[b][nearest], axis=1) - offset
                smallest = min(smallest, float(gaps.min()))
        return smallest


def _rings(points: np.ndarray) -> np.ndarray:
    """Return the neighbours of each point in the order of their direction from x to z."""
    count = min(_NEIGHBOURS + 1, len(points))
    _, near = cKDTree(points).query(points, k=count)
    near = near[:, 1:]
    away = points[near] - points[:, None]
    order = np.argsort(np.arctan2(away[..., 2], away[..., 0]), axis=1)
    return np.take_along_axis(near, order, axis=1)


def _normals(points: np.ndarray, rings: np.ndarray) -> np.ndarray:
    """Return the unit area vectors of the rings; a ring from x to z looks along -y."""
    away = points[rings] - points[:, None]
    area = np.cross(away, np.roll(away, -1, axis=1)).sum(axis=1)
    return area / np.linalg.norm(area, axis=1, keepdims=True)
