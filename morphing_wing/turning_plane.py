"""A mirror plane of a structure that repeats itself and bends: its turn is an unknown."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from . import compat
from .elastomer import Elastomer
from .forms.turning_plane import plane_energy, turned_z
from .shared_numbers import SharedNumbers
from .system import EquilibriumSystem

STIFFER = 1e5
"""Times a cube of the body as long as the plane's distance: it gives way by 1e-5 of the strain."""


class TurningPlane:
    """The plane of a face that looked along z, see `morphing_wing.forms.turning_plane`.

    Parameters
    ----------
    body
        The elastomer.
    face
        Name of its face.
    distance
        From z = 0 at rest, mm.
    chambers
        Names of the faces of chambers that the plane cuts open, so that their pressure works on it.

    Attributes
    ----------
    energy
        UFL functional.
    cut
        Normal and distance in UFL, see `Chambers`.
    own_blocks, seen_blocks
        Of turn and shift, see `SharedNumbers`.
    """

    def __init__(
        self, body: Elastomer, face: str, distance: float, chambers: Sequence[str]
    ) -> None:
        cells = np.unique(np.concatenate([body.faces.cells(name) for name in (face, *chambers)]))
        self._at_rest = distance
        self._numbers = [SharedNumbers(body.mesh, [cells], name) for name in ("turn", "shift")]
        turn, shift = (number.seen for number in self._numbers)
        # Constants, so that another geometry or material of this kind compiles nothing.
        stiffness, at_rest = (compat.constant(body.mesh, value) for value in (
            STIFFER * body.material.shear_modulus / distance, distance))
        self.cut = (turned_z(turn), at_rest + shift)
        self.energy = body.on_face(face, plane_energy(stiffness, *self.cut, body.X + body.u))
        self.own_blocks, self.seen_blocks = (
            list(blocks) for blocks in zip(*(n.blocks for n in self._numbers), strict=True))

    def number(self, system: EquilibriumSystem) -> None:
        """Let the body see turn and shift, once a system has numbered them."""
        for number in self._numbers:
            number.number(system)

    @property
    def turn(self) -> float:
        """Turn about x in radians, positive when the face then looks down. Collective."""
        return float(self._numbers[0].values[0, 0])

    @property
    def distance(self) -> float:
        """Distance in mm of the plane from the origin. Collective."""
        return self._at_rest + float(self._numbers[1].values[0, 0])
