"""The pantographic rib as a chain of one cell's solid, condensed to a link."""

from __future__ import annotations

from typing import Any

from .linked_ribs import LinkedRibs
from .rib import Rib

AROUND = {"cell": 24}
"""Elements around a cylinder: one cell may be finer than a whole rib."""


class CondensedRib(Rib):
    """A rib whose cells are all one, cut out of half a solid, in small strains.

    ``Rib(..., fidelity="cell")`` makes one. As in the solid the root section is clamped, the tail
    section moves as a rigid plate, and nothing leaves the plane of the bars; where ``planar`` is
    False it may, which takes as much condensing again. A load takes milliseconds once root, cell
    and tail are condensed. The field is the motion of the axis.
    """

    planar = True
    _around = AROUND
    _element = "root, cell and tail condensed, P2 in curved tetrahedra"

    def _made(self) -> LinkedRibs:
        return LinkedRibs(self.comm, self.geometry, self.material, self.around, clamped=True,
                          planar=self.planar, prefix=self._options_prefix + "factor_")

    def description(self) -> dict[str, Any]:
        """Return all parameters, for `summary.json`."""
        return super().description() | {"mesh_dofs": self.ribs.mesh_dofs}
