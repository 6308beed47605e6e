"""The other half of a half model, joined to the first as one grid."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    import pyvista

__all__ = ["mirrored"]


def mirrored(grid: pyvista.UnstructuredGrid, plane_x: float) -> pyvista.UnstructuredGrid:
    """Return a grid and its mirror image in the plane x = ``plane_x`` as one grid.

    Points in the plane are shared, so no inner face is left there, and the nodes of the mirrored
    cells are numbered anew, so that they are not inside out.

    Parameters
    ----------
    grid
        Cells of one kind, of any order, with point array ``displacement``.
    plane_x
        In mm, in the coordinates of the grid.
    """
    import pyvista

    cells = grid.cells.reshape(grid.n_cells, -1)[:, 1:]
    n = grid.n_points
    beyond = np.abs(grid.points[:, 0] - plane_x) > 1e-9 * max(np.ptp(grid.points), 1.0)
    image_of = np.arange(n)
    image_of[beyond] = n + np.arange(beyond.sum())
    images = image_of[cells][:, _turned(grid)]
    points = np.concatenate([grid.points, grid.points[beyond]])
    points[n:, 0] = 2 * plane_x - points[n:, 0]
    both = np.insert(np.concatenate([cells, images]), 0, cells.shape[1], axis=1)
    whole = pyvista.UnstructuredGrid(both.ravel(), np.tile(grid.celltypes, 2), points)
    for name, values in grid.point_data.items():
        whole.point_data[name] = np.concatenate([values, values[beyond]])
    displacement = whole.point_data["displacement"]
    displacement[n:, 0] *= -1.0
    return whole


def _turned(grid: pyvista.UnstructuredGrid) -> np.ndarray:
    """Return the order of a cell's nodes in which its first two parametric axes are swapped."""
    cell = grid.GetCell(0)
    at = np.array(cell.GetParametricCoords()).reshape(-1, 3)[: cell.GetNumberOfPoints()]
    distance = np.linalg.norm(at[:, None, [1, 0, 2]] - at[None], axis=-1)
    return distance.argmin(axis=1)
