"""Points that may touch: nodes of a body's faces or of a frame, the same on every rank."""

from __future__ import annotations

from functools import cached_property
from typing import Any

import numpy as np
from mpi4py import MPI

from . import compat
from .bar_mesh import BarMesh
from .blocks import Block
from .elastomer import Elastomer
from .geometry.facets import node_areas
from .geometry.tetmesh import FACET_VERTICES
from .resin_body import ResinBody


class Nodes:
    """Nodes of a function with a displacement, known to every rank in the same order.

    Attributes
    ----------
    reference : (n, 3) array
        Undeformed positions, mm.
    """

    def __init__(
        self, comm: MPI.Comm, space: Any, block: Block, dofs: np.ndarray, names: np.ndarray
    ) -> None:
        """Take the nodes of a space with these global numbers, the same on every rank.

        Local node i has the displacements ``dofs[i]`` of the block.
        """
        self._comm, self._block = comm, block
        lower, upper = space.dofmap.index_map.local_range
        names = np.unique(names)
        mine = names[(names >= lower) & (names < upper)] - lower
        self._mine = dofs[mine]
        place = self._gathered(space.tabulate_dof_coordinates()[mine])
        # An order of places, which no number of ranks changes.
        self._order = np.lexsort(np.round(place, 6).T + 0.0)
        self.reference = place[self._order]
        self._names = names[self._order]
        self._sorted = np.argsort(self._names)

    @cached_property
    def numbers(self) -> np.ndarray:
        """The system's numbers of their displacements, shape (n, 3). Collective."""
        return self._gathered(self._block.numbers[self._mine])[self._order]

    def displacements(self) -> np.ndarray:
        """Return the present displacements, shape (n, 3), mm. Collective."""
        return self._gathered(self._block.function.x.array[self._mine])[self._order]

    def positions(self) -> np.ndarray:
        """Return the deformed positions, shape (n, 3), mm. Collective."""
        return self.reference + self.displacements()

    def index_of(self, names: np.ndarray) -> np.ndarray:
        """Return the rows of nodes by their global numbers in the space."""
        return self._sorted[np.searchsorted(self._names, names, sorter=self._sorted)]

    def _gathered(self, rows: np.ndarray) -> np.ndarray:
        return np.concatenate(self._comm.allgather(np.ascontiguousarray(rows)))


class Surface:
    """Some facets of an elastomer body.

    Attributes
    ----------
    nodes
        Their nodes.
    facets : (k, 4 or 9) int array
        Rows of ``nodes``, in tensor-product order, normal out of the body.
    area : (n,) array
        Each node's share of the area, mm^2.
    """

    def __init__(self, body: Elastomer, pairs: np.ndarray) -> None:
        """Take the facets given as pairs (cell of the grid, facet of the cell)."""
        space, dofs = body.displacement_space()
        points = compat.interpolation_points(space)
        x = space.tabulate_dof_coordinates()
        order, cells = body.faces.local(pairs, owned=True)
        found = [_outward(space.dofmap.cell_dofs(cell), points, int(facet), x)
                 for cell, facet in zip(cells, pairs[order, 1], strict=True)]
        width = (body.element.degree + 1) ** 2
        rows = np.array(found, dtype=np.int32).reshape(-1, width)
        index_map = space.dofmap.index_map
        names = index_map.local_to_global(rows.ravel()).reshape(-1, width)
        everything = body.comm.allgather((order, names))
        order, names = (np.concatenate([part[i] for part in everything]) for i in (0, 1))
        names = names[np.argsort(order)]
        self.nodes = Nodes(body.comm, space, body.block, dofs.reshape(-1, 3), names)
        self.facets = self.nodes.index_of(names)
        self.area = node_areas(self.nodes.reference, self.facets)


class Bars:
    """The nodes of a frame's bars, each with its share of a length and its half height.

    Attributes
    ----------
    nodes
        The nodes.
    area : (n,) array
        What each node stands for, mm^2: its share of the bars' length, as wide as they are high.
    radius : (n,) array
        Half the height of the thickest bar at it, mm.
    """

    def __init__(self, ribs: BarMesh) -> None:
        """Take the bars that have a height."""
        radius, lengths = ribs.frame.half_heights(), ribs.frame.lengths()
        space = ribs.function.function_space
        index_map = space.dofmap.index_map
        n_owned = ribs.mesh.topology.index_map(1).size_local
        chosen = [cell for cell, bar in enumerate(ribs.bars[:n_owned]) if not np.isnan(radius[bar])]
        nodes = np.array([space.dofmap.cell_dofs(cell) for cell in chosen], dtype=np.int32)
        names = index_map.local_to_global(nodes.ravel())
        radii = np.repeat(radius[ribs.bars[chosen]], nodes.size // max(len(chosen), 1))
        names, radii = (np.concatenate(part) for part in zip(
            *ribs.comm.allgather((names, radii)), strict=True))
        six = np.arange(len(ribs.function.x.array)).reshape(-1, 6)
        self.nodes = Nodes(ribs.comm, space, ribs.block, six[:, :3], names)
        n = len(self.nodes.reference)
        self.radius = np.zeros(n)
        np.maximum.at(self.radius, self.nodes.index_of(names), radii)
        self.area = 2.0 * self.radius * float(lengths[~np.isnan(radius)].sum()) / n


class Crests:
    """The vertices of a resin body's faces ``crests``.

    Attributes
    ----------
    nodes
        The nodes.
    area : (n,) array
        Each node's share of the area seen from above, mm^2.
    radius : (n,) array
        Zeros.
    """

    def __init__(self, body: ResinBody) -> None:
        space, grid = body.function.function_space, body.grid
        pairs = np.concatenate([found for name, found in grid.facets.items() if "crests" in name])
        vertices = grid.cells[pairs[:, :1], FACET_VERTICES[pairs[:, 1]]]
        corners = grid.points[vertices]
        across = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
        share = np.repeat(np.abs(across[:, 1]) / 6.0, 3)
        here, cells = body.faces.local(pairs, owned=True)
        nodes = np.array([space.dofmap.cell_dofs(cell)[FACET_VERTICES[facet]]
                          for cell, facet in zip(cells, pairs[here, 1], strict=True)], np.int32)
        names = space.dofmap.index_map.local_to_global(nodes.ravel())
        rows = (3 * here[:, None] + np.arange(3)).ravel()
        names, rows = (np.concatenate(part) for part in zip(
            *body.comm.allgather((names, rows)), strict=True))
        dofs = np.arange(len(body.function.x.array)).reshape(-1, 3)
        self.nodes = Nodes(body.comm, space, body.block, dofs, names)
        self.area = np.zeros(len(self.nodes.reference))
        np.add.at(self.area, self.nodes.index_of(names), share[rows])
        self.radius = np.zeros_like(self.area)


def _outward(
    cell_nodes: np.ndarray, points: np.ndarray, facet: int, x: np.ndarray
) -> np.ndarray:
    """Return the nodes of a cell's facet in tensor-product order, normal out of the cell."""
    axis, side = {0: (2, 0), 1: (1, 0), 2: (0, 0), 3: (0, 1), 4: (1, 1), 5: (2, 1)}[facet]
    on_facet = np.flatnonzero(np.abs(points[:, axis] - side) < 1e-9)
    a, b = (i for i in range(3) if i != axis)
    inside = x[cell_nodes].mean(axis=0)
    for fast, slow in ((a, b), (b, a)):
        chosen = on_facet[np.lexsort((points[on_facet, fast], points[on_facet, slow]))]
        corners = x[cell_nodes[chosen]]
        side_length = round(len(chosen) ** 0.5)
        first, second = corners[side_length - 1] - corners[0], corners[-side_length] - corners[0]
        if np.dot(np.cross(first, second), corners.mean(axis=0) - inside) > 0.0:
            return cell_nodes[chosen]
    raise AssertionError("a facet without an outside")
