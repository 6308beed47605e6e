"""What may touch in the hollow trailing edge: its two sides, and the ribs inside."""

from __future__ import annotations

import numpy as np

from .bar_mesh import BarMesh
from .contact import Contact, Opposed
from .elastomer import Elastomer
from .solid_ribs import SolidRibs
from .surface import Bars, Crests, Surface

STIFFNESS = 40.0
"""Contact pressure per penetration, N/mm^3."""


def in_pocket(body: Elastomer, ribs: BarMesh | SolidRibs | None) -> Contact:
    """Return the contact of the upper skin with the lower one, and of the ribs with both.

    Parameters
    ----------
    body
        Elastomer with faces ``pocket_upper`` and ``pocket_lower``.
    ribs
        The ribs, or None.
    """
    upper, lower = (Surface(body, body.grid.facets[f]) for f in ("pocket_upper", "pocket_lower"))
    sides = [Opposed(upper.nodes, lower, upper.area, np.zeros(len(upper.area)))]
    if ribs is not None:
        found = Bars(ribs) if isinstance(ribs, BarMesh) else Crests(ribs.body)
        sides += [Opposed(found.nodes, side, found.area, found.radius) for side in (lower, upper)]
    return Contact(body.comm, sides, STIFFNESS)
