"""Glue between ribs and elastomer: each rib end is a rigid foot on a patch of the elastomer."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import ufl
from dolfinx import fem

from . import compat
from .elastomer import Elastomer
from .forms.adhesive import adhesive_energy, foot_displacement
from .forms.beam import displacement, rotation_vector
from .forms.mixed_point import mixed_point_correction
from .frame import BeamFrame
from .geometry.hexmesh import HexMesh
from .geometry.wing import WingGeometry
from .iterate import Iterate
from .system import Block, SharedUnknowns

_QUADRATURE_DEGREE = 9  # patches need not end on mesh lines: many points resolve their edges


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
        low, high, origin = (fem.Function(vectors) for _ in range(3))
        roots = wing.rib_roots()
        tails = roots + np.array([wing.rib.length, 0.0, 0.0])
        ends = {"foot": ("root", roots), "bond": ("tail", tails)}
        faces = [face for face in ends if face in body.grid.facets]
        for face in faces:
            kind, points = ends[face]
            corners = body.grid.facet_points(face)
            for rib, box in enumerate(_boxes(wing, face)):
                chosen = (corners.min(axis=1) < box[1]) & (corners.max(axis=1) > box[0])
                cells = body.face_cells(face, chosen.all(axis=1))
                self._groups.append((kind, rib, cells))
                for function, value in ((low, box[0]), (high, box[1]), (origin, points[rib])):
                    table = function.x.array.reshape(-1, 3)
                    for cell in cells:
                        table[vectors.dofmap.cell_dofs(cell)[0]] = value
        inside = 1.0
        for i in range(3):
            between = ufl.And(ufl.gt(body.X[i], low[i]), ufl.lt(body.X[i], high[i]))
            inside = inside * ufl.conditional(between, 1.0, 0.0)
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
