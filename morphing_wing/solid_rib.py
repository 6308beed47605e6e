"""The pantographic rib as a solid."""

from __future__ import annotations

from .drawing import Drawing, default_drawing
from .path import State
from .rib import Rib
from .solid_ribs import SolidRibs

AROUND = {"standard": 12, "reference": 18}
"""Elements around a cylinder of each rung's mesh."""


class SolidRib(Rib):
    """One half of the rib, by symmetry at its middle layer, in second-order tetrahedra.

    ``Rib(..., fidelity="standard")`` and "reference" make one. Its root section is clamped, its
    tail section moves as a rigid plate.
    """

    multiplicity = 2
    _around = AROUND
    _element = "P2, curved tetrahedra"

    def _made(self) -> SolidRibs:
        return SolidRibs(self.comm, self.geometry, self.material, self.around,
                         half=True, clamped=True)

    def drawing(self, state: State) -> Drawing:
        """Return how to draw the present state."""
        return default_drawing(self)
