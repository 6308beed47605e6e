"""Glue between ribs and elastomer: each rib end is a rigid foot on a patch of the elastomer."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
from dolfinx import fem
from numpy.polynomial import Legendre, Polynomial

from . import compat
from .blocks import Block, SharedUnknowns
from .elastomer import Elastomer
from .errors import require
from .forms.adhesive import adhesive_energy, foot_displacement
from .forms.beam import displacement, rotation_vector
from .forms.mixed_point import mixed_point_correction
from .frame import BeamFrame
from .geometry.hexmesh import HexMesh
from .geometry.wing import WingGeometry
from .iterate import Iterate

# Patches need not end on mesh lines: on a facet, a patch is the polynomial of this degree in each
# direction with which the integrals of all polynomials up to that degree are those over the patch
# (its projection). The glue's energy is of that degree, for quadratic displacements: it is exact.
_PATCH_DEGREE = 4
_QUADRATURE_DEGREE = 2 * _PATCH_DEGREE


def with_glued_faces(grid: HexMesh, wing: WingGeometry) -> HexMesh:
    """Name the facets that a rib's end touches: ``foot`` on the rear wall, ``bond`` in the tail."""
    faces = {"foot": ["rear_wall"]}
    if wing.skin_thickness is not None:
        faces["bond"] = ["pocket_upper", "pocket_lower"]
    facets = dict(grid.facets)
    for name, parents in faces.items():
        found = []
        for parent in parents:
            corners = grid.facet_points(parent)
            low, high = corners.min(axis=1), corners.max(axis=1)
            touched = np.zeros(len(corners), dtype=bool)
            for box in _boxes(wing, name):
                touched |= ((low < box[1]) & (high > box[0])).all(axis=1)
            found.append(grid.facets[parent][touched])
        facets[name] = np.concatenate(found)
    return replace(grid, facets=facets)


def _boxes(wing: WingGeometry, face: str) -> np.ndarray:
    """Return lower and upper corner in mm of each rib's patch, shape (n_ribs, 2, 3)."""
    height, width = wing.foot()
    roots = wing.rib_roots()
    if face == "foot":
        half = np.array([1.0, height / 2.0, width / 2.0])
        return np.stack([roots - half, roots + half], axis=1)
    end = roots + np.array([wing.rib.length, 0.0, 0.0])
    low = np.array([0.0, -wing.chord, -width / 2.0])
    high = np.array([wing.tail_bond_length, wing.chord, width / 2.0])
    return np.stack([end + low, end + high], axis=1)


def _patch_on_facet(
    low: np.ndarray, high: np.ndarray, box: np.ndarray
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return the part of a facet in a box as a polynomial along each axis.

    The facet's bounds are ``low`` and ``high``. Along axes where it is flat or not cut the
    polynomial is 1, else ``sum_k c_k P_k`` with Legendre's polynomials and ``c_k = (2k + 1)/2``
    times the integral of P_k over the part of [-1, 1] that lies in the box.

    Returns
    -------
    middle, half : (3,) arrays
        Of the facet's bounds, mm; half is 1 where it is flat.
    coefficients : (3, degree + 1) array
        Of the powers of (x - middle)/half.
    """
    middle, half = 0.5 * (low + high), 0.5 * (high - low)
    half[half < 1e-9] = 1.0
    coefficients = np.zeros((3, _PATCH_DEGREE + 1))
    for axis, (start, end) in enumerate(np.clip((box - middle) / half, -1.0, 1.0).T):
        basis = [Legendre.basis(k) for k in range(_PATCH_DEGREE + 1)]
        series = [(k + 0.5) * (P.integ()(end) - P.integ()(start)) for k, P in enumerate(basis)]
        powers = Legendre(series).convert(kind=Polynomial).coef
        coefficients[axis, : len(powers)] = powers
    return middle, half, coefficients


class Glue:
    """The adhesive's energy, with the ribs' end unknowns shared by the cells that they touch.

    Attributes
    ----------
    block
        Six unknowns a cell that stand for a rib's root or tail.
    energy
        UFL functional in N mm.
    tangent_correction, iterate
        Bilinear form that makes the tangent robust, and the iterates that it needs.
    """

    def __init__(self, body: Elastomer, ribs: BeamFrame, wing: WingGeometry) -> None:
        self._ribs = ribs
        self._groups: list[tuple[str, int, np.ndarray]] = []
        space = compat.discontinuous_space(body.mesh, 0, (6,))
        self.function = fem.Function(space, name="feet")
        self.block = Block(self.function)
        vectors = compat.discontinuous_space(body.mesh, 0, (3,))
        tables = compat.discontinuous_space(body.mesh, 0, (3, _PATCH_DEGREE + 1))
        middle, half, origin = (fem.Function(vectors) for _ in range(3))
        patch = fem.Function(tables)
        half.x.array[:] = 1.0
        original = compat.original_cells(body.mesh)
        roots = wing.rib_roots()
        tails = roots + np.array([wing.rib.length, 0.0, 0.0])
        ends = {"foot": ("root", roots), "bond": ("tail", tails)}
        faces = [face for face in ends if face in body.grid.facets]
        for face in faces:
            kind, points = ends[face]
            corners = body.grid.facet_points(face)
            facet_of = {int(cell): i for i, (cell, _) in enumerate(body.grid.facets[face])}
            n_feet = np.zeros(len(corners), dtype=int)
            for rib, box in enumerate(_boxes(wing, face)):
                chosen = (corners.min(axis=1) < box[1]) & (corners.max(axis=1) > box[0])
                n_feet += chosen.all(axis=1)
                # A cell carries the six unknowns of one rib.
                require(n_feet.max() == 1, "rib_positions", list(wing.rib_positions), "",
                        "so far apart that no cell of the mesh touches two ribs")
                cells = body.face_cells(face, chosen.all(axis=1))
                self._groups.append((kind, rib, cells))
                for cell in cells:
                    facet = corners[facet_of[int(original[cell])]]
                    place, size, part = _patch_on_facet(facet.min(axis=0), facet.max(axis=0), box)
                    for function, value in (
                        (middle, place), (half, size), (origin, points[rib]), (patch, part)
                    ):
                        table = function.x.array.reshape(-1, value.size)
                        dof = function.function_space.dofmap.cell_dofs(cell)[0]
                        table[dof] = value.ravel()
        inside = 1.0
        for i in range(3):
            xi = (body.X[i] - middle[i]) / half[i]
            inside = inside * sum(patch[i, k] * xi**k for k in range(_PATCH_DEGREE + 1))
        stiffness = fem.Constant(body.mesh, compat.scalar_type(wing.glue_stiffness))

        def foot(q: Any) -> Any:
            return foot_displacement(body.X, origin, displacement(q), rotation_vector(q))

        def separation(q: Any) -> list[Any]:
            return [body.u[i] - foot(q)[i] for i in range(3)]

        def on_patches(integrand: Any) -> Any:
            return sum(body.on_face(f, inside * integrand, _QUADRATURE_DEGREE) for f in faces)

        self.energy = on_patches(adhesive_energy(body.u, foot(self.function), stiffness))
        self.iterate = Iterate(self.function)
        self.tangent_correction = on_patches(mixed_point_correction(
            separation, [stiffness] * 3, self.function, self.iterate.last, self.iterate.step
        ))

    def shared(self, of: int) -> SharedUnknowns:
        """Return whose unknowns the cells share; ``of`` is the ribs' block."""
        masters = [self._ribs.owned(self._ribs.end_dofs(kind, rib))
                   for kind, rib, _ in self._groups]
        return SharedUnknowns(of, masters, [cells for *_, cells in self._groups])
