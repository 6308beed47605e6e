"""Bars as cells of a branching interval mesh with six unknowns a node, and their ends."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
import ufl
from dolfinx import fem
from mpi4py import MPI

from morphing_wing.forms.beam import QUADRATURE_DEGREE, displacement
from morphing_wing.forms.gravity import gravity_potential
from morphing_wing.geometry.frame import Frame
from morphing_wing.materials import Elastic

from . import compat
from .blocks import Block
from .iterate import Iterate


class BarMesh:
    """The finite-element side of a `Frame`, of one or several ribs, without its energy.

    Parameters
    ----------
    comm
        Communicator; the ribs are distributed over it, each whole.
    frame
        Points, bars, axes and sections; the same on every rank.
    material
        The ribs' resin.
    degree
        Of the unknowns in each cell.
    clamped
        Whether roots do not move.
    held
        Which of a node's six unknowns are none.

    Attributes
    ----------
    mesh
        Interval mesh in 3D, one cell a bar; local cell c is bar ``bars[c]``.
    function
        w = (u, theta) in mm and radians, block size 6.
    block
        Of ``function``.
    motion, motion_mesh
        The same function and its mesh: translation and rotation vector of the ends, see `at_ends`.
    iterate
        The iterates that a tangent correction needs.
    carried
        The frame that is drawn where the bars are axes alone; None: they are bars.
    """

    carried: Frame | None = None

    def __init__(
        self, comm: MPI.Comm, frame: Frame, material: Elastic, degree: int, clamped: bool = False,
        held: Sequence[int] = (),
    ) -> None:
        self.comm, self.frame, self.material = comm, frame, material
        self.mesh = compat.create_mesh(comm, "interval", frame.bars, frame.points, frame.ribs)
        self.bars = compat.original_cells(self.mesh)
        self.function = fem.Function(compat.vector_space(self.mesh, degree, 6), name="ribs")
        every = np.arange(len(self.function.x.array), dtype=np.int32).reshape(-1, 6)
        still = [self.end_dofs("root", rib) for rib in range(len(frame.roots))] if clamped else []
        still.append(every[:, list(held)].ravel())
        self.block = Block(self.function, np.unique(np.concatenate(still)))
        self.motion, self.motion_mesh = self.function, self.mesh
        self.iterate = Iterate(self.function)

    @property
    def unknowns(self) -> list[Block]:
        """The independent blocks of a system."""
        return [self.block]

    @property
    def parts(self) -> tuple[Any, ...]:
        """What stores energy."""
        return (self,)

    def join(self, system: Any) -> None:
        """Do nothing: all unknowns are the bars' own."""

    @property
    def measure(self) -> Any:
        """The measure along the bars, with the two Gauss points of quadratic beams."""
        return ufl.dx(domain=self.mesh, metadata={"quadrature_degree": QUADRATURE_DEGREE})

    def rise(self, weight: float) -> Any:
        """Return the integral of a weight in N/mm^3 times the way up, a UFL functional.

        Bars weigh by their whole length: the little in which they overlap at joints weighs twice.
        """
        line = compat.constant(self.mesh, weight) * self.cellwise(self.frame.areas())
        return gravity_potential(line, displacement(self.function)) * self.measure

    def lumped_volume(self) -> np.ndarray:
        """Return the volume in mm^3 on each owned unknown; none on a rotation: bars are thin."""
        space, area = self.function.function_space, self.cellwise(self.frame.areas())
        v, volume = ufl.TestFunction(space), fem.Function(space)
        compat.assemble_vector(
            compat.form(area * (v[0] + v[1] + v[2]) * self.measure), volume.x.array)
        compat.add_ghosts(volume)
        return volume.x.array[: 6 * space.dofmap.index_map.size_local].copy()

    def cellwise(self, values: np.ndarray) -> fem.Function:
        """Return the function with one value (scalar, vector, matrix) a bar, given as (m, ...)."""
        space = compat.discontinuous_space(self.mesh, 0, values.shape[1:])
        function = fem.Function(space)
        size = int(np.prod(values.shape[1:], dtype=int))
        table = function.x.array.reshape(-1, size)
        for cell, bar in enumerate(self.bars):
            table[space.dofmap.cell_dofs(cell)[0]] = values[bar].ravel()
        return function

    def at_ends(self, kind: str, integrand: Any) -> Any:
        """Return the sum of an integrand over the ribs' roots or tails as a UFL functional.

        Parameters
        ----------
        kind
            ``"root"`` or ``"tail"``.
        integrand
            UFL, evaluated at the end points.
        """
        # Root and tail points alone belong to one cell only: they are the exterior facets.
        frame = self.frame
        chosen = self.cellwise((frame.kinds == frame.names.index(kind)).astype(float))
        ds = ufl.ds(domain=self.mesh, metadata={"quadrature_degree": 1})
        return chosen * integrand * ds

    def end_dofs(self, kind: str, rib: int) -> np.ndarray:
        """Return the six local dofs of a rib's root or tail where this rank has them, else none.

        Displacements first, then rotations. Owned or ghost: see `owned`.
        """
        frame = self.frame
        point = (frame.roots if kind == "root" else frame.tails)[rib]
        here = np.flatnonzero(
            (frame.kinds[self.bars] == frame.names.index(kind)) & (frame.ribs[self.bars] == rib)
        )
        if len(here) == 0:
            return np.empty(0, dtype=np.int32)
        space = self.function.function_space
        nodes = space.dofmap.cell_dofs(here[0])
        away = np.linalg.norm(
            space.tabulate_dof_coordinates()[nodes] - frame.points[point], axis=1
        )
        return (6 * nodes[np.argmin(away)] + np.arange(6)).astype(np.int32)

    def owned(self, dofs: np.ndarray) -> np.ndarray:
        """Return the dofs if this rank owns them, else none."""
        n_owned = 6 * self.function.function_space.dofmap.index_map.size_local
        return dofs[dofs < n_owned]

    def end_numbers(self, kind: str, rib: int) -> np.ndarray:
        """Return a system's numbers of a rib's root or tail on every rank, shape (6,)."""
        numbers = np.zeros(6, dtype=np.int64)
        dofs = self.owned(self.end_dofs(kind, rib))
        if len(dofs):
            numbers[:] = self.block.numbers[dofs]
        return self.comm.allreduce(numbers, op=MPI.SUM)

    def end_values(self, kind: str, rib: int) -> np.ndarray:
        """Return u (mm) and theta of a rib's root or tail on every rank, shape (6,)."""
        values = np.zeros(6)
        dofs = self.owned(self.end_dofs(kind, rib))
        if len(dofs):
            values[:] = self.function.x.array[dofs]
        return self.comm.allreduce(values, op=MPI.SUM)
