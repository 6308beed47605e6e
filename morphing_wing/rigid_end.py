"""A face of a resin body on a rigid plate, whose translation and rotation are six unknowns."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
import ufl

from . import compat
from .forms.adhesive import foot_displacement
from .forms.mixed_point import mixed_point_correction
from .iterate import Iterate
from .resin_body import ResinBody
from .shared_numbers import SharedNumbers

STIFFNESS = 1e3
"""Of the layer between face and plate, N/mm^3 per MPa of Young's modulus: as stiff as a micrometre
of the resin, so that it takes 1e-5 of the angle."""


class RigidEnd:
    """The plate of a face.

    Parameters
    ----------
    body
        Has the face.
    face
        Its name.
    origin : (3,) array
        The point whose motion the translation is, mm.
    held
        Which of the six unknowns, three translations and three of the rotation vector, do not
        change.

    Attributes
    ----------
    blocks
        Of the six unknowns, and what stands for them on the body's cells; see `SharedNumbers`.
    motion
        The unknowns in UFL on a mesh of their own: mm, then the rotation vector.
    energy
        Of the layer between plate and face, a UFL functional in N mm.
    tangent_correction, iterate
        Bilinear form in the second block that makes the tangent robust, and the iterates of that.
    """

    def __init__(
        self, body: ResinBody, face: str, origin: np.ndarray, held: Sequence[int] = ()
    ) -> None:
        self._numbers = SharedNumbers(body.mesh, body.faces.cells(face), face, 6, held)
        self.blocks, self.motion = self._numbers.blocks, self._numbers.own
        self.mesh = self._numbers.mesh
        seen, place = self._numbers.seen, compat.constant(body.mesh, origin)
        self.iterate = Iterate(seen)
        u, before = body.function, body.iterate

        def separation(q: Any) -> Any:
            # Of the iterate before, with the face's part of the step to the present one.
            moved = u if q is seen else before.last + before.step
            t, theta = (ufl.as_vector([q[3 * k + i] for i in range(3)]) for k in range(2))
            return foot_displacement(body.X, place, t, theta) - moved

        k = compat.constant(body.mesh, STIFFNESS * body.material.E)
        gap = separation(seen)
        self.energy = body.on_face(face, 0.5 * k * ufl.inner(gap, gap))
        self.tangent_correction = body.on_face(face, mixed_point_correction(
            lambda q: [separation(q)[i] for i in range(3)], [k] * 3, seen, self.iterate.last,
            self.iterate.step))

    def join(self, system: Any) -> None:
        """Tell the system whose unknowns the body's cells see. Collective."""
        self._numbers.number(system)

    def at(self, integrand: Any) -> Any:
        """Return an integrand of `motion` and of constants on `mesh` as a UFL functional."""
        return integrand * self._numbers.measure

    def values(self) -> np.ndarray:
        """Return translation in mm and rotation vector, (6,), on every rank. Collective."""
        return self._numbers.values
