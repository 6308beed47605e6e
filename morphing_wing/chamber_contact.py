"""What may touch in the chambers: under suction, each ceiling and the floor below it."""

from __future__ import annotations

import numpy as np

from .chambers import ROWS
from .contact import Contact, Opposed
from .elastomer import Elastomer
from .surface import Surface

STIFFNESS = 20.0
"""Contact pressure per penetration, N/mm^3."""

SOFT = 0.005
"""Penetration in mm over which contact begins softly."""

_CEILING, _FLOOR = 1, 4
"""Which facets of a cell look down and up: y- and y+."""


def in_chambers(body: Elastomer) -> Contact:
    """Return the contact of the ceilings of each row of chambers with the floors of that row."""
    sides = []
    for face in ROWS.values():
        pairs = body.grid.facets[face]
        ceiling, floor = (Surface(body, pairs[pairs[:, 1] == facet])
                          for facet in (_CEILING, _FLOOR))
        radius = np.zeros(len(ceiling.area))
        sides.append(Opposed(ceiling.nodes, floor, ceiling.area, radius))
    return Contact(body.comm, sides, STIFFNESS, SOFT)
