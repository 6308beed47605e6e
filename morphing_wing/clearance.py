"""Whether the skin passes through itself or a rib: without contact forces nothing hinders it."""

from __future__ import annotations

import numpy as np
from scipy.spatial import Delaunay, cKDTree

SMALLEST_GAP = 0.3
"""Pairs of points closer than this (mm) in the undeformed wing meet by design: tail, bonds."""


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
        self._triangles = {"upper": _triangles(upper), "lower": _triangles(lower)}
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
        into_pocket = {"upper": _normals(upper, self._triangles["upper"]),
                       "lower": -_normals(lower, self._triangles["lower"])}
        smallest = np.inf
        for a, b, offset, free in self._pairs:
            if len(free):
                points = bodies[a][free]
                _, nearest = cKDTree(bodies[b]).query(points)
                apart = points - bodies[b][nearest]
                gaps = np.sum(apart * into_pocket[b][nearest], axis=1) - offset
                smallest = min(smallest, float(gaps.min()))
        return smallest


def _triangles(points: np.ndarray) -> np.ndarray:
    """Return triangles between points, seen along y, all of which look along -y."""
    plane = points[:, [0, 2]]
    triangles = Delaunay(plane).simplices
    a, b, c = (plane[triangles[:, i]] for i in range(3))
    area = (b - a)[:, 0] * (c - a)[:, 1] - (b - a)[:, 1] * (c - a)[:, 0]
    triangles[area < 0] = triangles[area < 0][:, ::-1]
    return triangles[np.abs(area) > 1e-9]


def _normals(points: np.ndarray, triangles: np.ndarray) -> np.ndarray:
    """Return the unit normals at points, means of the triangles' area vectors."""
    a, b, c = (points[triangles[:, i]] for i in range(3))
    area = np.cross(b - a, c - a)
    total = np.zeros_like(points)
    for i in range(3):
        np.add.at(total, triangles[:, i], area)
    return total / np.maximum(np.linalg.norm(total, axis=1, keepdims=True), 1e-300)
