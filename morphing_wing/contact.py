"""Contact between found pairs: nodes of one side against facets of another.

Which facet a node is opposed to is searched before every load step and after it converged; where
that matters, the step goes on from there. Only pairs that are near have numbers in the system, so
that what is far apart costs nothing in the matrix.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
import ufl
from mpi4py import MPI
from petsc4py import PETSc

from . import compat
from .forms.contact import contact_correction, contact_energy, contact_force, contact_gap
from .geometry.facets import closest, gaps, project, shape_functions
from .iterate import Iterate
from .points import PointMesh
from .surface import Nodes, Surface
from .system import EquilibriumSystem

REACH = 3.0
"""Pairs nearer than this (mm) come into the matrix; those nearer than half of it must be there."""

BY_DESIGN = 0.3
"""What is nearer than this (mm) in the undeformed structure is not in contact, but joined."""

SOFT = 0.02
"""Penetration in mm up to which contact is softer, so that Newton's method meets no kink."""

DEEPEST = 0.1
"""How far (mm) one Newton step may lead a node in, if none is deeper already."""

SMALLEST_PART = 1.0 / 16.0
"""Part of a Newton step that is taken however deep it leads."""

CLOSE = 1e-4
"""Differences of a gap (mm) that are none."""

ALIKE = 0.5
"""Part of a penetration by which two facets may differ on it: at their edge both are right."""


@dataclass(frozen=True)
class Opposed:
    """Nodes that must not enter a surface.

    Attributes
    ----------
    nodes
        The nodes.
    surface
        The surface.
    area : (n,) array
        What each node stands for, mm^2; zero for one that is left out.
    radius : (n,) array
        The distance in mm that each keeps.
    """

    nodes: Nodes
    surface: Surface
    area: np.ndarray
    radius: np.ndarray


class Contact:
    """Frictionless contact as a penalty potential, see `morphing_wing.forms.contact`.

    Parameters
    ----------
    comm
        Communicator.
    sides
        What is opposed to what. Nodes nearer than `BY_DESIGN` when nothing is deformed are left
        out: there the two are one, or glued.
    stiffness
        Pressure per penetration, N/mm^3.
    soft
        Penetration in mm up to which contact is softer, so that Newton's method meets no kink.

    Attributes
    ----------
    block
        The pairs' unknowns.
    energy
        UFL functional in N mm.
    tangent_correction, iterate
        Bilinear form that makes the tangent robust, and the iterates that it needs.
    """

    def __init__(
        self, comm: MPI.Comm, sides: Sequence[Opposed], stiffness: float, soft: float = SOFT
    ) -> None:
        self._comm, self._sides = comm, list(sides)
        facet_size = self._sides[0].surface.facets.shape[1]
        self._degree = 1 if facet_size == 4 else 2
        self._apart = [self._are_apart(side) for side in self._sides]
        self._weight = [stiffness * np.where(apart, side.area, 0.0)
                        for side, apart in zip(self._sides, self._apart, strict=True)]
        n = sum(len(side.area) for side in self._sides)
        self._facet = np.full(n, -1)
        self._points = PointMesh(comm, n, 3 + 3 * facet_size, 3 * facet_size + 14, "pairs")
        self._mine = self._points.mine
        self._place()
        self.function, self.block = self._points.function, self._points.block
        self.block.refresh = self._refresh
        self.iterate = Iterate(self.function)
        data = self._points.data
        weight = data[3 * facet_size + 13]

        def gap(q: Any) -> Any:
            point, place, first, second = _kinematics(q, data, facet_size)
            return contact_gap(point, place, first, second, data[3 * facet_size + 12])

        self.energy = self._points.sum(contact_energy(gap(self.function), weight, soft))
        self.tangent_correction = self._points.sum(contact_correction(
            gap, weight, soft, self.function, self.iterate.last, self.iterate.step))
        self._force = compat.form(
            self._points.sum(contact_force(gap(self.function), weight, soft)))

    # -- which facet opposes which node -------------------------------------------------------

    def smallest_gap(self) -> float:
        """Return the smallest distance in mm of present positions, negative inside. Collective."""
        return min(float(gap.min(initial=np.inf)) for _, gap, _ in self._found())

    def prepare(self, system: EquilibriumSystem) -> bool:
        """Find the pairs for a load step from the present positions.

        Returns whether the system's matrix is a new one. Collective.
        """
        def missing(found: np.ndarray, gap: np.ndarray, _: np.ndarray) -> np.ndarray:
            return (gap < 0.5 * REACH) & (found != self._facet)

        return self._take(system, missing)

    def review(self, system: EquilibriumSystem) -> bool:
        """Find the pairs anew if the present positions show that those in use missed something.

        Returns whether the system's matrix is a new one. Collective.
        """
        def missed(found: np.ndarray, gap: np.ndarray, held: np.ndarray) -> np.ndarray:
            inside = (gap < 0.0) | (held < 0.0)
            return inside & (found != self._facet) & ~np.isclose(held, gap, rtol=ALIKE, atol=CLOSE)

        return self._take(system, missed)

    def _take(self, system: EquilibriumSystem, wrong: Callable[..., np.ndarray]) -> bool:
        found, gap, held = (np.concatenate(part) for part in zip(*self._found(), strict=True))
        # All ranks see the same positions; what one decides must be what all decide.
        changed = self._comm.bcast(bool(wrong(found, gap, held).any()), root=0)
        if changed:
            self._facet = np.where(gap < REACH, found, -1)
            self._renumber(system)
        return changed

    def admissible(self, system: EquilibriumSystem, x: PETSc.Vec, step: PETSc.Vec) -> float:
        """Return which part of a Newton step, from x to x - step, to take. Collective.

        What is thrown far through another wall would come back by chance.
        """
        system.pull(x)
        limit, part, moved = max(DEEPEST, self.penetration()), 1.0, x.duplicate()
        while part > SMALLEST_PART:
            moved.waxpy(-part, step, x)
            system.pull(moved)
            if self.penetration() <= limit:
                break
            part /= 2.0
        system.pull(x)
        moved.destroy()
        return part

    def penetration(self) -> float:
        """Return how deep in mm the deepest node of the present pairs is in. Collective."""
        used = self._weights > 0.0
        points = self._X[used] + self._points.values()[used, :3]
        depth = self._radius[used] - gaps(self._opposed()[used], points, self._xi[used])
        return float(self._comm.allreduce(depth.max(initial=0.0), op=MPI.MAX))

    def memory(self) -> list[int]:
        """Return which facet opposes each node: what a next step inherits beside positions."""
        return self._facet.tolist()

    def recall(self, system: EquilibriumSystem, facets: Sequence[int]) -> None:
        """Take over what `memory` returned, also in an earlier run. Collective."""
        self._facet = np.array(facets, dtype=int)
        self._renumber(system)

    def total_force(self) -> float:
        """Return the sum of the contact forces' magnitudes in N. Collective."""
        return compat.assemble_scalar(self._comm, self._force)

    def measures(self) -> dict[str, float]:
        """Return what is measured of the present state. Collective."""
        gap = self.smallest_gap()
        return {"gap_mm": gap, "touching": float(gap < 0.0), "contact_force_N": self.total_force(),
                "penetration_mm": self.penetration()}

    def _are_apart(self, side: Opposed) -> np.ndarray:
        """Return which nodes are not joined to the surface."""
        at = closest(side.nodes.reference, side.surface.nodes.reference, side.surface.facets)
        return (at.gap - side.radius > BY_DESIGN) & (side.area > 0.0)

    def _found(self) -> list[tuple[np.ndarray, np.ndarray, np.ndarray]]:
        """Return of each side the nodes' facets (-1: none), gaps, and gaps to the facets in use."""
        result, start = [], 0
        for side, apart in zip(self._sides, self._apart, strict=True):
            points, nodes = side.nodes.positions(), side.surface.nodes.positions()
            at = closest(points, nodes, side.surface.facets)
            facet = self._facet[start : start + len(points)]
            held = np.full(len(points), np.inf)
            paired = np.flatnonzero((facet >= 0) & (facet != at.facet))
            opposed = nodes[side.surface.facets[facet[paired]]]
            held[paired] = gaps(opposed, points[paired], project(opposed, points[paired]))
            result.append((at.facet, *(np.where(apart, gap - side.radius, np.inf)
                                       for gap in (at.gap, held))))
            start += len(points)
        return result

    def _renumber(self, system: EquilibriumSystem) -> None:
        size = self.function.function_space.dofmap.index_map_bs
        table = [np.full((len(side.area), size), -1, dtype=np.int64) for side in self._sides]
        start = 0
        for side, rows in zip(self._sides, table, strict=True):
            facet = self._facet[start : start + len(rows)]
            used = facet >= 0
            opposed = side.surface.nodes.numbers[side.surface.facets[facet[used]]]
            rows[used, :3] = side.nodes.numbers[used]
            rows[used, 3:] = opposed.reshape(used.sum(), size - 3)
            start += len(rows)
        rows = np.concatenate(table)[self._mine]
        self._place()
        system.renumber(self.block, self._points.as_dofs(rows))
        self.iterate.accept()

    # -- what the energy is given -------------------------------------------------------------

    def _place(self) -> None:
        """Set the reference positions of this rank's pairs, and their weights."""
        nodes, facets, weight = [], [], []
        start = 0
        for side, stiffness in zip(self._sides, self._weight, strict=True):
            facet = self._facet[start : start + len(side.area)]
            nodes.append(side.nodes.reference)
            facets.append(side.surface.nodes.reference[side.surface.facets[facet]])
            weight.append(np.where(facet >= 0, stiffness, 0.0))
            start += len(side.area)
        radius = [side.radius for side in self._sides]
        self._X, self._Y, self._radius, self._weights = (
            np.concatenate(part)[self._mine] for part in (nodes, facets, radius, weight))
        self._xi = np.zeros((len(self._mine), 2))
        self._refresh()

    def _refresh(self) -> None:
        """Move the places to where the distance is stationary at the present unknowns."""
        used = self._weights > 0.0
        points = self._X[used] + self._points.values()[used, :3]
        self._xi[used] = project(self._opposed()[used], points, self._xi[used])
        shapes = shape_functions(self._degree, self._xi)
        place, first, second = (np.einsum("na,nai->ni", N, self._Y) for N in shapes)
        self._points.set_data(np.concatenate(
            [*shapes, self._X, place, first, second, self._radius[:, None],
             self._weights[:, None]], axis=1))

    def _opposed(self) -> np.ndarray:
        """Return the deformed nodes of each pair's facet, (n_pairs, facet nodes, 3)."""
        return self._Y + self._points.values()[:, 3:].reshape(self._Y.shape)


def _kinematics(q: Any, data: Any, n: int) -> tuple[Any, Any, Any, Any]:
    """Return point, place and tangents of a pair, deformed."""
    def shown(k: int) -> Any:
        given = 3 * n + 3 + 3 * k
        return ufl.as_vector([
            data[given + i] + sum(data[k * n + a] * q[3 + 3 * a + i] for a in range(n))
            for i in range(3)])

    point = ufl.as_vector([data[3 * n + i] + q[i] for i in range(3)])
    return point, shown(0), shown(1), shown(2)
