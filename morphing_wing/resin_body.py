"""A resin body of second-order tetrahedra: its function, its energy and its faces."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from functools import cached_property
from typing import Any

import numpy as np
import ufl
from dolfinx import fem
from mpi4py import MPI

from . import compat
from .blocks import Block
from .faces import Faces
from .forms.resin import resin_energy, resin_tangent_correction
from .geometry.tetmesh import TetMesh
from .iterate import Iterate
from .materials import Elastic

QUADRATURE_DEGREE = 4
"""Gradients in second-order tetrahedra are linear where edges are straight; the energy has their
fourth power."""

_SHARES = np.array([6.0] * 4 + [32.0] * 6) / 216.0
"""Of a cell's mass at its nodes, as the diagonal of its mass matrix has it: row sums at the
vertices are negative (Hinton, Rock, Zienkiewicz, Earthq. Engng Struct. Dyn. 4 (1976) 245-249)."""


class ResinBody:
    """One body, or several that are not joined, on a distributed mesh.

    Parameters
    ----------
    comm
        Communicator.
    grid
        Mesh with named faces; the same on every rank.
    material
        Resin.
    held
        Pairs of a face and the axis (0, 1, 2) along which its points do not move.

    Attributes
    ----------
    function, block
        The displacement in mm, continuous and quadratic in each cell, and its block.
    """

    def __init__(
        self, comm: MPI.Comm, grid: TetMesh, material: Elastic,
        held: Sequence[tuple[str, int]] = (),
    ) -> None:
        self.comm, self.grid, self.material = comm, grid, material
        self.mesh = compat.create_mesh(comm, "tetrahedron", grid.cells, grid.points)
        self.faces = Faces(self.mesh, grid.facets)
        self.function = fem.Function(compat.vector_space(self.mesh, 2), name="ribs")
        self.block = Block(self.function, self.faces.held(self.function.function_space, held))
        self.iterate = Iterate(self.function)
        self.X = ufl.SpatialCoordinate(self.mesh)
        # Constants, so that another resin compiles nothing.
        self.moduli = [compat.constant(self.mesh, modulus)
                       for modulus in (material.lame_modulus, material.shear_modulus)]

    @cached_property
    def energy(self) -> Any:
        """Stored energy in N mm, a UFL functional."""
        return resin_energy(self.function, *self.moduli) * self.measure

    @cached_property
    def tangent_correction(self) -> Any:
        """Bilinear form that makes the tangent robust."""
        return resin_tangent_correction(
            self.function, self.iterate.last, self.iterate.step, *self.moduli) * self.measure

    @property
    def measure(self) -> Any:
        """The measure over the body."""
        return ufl.dx(domain=self.mesh, metadata={"quadrature_degree": QUADRATURE_DEGREE})

    def measure_on(self, faces: Iterable[str]) -> Any:
        """Return the measure over named faces; what is integrated together shares one."""
        pairs = np.concatenate([self.grid.facets[face] for face in faces])
        return self.faces.measure_on(pairs, QUADRATURE_DEGREE)

    def lumped_volume(self) -> np.ndarray:
        """Return the volume in mm^3 on each owned unknown."""
        space = self.function.function_space
        cellwise = fem.Function(compat.discontinuous_space(self.mesh, 0))
        one = ufl.TestFunction(cellwise.function_space)
        compat.assemble_vector(compat.form(one * self.measure), cellwise.x.array)
        volume = fem.Function(space)
        table = volume.x.array.reshape(-1, 3)
        for cell in range(self.mesh.topology.index_map(3).size_local):
            size = cellwise.x.array[cellwise.function_space.dofmap.cell_dofs(cell)[0]]
            table[space.dofmap.cell_dofs(cell)] += size * _SHARES[:, None]
        compat.add_ghosts(volume)
        return volume.x.array[self.block.owned]
