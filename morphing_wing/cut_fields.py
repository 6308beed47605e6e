r"""Displacements that the two cut bars of half a rib may have: quadratic in each section.

With the coordinates a and :math:`\zeta` of a section (`morphing_wing.geometry.rib_cell.Cut`) each
component is a sum of :math:`1, a, \zeta, a^2, a\zeta, \zeta^2`; where the section is halved by
z = 0, x and y are even in :math:`\zeta` and z is odd. The coefficients of both bars, in mm, are
`SIZE` numbers.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from .geometry.rib_cell import HALF, Cut

_MONOMIALS = [(0, 0), (1, 0), (0, 1), (2, 0), (1, 1), (0, 2)]

COLUMNS = [(layer, m, axis) for layer in HALF for m in _MONOMIALS for axis in range(3)
           if layer == 1 or m[1] % 2 == (axis == 2)]
"""Layer, powers of a and zeta, and axis of each coefficient."""

SIZE = len(COLUMNS)


def fields(cut: Cut, places: np.ndarray) -> np.ndarray:
    """Return what each coefficient moves in places (k, 3) of a section, shape (k, 3, `SIZE`)."""
    a, zeta = cut.coordinates(places).T
    found = np.zeros((len(places), 3, SIZE))
    for column, (layer, m, axis) in enumerate(COLUMNS):
        if layer == cut.layer:
            found[:, axis, column] = a ** m[0] * zeta ** m[1]
    return found


def shift(axis: int) -> np.ndarray:
    """Return the coefficients of a unit translation along an axis."""
    return _coefficients({layer: {(0, 0): np.eye(3)[axis]} for layer in HALF})


def turn(cuts: Sequence[Cut], centre: Sequence[float]) -> np.ndarray:
    """Return the coefficients of a small unit turn about z through a centre, in mm per radian.

    Parameters
    ----------
    cuts
        Those of both layers.
    centre
        x, y and z in mm.
    """
    return _coefficients({
        cut.layer: {(0, 0): _quarter(cut.place - centre),
                    (1, 0): _quarter(cut.half_width * cut.across)} for cut in cuts})


def _quarter(v: np.ndarray) -> np.ndarray:
    return np.array([-v[1], v[0], 0.0])


def _coefficients(vectors: dict[int, dict[tuple[int, int], Any]]) -> np.ndarray:
    """Return coefficients from the vector of each layer's monomials, zero where there is none."""
    return np.array([vectors[layer].get(m, np.zeros(3))[axis] for layer, m, axis in COLUMNS])
