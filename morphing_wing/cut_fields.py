r"""Displacements that the two cut bars of half a rib may have: quadratic in each section.

With the coordinates a and :math:`\zeta` of a section (`morphing_wing.geometry.rib_cell.Cut`) each
component is a sum of :math:`1, a, \zeta, a^2, a\zeta, \zeta^2`. Where the section is halved by
z = 0, x and y are even in :math:`\zeta` and z is odd in fields that the mirror z = 0 leaves as they
are (`MIRRORED`), and the other way round in those that it reverses (`REVERSED`); any field of the
whole rib is a sum of both.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from .geometry.rib_cell import HALF, Cut

MIRRORED, REVERSED = 0, 1
"""The two parities of a field."""

_MONOMIALS = [(0, 0), (1, 0), (0, 1), (2, 0), (1, 1), (0, 2)]

COLUMNS = tuple(
    [(layer, m, axis) for layer in HALF for m in _MONOMIALS for axis in range(3)
     if layer == 1 or (m[1] + parity) % 2 == (axis == 2)] for parity in (MIRRORED, REVERSED))
"""Of each parity the layer, powers of a and zeta, and axis of each coefficient, which is in mm."""

HELD = ((2,), (0, 1))
"""Axes along which fields of each parity move nothing at z = 0."""


def fields(cut: Cut, places: np.ndarray, parity: int = MIRRORED) -> np.ndarray:
    """Return what each coefficient moves in places (k, 3) of a section, shape (k, 3, columns)."""
    a, zeta = cut.coordinates(places).T
    found = np.zeros((len(places), 3, len(COLUMNS[parity])))
    for column, (layer, m, axis) in enumerate(COLUMNS[parity]):
        if layer == cut.layer:
            found[:, axis, column] = a ** m[0] * zeta ** m[1]
    return found


def rigid(cuts: Sequence[Cut], centre: Sequence[float], parity: int = MIRRORED) -> np.ndarray:
    """Return the coefficients of the rigid motions of a parity, shape (columns, 3).

    Those are translations along x and y in mm and a small turn about z in radians, or a translation
    along z and turns about x and y.

    Parameters
    ----------
    cuts
        Those of both layers.
    centre
        x, y and z in mm of the point about which sections turn.
    parity
        `MIRRORED` or `REVERSED`.
    """
    still, (x, y, z) = np.zeros(3), np.eye(3)
    motions = ((x, still), (y, still), (still, z)) if parity == MIRRORED else (
        (z, still), (still, x), (still, y))

    def moved(cut: Cut, by: np.ndarray, turn: np.ndarray) -> dict[tuple[int, int], np.ndarray]:
        return {(0, 0): by + np.cross(turn, cut.place - centre),
                (1, 0): np.cross(turn, cut.half_width * cut.across),
                (0, 1): np.cross(turn, cut.half_depth * z)}

    return np.array([_coefficients({cut.layer: moved(cut, *motion) for cut in cuts}, parity)
                     for motion in motions]).T


def _coefficients(vectors: dict[int, dict[tuple[int, int], Any]], parity: int) -> np.ndarray:
    """Return coefficients from the vector of each layer's monomials, zero where there is none."""
    return np.array([vectors[layer].get(m, np.zeros(3))[axis]
                     for layer, m, axis in COLUMNS[parity]])
