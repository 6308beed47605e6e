r"""The paper's formulas for the spar (Eqs 6-12), of one spar or of millions at once.

A cell bends by :math:`\theta` about the middle of the middle layer; its top, middle and side layers
and the wall between two chambers take the stretches

.. math:: \lambda_t = 1 + 2 h\theta/l, \quad \lambda_m = \lambda_{s2} = 1 + h\theta/l, \quad
    \lambda_{s1} = 1 + K (\lambda_t - 1) .

Their energies in pure shear and that of the bent top balance the work of the pressure on the
envelope's change of volume,

.. math:: 1.5\, h^2 w \, P(\theta) = \sum_i V_i \frac{d W(\lambda_i)}{d\theta}
    + \frac{E h_t^3 w}{12 (1 - \nu^2) l}\, \theta, \qquad \varphi_1 = N \theta ,

half as much again as the cavity's own change of volume (Eq 10). With
:math:`W = \sum_i C_{i0} x^i`, :math:`x = \lambda^2 + \lambda^{-2} - 2`, P is concave in
:math:`\theta` where no coefficient after the first is positive: then
:math:`x^{i-1} dx/d\lambda` is convex for i > 1 and concave for i = 1.
"""

from __future__ import annotations

from dataclasses import fields
from functools import cached_property
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from morphing_wing.broadcast_formula import (
    COUNT,
    FINITE,
    POSITIVE,
    BroadcastFormula,
    Values,
)
from morphing_wing.complex_step import complex_step
from morphing_wing.geometry.spar import SparGeometry
from morphing_wing.materials import Yeoh
from morphing_wing.rising_branch import first_crossing, first_peak

__all__ = ["SparFormula"]

LARGEST_TURN = 0.5
"""Of a cell, in radians: what is looked for an equilibrium."""

_LENGTHS = tuple(field.name for field in fields(SparGeometry)[:7])


class SparFormula(BroadcastFormula):
    """Pressure in the upper chambers, and what it does.

    Parameters
    ----------
    geometry, material
        As a spar has them.
    **changes
        Arrays, of any shapes that broadcast with each other and with the loads, that take the place
        of the geometry's lengths in mm, of ``n_cells``, or of the material's ``C10``, ``C20``, ...
        in MPa. Results have the common shape; without changes and with a number for a load, they
        are numbers.

    Examples
    --------
    >>> import numpy as np
    >>> from morphing_wing.materials import DRAGON_SKIN_30
    >>> spars = SparFormula(SparGeometry.validation(), DRAGON_SKIN_30,
    ...                     top_thickness=np.array([1.0, 1.2, 1.4]))
    >>> spars.angle(0.02).round(3)
    array([16.968, 15.063, 13.5  ])
    """

    def __init__(self, geometry: SparGeometry, material: Yeoh, **changes: ArrayLike) -> None:
        values = {name: getattr(geometry, name) for name in (*_LENGTHS, "n_cells")}
        values |= {f"C{i}0": c for i, c in enumerate(material.coefficients, start=1)}
        rules = {name: ("mm", POSITIVE) for name in _LENGTHS} | {
            "n_cells": ("", COUNT), "C10": ("MPa", POSITIVE)}
        super().__init__(values, changes, {name: ("MPa", FINITE) for name in values} | rules)

    @cached_property
    def largest_pressure(self) -> np.ndarray:
        """In MPa: the formula's limit point, or what turns a cell by half a radian."""
        return self.pressure(self._over(lambda v: (first_peak(*_curve(v)),))[0])

    def pressure(self, turn: ArrayLike) -> np.ndarray:
        """Return the pressure in MPa that holds each turn of a cell, in radians (Eq 12)."""
        return self._over(lambda v, turn: (_pressure(v, turn)[0],), turn)[0]

    def turn(self, pressure: ArrayLike) -> np.ndarray:
        """Return the turn of a cell in radians on the first rising branch.

        Parameters
        ----------
        pressure
            In MPa, at least 0.

        Returns
        -------
        Array, nan past `largest_pressure` and for pressures below 0.
        """
        return self._over(lambda v, pressure: (_turn(v, pressure),), pressure)[0]

    def angle(self, pressure: ArrayLike) -> np.ndarray:
        """Return phi_1 in degrees, nan where `turn` is."""
        return np.degrees(self._values["n_cells"] * self.turn(pressure))

    def stretches(self, turn: ArrayLike) -> np.ndarray:
        """Return the stretches at a cell's turn in radians.

        Returns
        -------
        Array with a last axis of 4: top, wall between chambers, sides, middle.
        """
        def found(v: Values, turn: np.ndarray) -> tuple[np.ndarray, ...]:
            return tuple(1.0 + rate * turn for rate in _cell(v).rates)

        top, wall, sides = self._over(found, turn)
        return np.stack([top, wall, sides, sides], axis=-1)

    def stiffness_left(self, turn: ArrayLike) -> np.ndarray:
        """Return dP/dtheta at a turn in radians over that at rest: 0 at the limit point."""
        def found(v: Values, turn: np.ndarray) -> tuple[np.ndarray]:
            return (_pressure(v, turn)[1] / _pressure(v, np.zeros_like(turn))[1],)

        return self._over(found, turn)[0]

    def energy(self, turn: ArrayLike) -> np.ndarray:
        """Return the stored energy in N mm of all cells at a turn of each, in radians."""
        def found(v: Values, turn: np.ndarray) -> tuple[np.ndarray]:
            cell = _cell(v)
            total = 0.5 * cell.bending * turn**2
            for volume, rate in zip(cell.volumes, cell.rates, strict=True):
                x = _stretched(rate * turn)[0]
                total = total + volume * x * _polynomial(_coefficients(v), x)
            return (v["n_cells"] * total,)

        return self._over(found, turn)[0]

    def derivatives(self, pressure: ArrayLike) -> dict[str, np.ndarray]:
        r"""Return the derivatives of phi_1 with respect to the pressure and to every parameter.

        Exact to rounding: :math:`P(\theta, q)` is derived by the complex step, and
        :math:`\theta(P, q)` by the implicit function theorem,
        :math:`\partial \theta / \partial q = - P_q / P_\theta`.

        Parameters
        ----------
        pressure
            In MPa, at least 0.

        Returns
        -------
        dict
            Arrays by name, in degrees per MPa (``pressure``, ``C10``, ...), per mm, and per cell
            (``n_cells``, as if it were no whole number); nan where `turn` is.
        """
        names = list(self._values)

        def found(v: Values, pressure: np.ndarray) -> tuple[np.ndarray, ...]:
            turn = _turn(v, pressure)
            per_pressure = v["n_cells"] / _pressure(v, turn)[1]
            parts = [per_pressure]
            for name in names:
                if name == "n_cells":
                    parts.append(turn)
                else:
                    by = complex_step(lambda w: _pressure(w, turn, slope=False)[0], v, name)
                    parts.append(-by * per_pressure)
            return tuple(np.degrees(part) for part in parts)

        return dict(zip(["pressure", *names], self._over(found, pressure), strict=True))


class _Cell(NamedTuple):
    """Of top, wall between chambers, and sides with the middle: mm^3, and stretch per turn."""

    volumes: tuple[np.ndarray, ...]
    rates: tuple[np.ndarray, ...]
    bending: np.ndarray
    swept: np.ndarray


def _cell(v: Values) -> _Cell:
    top, middle, side = v["top_thickness"], v["middle_thickness"], v["side_thickness"]
    h = top + v["cavity_height"] + middle / 2
    length = v["cavity_length"] + v["wall_length"]
    w = v["cavity_width"] + 2 * side
    wall = v["wall_length"] * v["cavity_height"] * v["cavity_width"]
    sides = (2 * h - top) * side
    K = v["cavity_length"] / wall * (top * w + 0.5 * middle * v["cavity_width"] + sides)
    modulus, nu = 6 * v["C10"], 0.5
    rate = h / length
    return _Cell(
        volumes=(top * length * w, wall, length * (2 * sides + middle * v["cavity_width"])),
        rates=(2 * rate, 2 * K * rate, rate),
        bending=modulus * top**3 * w / (12 * (1 - nu**2) * length),
        swept=1.5 * h**2 * w)


def _pressure(
    v: Values, turn: np.ndarray, slope: bool = True, cell: _Cell | None = None,
) -> tuple[np.ndarray, np.ndarray]:
    """Return the pressure at each turn, and its slope by the turn."""
    cell = cell or _cell(v)
    slopes = [i * c for i, c in enumerate(_coefficients(v), start=1)]  # dW/dx and its own slope
    curvatures = [i * c for i, c in enumerate(slopes[1:], start=1)]
    force, stiffness = cell.bending * turn, cell.bending
    for volume, rate in zip(cell.volumes, cell.rates, strict=True):
        x, x_slope, x_curvature = _stretched(rate * turn)
        w_slope, weight = _polynomial(slopes, x), volume * rate
        force = force + weight * w_slope * x_slope
        if slope:
            stiffness = stiffness + weight * rate * (
                w_slope * x_curvature + _polynomial(curvatures, x) * x_slope**2)
    return force / cell.swept, stiffness / cell.swept


def _stretched(beyond: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return x = I1 - 3 of a stretch 1 + beyond in pure shear, and two derivatives, uncancelled."""
    g = beyond * (2.0 + beyond)  # the stretch's square is 1 + g
    inverse = 1.0 / (1.0 + g)
    squared = inverse * inverse
    return (g * g * inverse, 2.0 * (1.0 + beyond) * g * (2.0 + g) * squared, 2.0 + 6.0 * squared)


def _turn(v: Values, pressure: np.ndarray) -> np.ndarray:
    curve, last, concave = _curve(v)
    ends = np.full(pressure.shape, last)
    if not concave.all():
        ends = np.where(concave, ends, first_peak(curve, last, concave))
    return first_crossing(curve, pressure, ends, concave)


def _curve(v: Values) -> tuple[Any, float, np.ndarray]:
    """Return P and its slope over the turn, the turn's end, and whether P is known as concave."""
    cell = _cell(v)
    concave = np.ones(v["C10"].shape, dtype=bool)
    for c in _coefficients(v)[1:]:
        concave &= c <= 0.0
    return (lambda turn: _pressure(v, turn, cell=cell)), LARGEST_TURN, concave


def _coefficients(v: Values) -> list[np.ndarray]:
    return [value for name, value in v.items() if name[0] == "C"]


def _polynomial(coefficients: list[np.ndarray], x: np.ndarray) -> np.ndarray | float:
    total: np.ndarray | float = 0.0
    for c in reversed(coefficients):
        total = total * x + c
    return total

