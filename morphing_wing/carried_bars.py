"""The bars of ribs of which an analysis knows the axis alone, to be drawn."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from morphing_wing.angles import turned
from morphing_wing.geometry.frame import Frame

if TYPE_CHECKING:
    import pyvista

__all__ = ["carried"]


def carried(axes: pyvista.UnstructuredGrid, frame: Frame) -> pyvista.UnstructuredGrid:
    """Return the bars of a frame where their ribs' axes carry them, each section without strain.

    Parameters
    ----------
    axes
        Grid of the ribs' axes, points one rib after the other along x, with point arrays
        ``displacement`` and ``rotation``; perhaps ``mode`` and ``mode_rotation``, small changes of
        the two.
    frame
        The same ribs in the same order, all alike.

    Returns
    -------
    pyvista.UnstructuredGrid with the bars as cells, point array ``displacement``, ``mode`` if there
    was one, and cell array ``cell``.
    """
    import pyvista

    n = len(frame.roots)
    x = np.asarray(axes.points)[:, 0].reshape(n, -1)
    points = frame.points.reshape(n, -1, 3)
    away = points - frame.points[frame.roots][:, None]
    away[:, :, 0] = 0.0

    def along(name: str) -> np.ndarray:
        values = np.asarray(axes.point_data[name]).reshape(n, -1, 3)
        return np.array([[np.interp(points[rib, :, 0], x[rib], values[rib, :, i])
                          for i in range(3)] for rib in range(n)]).transpose(0, 2, 1)

    now = turned(along("rotation"), away)
    cells = np.insert(frame.bars, 0, 2, axis=1).ravel()
    found = pyvista.UnstructuredGrid(
        cells, np.full(len(frame.bars), pyvista.CellType.LINE), frame.points)
    found.point_data["displacement"] = (along("displacement") + now - away).reshape(-1, 3)
    if "mode" in axes.point_data:
        found.point_data["mode"] = (
            along("mode") + np.cross(along("mode_rotation"), now)).reshape(-1, 3)
    found.cell_data["cell"] = np.arange(len(frame.bars))
    return found
