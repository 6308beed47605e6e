"""A hyperelastic body of hexahedra: its function, its energy, its chambers and its faces."""

from __future__ import annotations

from collections.abc import Sequence
from functools import cached_property, partial
from typing import Any

import numpy as np
import ufl
from dolfinx import fem
from mpi4py import MPI

from . import compat
from .blocks import Block
from .elements import Element
from .errors import InputError
from .faces import Faces
from .forms.enhanced import N_MODES
from .forms.hyperelasticity import mixed_volumetric_energy, volumetric_energy, yeoh_energy
from .forms.kinematics import cofactor, deformation_gradient
from .forms.mixed_point import mixed_point_correction
from .forms.pressure import enclosed_volume
from .geometry.hexmesh import HexMesh
from .iterate import Iterate
from .materials import Yeoh
from .prestretch import Prestretch
from .thin import BULKY, THIN, ThinCells


class Elastomer:
    """One elastomer body on a distributed mesh.

    Parameters
    ----------
    comm
        Communicator.
    grid
        Mesh with named regions and faces; the one of rank 0 is used.
    material
        Yeoh material.
    element
        Finite element.
    clamped
        Faces whose points do not move.
    symmetry
        Faces that stay in their plane: mapping of name to axis (0, 1, 2).
    thin
        Regions that bend like plates: where an enhanced element has strains of its own.
    prestretch
        Stretches along x and z with which the thin regions are built in; None: none.
    pinned
        An axis, and a vertex of the grid that does not move along it; (3,) in mm.
    """

    def __init__(
        self,
        comm: MPI.Comm,
        grid: HexMesh,
        material: Yeoh,
        element: Element,
        clamped: Sequence[str] = (),
        symmetry: dict[str, int] | None = None,
        thin: Sequence[str] = (),
        prestretch: tuple[float, float] | None = None,
        pinned: tuple[int, np.ndarray] | None = None,
    ) -> None:
        if element.pressure is None and np.isinf(material.bulk):
            raise InputError(f"bulk = inf MPa: must be finite for element {element.name!r}, which "
                             "has no pressure of its own")
        self.comm, self.grid, self.material, self.element = comm, grid, material, element
        self.mesh = compat.create_mesh(comm, "hexahedron", grid.cells, grid.points)
        self.faces = Faces(self.mesh, grid.facets)
        self._thin = self._thin_cells(thin) if element.enhanced else None
        self.prestretch = prestretch and Prestretch(self.mesh, self._cells_of(*thin), prestretch)
        if element.pressure is not None:
            space = compat.displacement_pressure_space(
                self.mesh, element.degree, element.pressure
            )
        elif self._thin is not None:
            space = compat.displacement_modes_space(self.mesh, element.degree, N_MODES)
        else:
            space = compat.vector_space(self.mesh, element.degree)
        self.function = fem.Function(space, name="elastomer")
        constrained = self._constrained(space, clamped, symmetry or {}, pinned)
        if self._thin is None:
            self.block = Block(self.function, constrained)
        else:
            self.block = Block(self.function, constrained, self._thin.absent(space.sub(1)))
        self.u = ufl.split(self.function)[0] if self.is_mixed else self.function
        self.p = ufl.split(self.function)[1] if element.pressure is not None else None
        self.iterate = Iterate(self.function) if self.p is None else None
        self.X = ufl.SpatialCoordinate(self.mesh)
        self.normal = ufl.FacetNormal(self.mesh)
        self._compiled_probes: dict[str, list[Any]] = {}

    @property
    def is_mixed(self) -> bool:
        """Whether the function holds more than the displacement, which then is its first part."""
        return self.element.pressure is not None or self._thin is not None

    def displacement_part(self, function: Any) -> Any:
        """Return the displacement's part of a function, or of a space, of this element's kind."""
        return function.sub(0) if self.is_mixed else function

    # -- energies -----------------------------------------------------------------------------

    @cached_property
    def energy(self) -> Any:
        """Stored energy in N mm, a UFL functional."""
        # Constants, so that another material of this kind compiles nothing.
        coefficients = [compat.constant(self.mesh, c) for c in self.material.coefficients]
        total: Any = 0
        for F, (dx, dx_volumetric) in zip(
            self._gradients(self.function), self._measures(), strict=True
        ):
            total = total + yeoh_energy(F, coefficients) * dx
            total = total + self._volumetric_density(F) * dx_volumetric
        return total

    @cached_property
    def tangent_correction(self) -> Any | None:
        """Bilinear form that makes a displacement form's tangent robust; None for mixed forms."""
        if self.iterate is None:
            return None
        bulk = [compat.constant(self.mesh, self.material.bulk)]
        total: Any = 0
        for kind, (_, dx_volumetric) in enumerate(self._measures()):
            correction = mixed_point_correction(
                partial(self._dilatation, kind), bulk, self.function, self.iterate.last,
                self.iterate.step,
            )
            total = total + correction * dx_volumetric
        return total

    def chamber_volume(
        self, face: str, weight: Any = 1.0, cut: tuple[Any, Any] | None = None
    ) -> Any:
        """Return the deformed volume in mm^3 enclosed by a chamber's faces, a UFL functional.

        ``weight``, a number on each cell at most, stands in the integrand. ``cut`` are normal and
        distance of a plane that cuts the chamber open; None: it is closed.
        """
        return self.on_face(face, weight * enclosed_volume(self.u, self.X, self.normal, cut))

    def cavity_volume(self, pairs: np.ndarray, weight: Any = 1.0) -> Any:
        """Return the same of some facets, pairs (cell of the grid, facet of the cell).

        Whichever they are, it is compiled once.
        """
        volume = weight * enclosed_volume(self.u, self.X, self.normal)
        return volume * self.faces.measure_on(pairs, self.element.quadrature)

    # -- measures -----------------------------------------------------------------------------

    def volume_measure(self, degree: int | None = None) -> Any:
        """Return dx with a quadrature degree."""
        degree = degree or self.element.quadrature
        tags = None if self._thin is None else self._thin.tags
        return ufl.Measure("dx", self.mesh, subdomain_data=tags,
                           metadata={"quadrature_degree": degree})

    def on_face(self, face: str, integrand: Any, degree: int | None = None) -> Any:
        """Return the integral of an integrand over a named face, a UFL functional."""
        return self.faces.on(face, integrand, degree or self.element.quadrature)

    def mean_normal(self, face: str) -> np.ndarray:
        """Return the area vector in mm^2 of a deformed face, integral of ``cof(F) N``."""
        return np.array([compat.assemble_scalar(self.comm, f) for f in self._probes(face)[:3]])

    def mean_displacement(self, face: str) -> np.ndarray:
        """Return the mean displacement in mm of a face."""
        *sums, area = (compat.assemble_scalar(self.comm, f) for f in self._probes(face)[3:])
        return np.array(sums) / area

    def displacement(self) -> fem.Function:
        """Return the displacement as a function of its own, for pictures and files."""
        if not self.is_mixed:
            return self.function
        drawn, dofs = self._drawn
        drawn.x.array[:] = self.function.x.array[dofs]
        return drawn

    def displacement_space(self) -> tuple[Any, np.ndarray]:
        """Return the displacement's space, and the function's dof of each of its dofs."""
        if not self.is_mixed:
            return self.function.function_space, np.arange(len(self.function.x.array))
        return self._drawn[0].function_space, np.asarray(self._drawn[1])

    def n_pressures(self) -> int:
        """Global number of pressure unknowns."""
        if self.p is None:
            return 0
        dofmap = self.function.function_space.sub(1).collapse()[0].dofmap
        return dofmap.index_map.size_global * dofmap.index_map_bs

    # -- internals ----------------------------------------------------------------------------

    def _gradients(self, w: Any) -> list[Any]:
        """Return the elastic deformation gradient in all cells, or in bulky and in thin ones.

        ``w`` is ``function`` or another one of its space.
        """
        if self._thin is None:
            F = deformation_gradient(ufl.split(w)[0] if self.is_mixed else w)
            return [self._as_built(F)]
        u, modes = ufl.split(w)
        F = deformation_gradient(u)
        return [F, self._as_built(self._thin.deformation_gradient(F, modes))]

    def _as_built(self, F: Any) -> Any:
        return F if self.prestretch is None else F * self.prestretch.gradient

    def _measures(self) -> list[tuple[Any, Any]]:
        """Return isochoric and volumetric measure of each kind of cells."""
        degree, volumetric = self.element.quadrature, self.element.volumetric_quadrature
        dx, dx_volumetric = self.volume_measure(degree), self.volume_measure(volumetric)
        if self._thin is None:
            return [(dx, dx_volumetric)]
        # One point would not feel the modes, which keep incompressibility from locking the others.
        return [(dx(BULKY), dx_volumetric(BULKY)), (dx(THIN), dx(THIN))]

    def _dilatation(self, kind: int, w: Any) -> list[Any]:
        return [ufl.det(self._gradients(w)[kind]) - 1.0]

    def _volumetric_density(self, F: Any) -> Any:
        bulk = self.material.bulk
        if self.p is None:
            return volumetric_energy(F, compat.constant(self.mesh, bulk))
        inverse_bulk = compat.constant(self.mesh, 0.0 if np.isinf(bulk) else 1.0 / bulk)
        return mixed_volumetric_energy(F, self.p, inverse_bulk)

    @cached_property
    def _drawn(self) -> tuple[fem.Function, Any]:
        """A function for the displacement of a mixed form, and its dofs in the mixed one."""
        space, dofs = self.function.function_space.sub(0).collapse()
        return fem.Function(space, name="elastomer"), dofs

    def _probes(self, face: str) -> list[Any]:
        """Return compiled integrals over a face: area vector, displacement, area."""
        if face not in self._compiled_probes:
            area_vector = cofactor(deformation_gradient(self.u)) * self.normal
            integrands = [*(area_vector[i] for i in range(3)), *(self.u[i] for i in range(3))]
            one = compat.constant(self.mesh, 1.0)
            self._compiled_probes[face] = [
                compat.form(self.on_face(face, f)) for f in (*integrands, one)
            ]
        return self._compiled_probes[face]

    def lumped_volume(self, *regions: str) -> np.ndarray:
        """Return the volume in mm^3 of regions (all, if none is named) on each owned unknown.

        Zero for unknowns that are no displacements.
        """
        density = fem.Function(compat.discontinuous_space(self.mesh, 0))
        for cell in self._cells_of(*(regions or self.grid.regions)):
            density.x.array[density.function_space.dofmap.cell_dofs(cell)] = 1.0
        space = self.function.function_space
        v = ufl.TestFunction(space)
        volume = fem.Function(space)
        compat.assemble_vector(
            compat.form(density * sum(v[i] for i in range(3)) * self.volume_measure()),
            volume.x.array,
        )
        compat.add_ghosts(volume)
        return volume.x.array[self.block.owned]

    def is_displacement(self) -> np.ndarray:
        """Return which of the block's owned unknowns are displacements, as a mask."""
        found = np.ones(len(self.function.x.array), dtype=bool)
        if self.is_mixed:
            found[:] = False
            found[self._drawn[1]] = True
        return found[self.block.owned]

    def _thin_cells(self, regions: Sequence[str]) -> ThinCells | None:
        """Return the cells of thin regions, None if no rank has any."""
        if not regions:
            name = self.element.name
            raise InputError(f"element = {name!r}: must be of a body with thin parts, as a wing is")
        if not any(len(self.grid.regions[name]) for name in regions):
            return None
        return ThinCells(self.mesh, self._cells_of(*regions))

    def _cells_of(self, *regions: str) -> np.ndarray:
        """Return the local cells of regions."""
        cells = np.concatenate([self.grid.regions[name] for name in regions])
        return np.flatnonzero(np.isin(compat.original_cells(self.mesh), cells)).astype(np.int32)

    def _constrained(
        self,
        space: Any,
        clamped: Sequence[str],
        symmetry: dict[str, int],
        pinned: tuple[int, np.ndarray] | None,
    ) -> np.ndarray:
        displacement = self.displacement_part(space)
        held = [(face, axis) for face in clamped for axis in range(3)] + list(symmetry.items())
        found = self.faces.held(displacement, held)
        if pinned is None:
            return found
        part, at = displacement.sub(pinned[0]), np.reshape(pinned[1], (3, 1))
        pin = fem.locate_dofs_geometrical(
            (part, part.collapse()[0]), lambda x: np.all(np.isclose(x, at), axis=0))[0]
        return np.union1d(found, pin)
