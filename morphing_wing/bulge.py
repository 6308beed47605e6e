r"""How far the wall over a chamber stands out: ballooning, apart from the bending of the spar.

On the line along the span in the middle of the outer face, the wall over a chamber reaches from one
wall between chambers to the next. The bulge is the largest distance of that piece from the chord
between its ends; a wall that only stretches, as the paper's formula has it, has none.
"""

from __future__ import annotations

import weakref

import numpy as np

from .fields import scene_grids
from .path import State
from .spar import Spar

__all__ = ["Bulge"]


class Bulge:
    """Adds ``bulge_mm`` to the measures of each state: that of the upper chamber that has most.

    Parameters
    ----------
    scene
        A spar with a mesh, whole or one cell. Put the object into its ``watch``. Collective.

    Examples
    --------
    >>> spar.watch.append(Bulge(spar))                              # doctest: +SKIP
    >>> spar.inflate(upper=0.02)[-1].measures["bulge_mm"]           # doctest: +SKIP
    """

    def __init__(self, scene: Spar) -> None:
        self._scene = weakref.proxy(scene)  # which may hold this object

    def __call__(self, state: State) -> None:
        """Measure the present state."""
        grid = scene_grids(self._scene, state)["elastomer"]
        found = None
        if grid is not None:
            found = self._largest(grid.points, grid.point_data["displacement"], state)
        state.measures["bulge_mm"] = self._scene.comm.bcast(found)

    def _largest(self, points: np.ndarray, displacement: np.ndarray, state: State) -> float:
        spar = self._scene.geometry
        near = 1e-6 * spar.height
        line = (np.abs(points[:, 0]) < near) & (np.abs(points[:, 1] - spar.height / 2) < near)
        order = np.argsort(points[line, 2])
        rest = points[line, 2][order]
        moved = (points + displacement)[line][order][:, [2, 1]]  # along the span, and up
        if self._scene.fidelity == "cell":  # half a chamber, which its middle's plane mirrors
            turn = np.radians(state.measures["span_angle_deg"]) / (2 * spar.n_cells)
            up = np.array([np.sin(turn), np.cos(turn)])
            edge = moved[np.argmin(np.abs(rest - spar.wall_length / 2))]
            return float(((moved[rest > spar.wall_length / 2 - near] - edge) @ up).max())
        begins = np.cumsum(spar.walls[:-1] + spar.cavity_length) - spar.cavity_length
        return max(_off_chord(moved[(rest > begin - near)
                                    & (rest < begin + spar.cavity_length + near)])
                   for begin in begins)


def _off_chord(piece: np.ndarray) -> float:
    """Return how far a piece, shape (n, 2), stands out to the left of the chord of its ends."""
    along = (piece[-1] - piece[0]) / np.linalg.norm(piece[-1] - piece[0])
    return float(((piece - piece[0]) @ np.array([-along[1], along[0]])).max())
