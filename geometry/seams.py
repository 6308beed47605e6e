"""Seams of the wing's mesh: where the two sides of the skin are one body, and where it is slit."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from .hexmesh import HexMesh
from .wing import WingGeometry


def with_seams(mesh: HexMesh, wing: WingGeometry) -> HexMesh:
    """Join the skin's two sides where they meet, and cut it where the wing has a slit.

    A slit leaves the geometry as it is: its two sides have points of their own in the same place.
    """
    if wing.skin_slit == "trailing_edge":
        return mesh
    mesh = _joined(mesh)
    return _cut_behind_spar(mesh, wing) if wing.skin_slit == "lower" else mesh


def _joined(mesh: HexMesh) -> HexMesh:
    """Join points that coincide: where the two sides of the skin meet."""
    _, first, number = np.unique(
        np.round(mesh.points, 7) + 0.0, axis=0, return_index=True, return_inverse=True
    )
    return replace(mesh, points=mesh.points[first], cells=number.ravel()[mesh.cells])


def _cut_behind_spar(mesh: HexMesh, wing: WingGeometry) -> HexMesh:
    """Give the lower skin points of its own where it meets the spar, up to a tip wall if any."""
    corners = mesh.points[mesh.cells[mesh.regions["skin"]]]
    x, y, _ = corners.mean(axis=1).T
    lower = mesh.regions["skin"][y < wing.section.camber(x)]
    cut = np.intersect1d(mesh.cells[lower], mesh.cells[mesh.regions["spar"]])
    if wing.tip_wall:
        cut = cut[mesh.points[cut, 2] < wing.span - wing.wall_length - 1e-9]
    number = np.arange(len(mesh.points))
    number[cut] = len(mesh.points) + np.arange(len(cut))
    cells = mesh.cells.copy()
    cells[lower] = number[cells[lower]]
    return replace(mesh, points=np.concatenate([mesh.points, mesh.points[cut]]), cells=cells)
