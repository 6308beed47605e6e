"""Whether the shafts of bent ribs meet."""

from __future__ import annotations

import numpy as np
from mpi4py import MPI
from scipy.spatial import cKDTree

from .geometry.rib import HALF, LAYERS, RibGeometry
from .geometry.shafts import shaft_joints, smallest_gap

__all__ = ["ShaftGap"]


class ShaftGap:
    """The smallest gap between neighbouring shafts, see `morphing_wing.geometry.shafts`.

    Joints move as the nodes next to them do.

    Parameters
    ----------
    ribs
        A frame or solids of them.
    rib
        Dimensions of each.
    roots : (n_ribs, 3) array
        Where each one's root is, mm.
    half
        Whether the solids are halves.
    """

    def __init__(self, ribs: object, rib: RibGeometry, roots: np.ndarray, half: bool) -> None:
        self._function, self._rib, self._comm = ribs.function, rib, ribs.comm
        joints = shaft_joints(rib, HALF if half else LAYERS[rib.layers])
        self._joints = joints + np.asarray(roots, dtype=float)[:, None, None, None]
        space = self._function.function_space
        self._size = space.dofmap.index_map_bs
        nodes = space.tabulate_dof_coordinates()[: space.dofmap.index_map.size_local]
        places = self._joints.reshape(-1, 3)
        far, node = (cKDTree(nodes).query(places) if len(nodes) else
                     (np.full(len(places), np.inf), np.zeros(len(places), dtype=int)))
        nearest = np.array(self._comm.allgather(far)).argmin(axis=0)
        self._mine = np.flatnonzero(nearest == self._comm.rank)
        self._nodes = node[self._mine]

    def smallest(self) -> float:
        """Return it in mm, below zero where shafts have met. Collective."""
        moved = np.zeros((self._joints.size // 3, 3))
        values = self._function.x.array.reshape(-1, self._size)
        moved[self._mine] = values[self._nodes, :3]
        moved = self._comm.allreduce(moved, op=MPI.SUM)
        joints = self._joints + moved.reshape(self._joints.shape)
        return min(smallest_gap(self._rib, one) for one in joints)
