"""Lines of a finite-element grid as round bars."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    import pyvista

__all__ = ["tubes"]


def tubes(
    grid: pyvista.UnstructuredGrid, radius: float | np.ndarray, deformed: bool,
    shown: str = "displacement", pieces: int = 6,
) -> pyvista.PolyData:
    """Return bars of round section around the cells of a grid of intervals.

    Parameters
    ----------
    grid
        First- or second-order line cells with point array ``displacement`` and cell array ``cell``.
    radius
        In mm; one number, or one for each cell by its original number.
    deformed
        Whether to draw the deformed axes.
    shown
        Vector at the points whose length is ``magnitude``.
    pieces
        Straight pieces in which a second-order axis is drawn.

    Returns
    -------
    pyvista.PolyData with point array ``magnitude``, the length of a vector. Bars end
    in spheres, so that they join at any angle.
    """
    import pyvista

    cells = grid.cells.reshape(grid.n_cells, -1)[:, 1:]
    displacement = np.asarray(grid.point_data["displacement"])
    points = grid.points + displacement * deformed
    lengths = np.linalg.norm(grid.point_data[shown], axis=1)
    shapes = _shapes(cells.shape[1], pieces)
    axes = np.einsum("ta,cai->cti", shapes, points[cells])
    along = np.einsum("ta,ca->ct", shapes, lengths[cells])
    radii = np.broadcast_to(np.asarray(radius, dtype=float), np.shape(radius) or (1,))
    radii = radii[np.asarray(grid.cell_data["cell"])] if len(radii) > 1 else np.full(
        grid.n_cells, radii[0])
    parts = []
    for value in np.unique(radii):
        chosen = radii == value
        count, length = int(chosen.sum()), axes.shape[1]
        numbers = np.arange(count * length).reshape(count, length)
        lines = np.insert(numbers, 0, length, axis=1).ravel()
        poly = pyvista.PolyData(axes[chosen].reshape(-1, 3), lines=lines)
        poly.point_data["magnitude"] = along[chosen].ravel()
        parts.append(poly.tube(radius=value, n_sides=16, capping=True))
        ball = pyvista.Sphere(radius=value, theta_resolution=16, phi_resolution=10)
        joints = pyvista.PolyData(axes[chosen][:, [0, -1]].reshape(-1, 3))
        joints.point_data["magnitude"] = along[chosen][:, [0, -1]].ravel()
        parts.append(joints.glyph(geom=ball, scale=False, orient=False))
    return parts[0].append_polydata(*parts[1:]) if len(parts) > 1 else parts[0]


def _shapes(n_nodes: int, pieces: int) -> np.ndarray:
    """Return shape functions along a line cell (ends first, as in VTK), shape (n, n_nodes)."""
    if n_nodes == 2:
        return np.array([[1.0, 0.0], [0.0, 1.0]])
    t = np.linspace(0.0, 1.0, pieces + 1)
    return np.stack([(1 - t) * (1 - 2 * t), t * (2 * t - 1), 4 * t * (1 - t)], axis=1)
