"""The hollow trailing edge: how near its sides come to each other and to the ribs."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from dolfinx import fem
from mpi4py import MPI

from .clearance import Clearance
from .elastomer import Elastomer
from .frame import BeamFrame
from .geometry.wing import WingGeometry


class Pocket:
    """Deformed points of the pocket's sides and of the ribs' axes, known to every rank."""

    def __init__(self, body: Elastomer, ribs: BeamFrame | None, wing: WingGeometry) -> None:
        self._sources = [
            _Points(body.comm, body.displacement, body.face_facets(side))
            for side in ("pocket_upper", "pocket_lower")
        ]
        axes, radius = np.empty((0, 3)), 0.0
        if ribs is not None:
            self._sources.append(_Points(body.comm, lambda: ribs.function, None))
            axes, radius = self._sources[2].reference, 0.5 * wing.rib.shaft_width
        upper, lower = (source.reference for source in self._sources[:2])
        self._clearance = Clearance(upper, lower, axes, radius)

    def smallest_gap(self) -> float:
        """Return the smallest gap in mm; negative where the skin passed through something."""
        points = [source.deformed() for source in self._sources]
        if len(points) == 2:
            points.append(np.empty((0, 3)))
        return self._clearance.smallest(*points)


class _Points:
    """Dof points of a displacement on some facets (None: all), the same on every rank."""

    def __init__(
        self, comm: MPI.Comm, displacement: Callable[[], fem.Function], facets: np.ndarray | None
    ) -> None:
        space = displacement().function_space
        n_owned = space.dofmap.index_map.size_local
        if facets is None:
            points = np.arange(n_owned)
        else:
            points = fem.locate_dofs_topological(space, space.mesh.topology.dim - 1, facets)
            points = points[points < n_owned]
        self._comm, self._displacement, self._points = comm, displacement, points
        self._size = space.dofmap.index_map_bs
        # An order and rounding of its own, or ties between neighbours are decided by the ranks.
        reference = np.round(self._gathered(space.tabulate_dof_coordinates()[points]), 6) + 0.0
        self._order = np.lexsort(reference.T)
        self.reference = reference[self._order]

    def deformed(self) -> np.ndarray:
        """Return X + u, shape (n, 3), mm."""
        values = self._displacement().x.array.reshape(-1, self._size)[self._points, :3]
        return self.reference + self._gathered(values)[self._order]

    def _gathered(self, rows: np.ndarray) -> np.ndarray:
        return np.concatenate(self._comm.allgather(np.ascontiguousarray(rows)))
