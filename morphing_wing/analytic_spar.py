r"""The paper's formulas for the spar (Eqs 6-12).

A cell bends by :math:`\theta` about the middle of the middle layer; its top, middle and side layers
and the wall between two chambers take the stretches

.. math:: \lambda_t = 1 + 2 h\theta/l, \quad \lambda_m = \lambda_{s2} = 1 + h\theta/l, \quad
    \lambda_{s1} = 1 + K (\lambda_t - 1) .

Their energies in pure shear and that of the bent top balance the work of the pressure on the
envelope's change of volume,

.. math:: 1.5\, h^2 w \, P(\theta) = \sum_i V_i \frac{d W(\lambda_i)}{d\theta}
    + \frac{E h_t^3 w}{12 (1 - \nu^2) l}\, \theta, \qquad \varphi_1 = N \theta ,

half as much again as the cavity's own change of volume (Eq 10).
"""

from __future__ import annotations

import numpy as np
from scipy.optimize import brentq

from morphing_wing.geometry.spar import SparGeometry
from morphing_wing.materials import Yeoh

__all__ = ["SparFormula"]

_TURNS = np.linspace(0.0, 0.5, 501)
"""Turns of a cell in radians between which an equilibrium is looked for."""


class SparFormula:
    """Pressure in the upper chambers, and what it does.

    Parameters
    ----------
    geometry, material
        As a spar has them.

    Attributes
    ----------
    largest_pressure
        In MPa: the formula's limit point, or what turns a cell by half a radian.
    """

    def __init__(self, geometry: SparGeometry, material: Yeoh) -> None:
        g = geometry
        self._n, self._coefficients = g.n_cells, material.coefficients
        h = g.top_thickness + g.cavity_height + g.middle_thickness / 2
        length, w = g.pitch, g.width
        wall = g.wall_length * g.cavity_height * g.cavity_width
        K = g.cavity_length / wall * (
            g.top_thickness * w + 0.5 * g.middle_thickness * g.cavity_width
            + (2 * h - g.top_thickness) * g.side_thickness)
        # Of top, wall between chambers, sides and middle: volume, and stretch per turn.
        self._volumes = np.array([
            g.top_thickness * length * w, wall,
            2 * g.side_thickness * length * (2 * h - g.top_thickness),
            g.middle_thickness * length * g.cavity_width])
        self._rates = h / length * np.array([2.0, 2.0 * K, 1.0, 1.0])
        modulus, nu = 6 * material.coefficients[0], 0.5
        self._bending = modulus * g.top_thickness**3 * w / (12 * (1 - nu**2) * length)
        self._swept = 1.5 * h**2 * w
        pressures = self.pressure(_TURNS)
        rising = np.flatnonzero(np.diff(pressures) <= 0.0)
        last = rising[0] + 1 if len(rising) else len(pressures)
        self._pressures = pressures[:last]
        self.largest_pressure = float(self._pressures[-1])

    def pressure(self, turn: float | np.ndarray) -> float | np.ndarray:
        """Return the pressure in MPa that holds each turn of a cell, in radians (Eq 12)."""
        stretch = 1.0 + np.multiply.outer(turn, self._rates)
        beyond = stretch**2 + stretch**-2 - 2.0  # I1 - 3
        slope = sum(i * c * beyond ** (i - 1) for i, c in enumerate(self._coefficients, start=1))
        layers = slope * 2.0 * (stretch - stretch**-3) * self._rates @ self._volumes
        return (layers + self._bending * turn) / self._swept

    def turn(self, pressure: float) -> float:
        """Return the turn of a cell in radians under a pressure in MPa of at least 0.

        Not a number past the largest pressure.
        """
        above = int(np.searchsorted(self._pressures, pressure))
        if above == len(self._pressures):
            return float("nan")
        if above == 0:
            return 0.0
        return brentq(lambda turn: self.pressure(turn) - pressure, *_TURNS[above - 1 : above + 1],
                      xtol=1e-14)

    def angle(self, pressure: float) -> float:
        """Return phi_1 in degrees under a pressure in MPa of at least 0; nan past the largest."""
        return float(np.degrees(self._n * self.turn(pressure)))

    def stretches(self, turn: float) -> np.ndarray:
        """Return the stretches of top, wall between chambers, sides and middle at a cell's turn."""
        return 1.0 + turn * self._rates

    def stiffness_left(self, turn: float) -> float:
        """Return dP/dtheta at a turn in radians over that at rest: 0 at the limit point."""
        step = 1e-5
        at, rest = (self.pressure(t + step) - self.pressure(t - step) for t in (turn, 0.0))
        return float(at / rest)

    def energy(self, turn: float) -> float:
        """Return the stored energy in N mm of all cells at a turn of each, in radians."""
        stretch = 1.0 + turn * self._rates
        beyond = stretch**2 + stretch**-2 - 2.0
        density = sum(c * beyond**i for i, c in enumerate(self._coefficients, start=1))
        return self._n * float(density @ self._volumes + 0.5 * self._bending * turn**2)
