"""Whether the skin passes through itself or a rib: without contact forces nothing hinders it."""

from __future__ import annotations

import numpy as np
from scipy.spatial import Delaunay, cKDTree

SMALLEST_GAP = 0.3
"""Points closer than this (mm) to the other side in the undeformed wing meet it by design."""


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
        self._triangles = {"upper": _triangles(upper), "lower": _triangles(lower)}
        pairs = [("upper", "lower", 0.0)]
        pairs += [("axes", "lower", radius), ("axes", "upper", radius)] if len(axes) else []
        everything = [(*pair, slice(None)) for pair in pairs]
        self._pairs = [
            (*pair, np.flatnonzero(gaps > SMALLEST_GAP))
            for pair, gaps in zip(pairs, self._gaps(everything, upper, lower, axes), strict=True)
        ]

    def smallest(self, upper: np.ndarray, lower: np.ndarray, axes: np.ndarray) -> float:
        """Return the smallest gap in mm of the deformed points; negative: they passed through.

        Parameters
        ----------
        upper, lower, axes
            Deformed points in the order of the undeformed ones.
        """
        gaps = self._gaps(self._pairs, upper, lower, axes)
        return min((float(found.min()) for found in gaps if len(found)), default=np.inf)

    def _gaps(
        self, pairs: list, upper: np.ndarray, lower: np.ndarray, axes: np.ndarray
    ) -> list[np.ndarray]:
        """Return, of each pair of bodies, how far points of the one are off the other's side."""
        bodies = {"upper": upper, "lower": lower, "axes": axes}
        into_pocket = {"upper": _normals(upper, self._triangles["upper"]),
                       "lower": -_normals(lower, self._triangles["lower"])}
        found = []
        for a, b, offset, chosen in pairs:
            points = bodies[a][chosen]
            _, nearest = cKDTree(bodies[b]).query(points)
            apart = points - bodies[b][nearest]
            found.append(np.sum(apart * into_pocket[b][nearest], axis=1) - offset)
        return found


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
