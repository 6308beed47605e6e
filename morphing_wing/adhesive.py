"""Glued patches between an elastomer's facets and rigid feet, point by point."""

from __future__ import annotations

from typing import Any

import numpy as np
import ufl
from mpi4py import MPI

from . import compat
from .forms.adhesive import (
    adhesive_energy,
    damage,
    dissipated_energy,
    foot_displacement,
    separation_energies,
    used,
)
from .forms.beam import rotation
from .forms.mixed_point import mixed_point_correction
from .geometry.patches import PatchPoints
from .iterate import Iterate
from .materials import Adhesive
from .points import PointMesh
from .system import EquilibriumSystem


class GluedPatches:
    """The adhesive's energy over integration points; see `morphing_wing.forms.adhesive`.

    Parameters
    ----------
    comm
        Communicator.
    points
        Integration points of all patches; the same on every rank.
    origins : (n, 3) array
        Point of each one's foot that its translation is that of, mm.
    law
        Stiffness, and strength and fracture energy where it may fail.

    Attributes
    ----------
    block
        The points' unknowns: displacements of a facet's nodes, translation and rotation of a foot.
    energy, stored
        UFL functionals in N mm: the potential of the step, and what is stored in a converged state.
    tangent_correction, iterate
        Bilinear form that makes the tangent robust, and the iterates that it needs.
    damage
        Of glue that may fail: returns each point's damage, 0 to 1, on every rank. Collective.
    """

    def __init__(
        self, comm: MPI.Comm, points: PatchPoints, origins: np.ndarray, law: Adhesive
    ) -> None:
        self.law, self._all, self._comm = law, points, comm
        n, size = points.shapes.shape
        self.history = np.ones(n)
        self.utilisation = np.zeros(n)
        self._mesh = PointMesh(comm, n, 3 * size + 6, size + 11, "glue")
        self._mine = self._mesh.mine
        self._origins = origins[self._mine]
        self.function, self.block = self._mesh.function, self._mesh.block
        self.iterate = Iterate(self.function)
        self._give()
        data = self._mesh.data
        X, origin, normal = (ufl.as_vector([data[size + 3 * k + i] for i in range(3)])
                             for k in range(3))
        area, kappa = data[size + 9], data[size + 10]

        def foot(q: Any) -> tuple[Any, Any]:
            return tuple(ufl.as_vector([q[3 * size + 3 * k + i] for i in range(3)])
                         for k in range(2))

        def separation(q: Any) -> Any:
            u = ufl.as_vector([sum(data[a] * q[3 * a + i] for a in range(size)) for i in range(3)])
            return foot_displacement(X, origin, *foot(q)) - u

        s = separation(self.function)
        # Constants, so that another law compiles nothing.
        stiffness = compat.constant(self._mesh.mesh, law.stiffness)
        if not law.fails:
            self.energy = self.stored = self._mesh.sum(0.5 * stiffness * area * ufl.inner(s, s))
            sound: Any = 1.0
        else:
            shear, onset, last = (compat.constant(self._mesh.mesh, value) for value in
                                  (law.shear_stiffness, law.onset, law.last))
            turned = rotation(foot(self.function)[1]) * normal
            e, closing = separation_energies(s, turned, stiffness, shear)
            sound = 1.0 - damage(kappa, last)
            self.energy = self._mesh.sum(area * (adhesive_energy(e, kappa, onset, last) + closing))
            self.stored = self._mesh.sum(area * (sound * e + closing))
            self._lambda = self._mesh.each(used(e, onset))
            self.damage = self._mesh.each(damage(kappa, last))
            self._spent = compat.form(
                self._mesh.sum(area * dissipated_energy(kappa, onset, last)))
        self.tangent_correction = self._mesh.sum(mixed_point_correction(
            lambda q: [separation(q)[i] for i in range(3)], [sound * stiffness * area] * 3,
            self.function, self.iterate.last, self.iterate.step))

    def number(
        self, system: EquilibriumSystem, face_numbers: np.ndarray, foot_numbers: np.ndarray
    ) -> None:
        """Tell the system whose unknowns the points share. Collective.

        Parameters
        ----------
        system
            Has this object's block.
        face_numbers : (n, nodes of a facet, 3) array
            Numbers of the displacements of each point's facet.
        foot_numbers : (n, 6) array
            Numbers of translation and rotation of its foot.
        """
        rows = np.concatenate([face_numbers.reshape(len(face_numbers), -1), foot_numbers], axis=1)
        system.renumber(self.block, self._mesh.as_dofs(rows[self._mine]))

    # -- damage -------------------------------------------------------------------------------

    def accept(self) -> None:
        """Take the present state as converged: what broke stays broken. Collective."""
        if not self.law.fails:
            return
        self.utilisation = self._lambda()
        self.history = np.maximum(self.history, self.utilisation)
        self._give()

    def recall(self, history: np.ndarray) -> None:
        """Take over the ``history`` of an earlier run."""
        self.history = np.array(history, dtype=float)
        self._give()

    def dissipated(self) -> float:
        """Return the energy in N mm that the damage took. Collective."""
        return compat.assemble_scalar(self._comm, self._spent) if self.law.fails else 0.0

    def _give(self) -> None:
        part, points = self._mine, self._all
        self._mesh.set_data(np.concatenate(
            [points.shapes[part], points.place[part], self._origins, points.normal[part],
             points.area[part, None], self.history[part, None]], axis=1))
