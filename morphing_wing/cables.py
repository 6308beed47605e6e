"""The cables at the ribs' tails."""

from __future__ import annotations

from collections.abc import Sequence

from . import compat
from .bar_mesh import BarMesh
from .forms.beam import displacement
from .forms.cable import cable_potential
from .solid_ribs import SolidRibs

__all__ = ["Cables"]


class Cables:
    """A cable from the tail of each rib to a fixed guide point, all under one constant tension.

    Parameters
    ----------
    ribs
        The ribs.
    guide
        The guide points, each seen from its undeformed tail, mm.

    Attributes
    ----------
    tension
        The constant in N that carries the load.
    potential
        UFL functional in N mm.
    """

    def __init__(self, ribs: BarMesh | SolidRibs, guide: Sequence[float]) -> None:
        self._comm = ribs.comm
        self.tension = compat.constant(ribs.motion_mesh, 0.0)
        place = compat.constant(ribs.motion_mesh, guide)
        length = cable_potential(1.0, displacement(ribs.motion), place)
        self.potential = ribs.at_ends("tail", self.tension * length)
        self._length = compat.form(ribs.at_ends("tail", length))

    def shortening(self) -> float:
        """Return minus the length of all cables in mm: what the tension does work on."""
        return -compat.assemble_scalar(self._comm, self._length)
