"""Faces of a resin body on rigid plates, whose translation and rotation are six unknowns each."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
import ufl
from dolfinx import fem

from . import compat
from .forms.adhesive import foot_displacement
from .forms.mixed_point import mixed_point_correction
from .iterate import Iterate
from .resin_body import ResinBody
from .shared_numbers import SharedNumbers

STIFFNESS = 1e3
"""Of the layer between face and plate, N/mm^3 per MPa of Young's modulus: as stiff as a micrometre
of the resin, so that it takes 1e-5 of the angle."""


class RigidEnds:
    """The plates of some faces.

    Parameters
    ----------
    body
        Has the faces.
    origins
        Of each face by name the point whose motion its plate's translation is, mm.
    held
        Which of the six unknowns of each plate, three translations and three of the rotation
        vector, do not change.

    Attributes
    ----------
    own_block, block
        Of the unknowns, and of what stands for them on the body's cells, a local one.
    motion, mesh
        The unknowns in UFL, mm and then the rotation vector, and their own mesh.
    energy
        Of the layer between plates and faces, a UFL functional in N mm.
    tangent_correction, iterate
        Bilinear form in ``block`` that makes the tangent robust, and the iterates that it needs.
    """

    def __init__(
        self, body: ResinBody, origins: Mapping[str, np.ndarray], held: Sequence[int] = ()
    ) -> None:
        cells = [body.faces.cells(face) for face in origins]
        self._names = list(origins)
        self._numbers = SharedNumbers(body.mesh, cells, "plates", 6, held)
        self.own_block, self.block = self._numbers.blocks
        self.motion, self.mesh = self._numbers.own, self._numbers.mesh
        seen = self._numbers.seen
        place = fem.Function(compat.discontinuous_space(body.mesh, 0, (3,)))
        for chosen, origin in zip(cells, origins.values(), strict=True):
            rows = [place.function_space.dofmap.cell_dofs(cell)[0] for cell in chosen]
            place.x.array.reshape(-1, 3)[rows] = origin
        self.iterate = Iterate(seen)
        u, before = body.function, body.iterate

        def separation(q: Any) -> Any:
            # Of the iterate before, with the face's part of the step to the present one.
            moved = u if q is seen else before.last + before.step
            t, theta = (ufl.as_vector([q[3 * k + i] for i in range(3)]) for k in range(2))
            return foot_displacement(body.X, place, t, theta) - moved

        k = compat.constant(body.mesh, STIFFNESS * body.material.E)
        gap, ds = separation(seen), body.measure_on(origins)
        self.energy = 0.5 * k * ufl.inner(gap, gap) * ds
        self.tangent_correction = mixed_point_correction(
            lambda q: [separation(q)[i] for i in range(3)], [k] * 3, seen, self.iterate.last,
            self.iterate.step) * ds

    def number(self, system: Any) -> None:
        """Tell the system whose unknowns the body's cells see. Collective."""
        self._numbers.number(system)

    def at(self, kind: str, integrand: Any) -> Any:
        """Return the sum of an integrand of `motion` over the plates whose names begin so."""
        chosen = [float(name.startswith(kind)) for name in self._names]
        return self._numbers.each(chosen) * integrand * self._numbers.measure

    def numbers(self, name: str) -> np.ndarray:
        """Return a system's numbers of a plate's motion, (6,), on every rank. Collective."""
        return self._numbers.numbers[self._names.index(name)]

    def values(self, name: str) -> np.ndarray:
        """Return translation in mm and rotation vector, (6,), on every rank. Collective."""
        return self._numbers.values[self._names.index(name)]

    def lumped_volume(self) -> np.ndarray:
        """Return the volume in mm^3 on each owned unknown: none."""
        return np.zeros(self.own_block.n_owned)
