r"""The paper's formulas for the rib (Eqs 13-18), dimensions mended, of one rib or of millions.

Eqs 14 and 17.2 as printed exchange a second moment and a length; from the energies, with
:math:`I_{cs} = \pi D^4/32`, :math:`I_{ms} = \pi D^4/64` and
:math:`k = 3 G I_{cs} l_{rs} / (2 E I_{rs} l_{cs})`, the cell at the root and all others turn by

.. math::
    \theta_1 &= M \Big/ \Big[ \frac{3 E I_{rs}}{l_{rs}} + S \Big/ 16 \Big], \qquad
    S = \frac{9 E I_{ms} l_{rs}^2 \sin^2(\alpha/2)}{2\, l_{cs}^3} , \\
    \theta_i &= M (1 + k)^2 \Big/ \Big[ \frac{4 G I_{cs}}{l_{cs}}
        + c\, \frac{G^2 I_{cs}^2 l_{rs}}{E I_{rs} l_{cs}^2} + S \Big], \qquad
    \varphi_2 = \theta_1 + (n - 1)\, \theta_i .

The paper's c is 27/4; moments T, 2T, T in the three shafts, which the energies themselves ask for,
make it 6. ``docs/rib_formula.md`` derives all of it.
"""

from __future__ import annotations

from dataclasses import fields

import numpy as np
from numpy.typing import ArrayLike

from morphing_wing.broadcast_formula import COUNT, POSITIVE, Allowed, BroadcastFormula, Values
from morphing_wing.complex_step import complex_step
from morphing_wing.errors import require
from morphing_wing.geometry.rib import RibGeometry
from morphing_wing.materials import Elastic

__all__ = ["RibFormula", "rib_compliance"]

_DIMENSIONS = tuple(field.name for field in fields(RibGeometry)[:6])
_RULES = {name: ("mm", POSITIVE) for name in _DIMENSIONS[:4]} | {
    "crossing_angle": ("degrees", Allowed(lambda v: (v > 0.0) & (v < 180.0),
                                          "between 0 and 180 degrees, both excluded")),
    "n_cells": ("", COUNT), "E": ("MPa", POSITIVE),
    "nu": ("", Allowed(lambda v: (v > -1.0) & (v < 0.5), "greater than -1 and less than 0.5"))}


class RibFormula(BroadcastFormula):
    """A moment at the tail, and what it does.

    Parameters
    ----------
    geometry, material
        As a rib has them; ``bosses`` are not part of the formula.
    consistent
        Whether c is 6, from moments T, 2T, T, in place of the paper's 27/4.
    **changes
        Arrays, of any shapes that broadcast with each other and with the moments, that take the
        place of the geometry's lengths in mm, ``crossing_angle`` in degrees, ``n_cells``, or the
        material's ``E`` in MPa and ``nu``. Results have the common shape; without changes and with
        a number for a moment, they are numbers.

    Examples
    --------
    >>> import numpy as np
    >>> from morphing_wing.materials import RESIN
    >>> ribs = RibFormula(RibGeometry.validation("square"), RESIN, crossing_angle=[80.0, 90.0])
    >>> ribs.angle(5.0).round(3)
    array([10.126,  9.707])
    """

    def __init__(
        self, geometry: RibGeometry, material: Elastic, consistent: bool = False,
        **changes: ArrayLike,
    ) -> None:
        require(geometry.layers == 3, "layers", geometry.layers, "", "3 for the paper's formulas")
        values = {name: getattr(geometry, name) for name in _DIMENSIONS}
        values |= {"E": material.E, "nu": material.nu}
        super().__init__(values, changes, _RULES)
        self._flush = geometry.section == "flush"
        self._factor = 6.0 if consistent else 27.0 / 4.0

    @property
    def compliance(self) -> np.ndarray:
        """phi_2 in degrees per N mm of moment."""
        return self._over(lambda v: (self._turn(v),))[0]

    def angle(self, torque: ArrayLike) -> np.ndarray:
        """Return phi_2 in degrees under moments in N mm."""
        return self.compliance * np.asarray(torque, dtype=float)

    def derivatives(self, torque: ArrayLike) -> dict[str, np.ndarray]:
        """Return the derivatives of phi_2 with respect to the moment and to every parameter.

        Exact to rounding, by the complex step.

        Parameters
        ----------
        torque
            In N mm.

        Returns
        -------
        dict
            Arrays by name, in degrees per N mm (``torque``), per MPa (``E``), per one (``nu``),
            per mm, per degree, and per cell (``n_cells``, as if it were no whole number).
        """
        names = list(self._values)

        def found(v: Values, torque: np.ndarray) -> tuple[np.ndarray, ...]:
            return (self._turn(v), *(torque * complex_step(self._turn, v, name) for name in names))

        return dict(zip(["torque", *names], self._over(found, torque), strict=True))

    def _turn(self, v: Values) -> np.ndarray:
        """Return phi_2 in degrees per N mm of each of a block's ribs."""
        E, length, diameter = v["E"], v["shaft_length"], v["pivot_diameter"]
        twisted = np.pi * diameter**4 / 32
        bent = twisted / 2
        width = diameter if self._flush else v["shaft_thickness"]
        shaft = E * v["shaft_thickness"] * width**3 / 12
        pivot = E / (2 * (1 + v["nu"])) * twisted / v["pivot_length"]
        k = 3 * pivot * length / (2 * shaft)
        rising = np.sin(np.pi / 360 * v["crossing_angle"])
        leaning = 9 * E * bent * (length * rising) ** 2 / (2 * v["pivot_length"] ** 3)
        first = 1.0 / (3 * shaft / length + leaning / 16)
        other = (1 + k) ** 2 / (4 * pivot + self._factor * pivot**2 * length / shaft + leaning)
        return 180 / np.pi * (first + (v["n_cells"] - 1) * other)


def rib_compliance(geometry: RibGeometry, material: Elastic, consistent: bool = False) -> float:
    """Return phi_2 in degrees per N mm of moment at the tail (Eqs 17 and 18, mended).

    Parameters
    ----------
    geometry, material, consistent
        See `RibFormula`.
    """
    return float(RibFormula(geometry, material, consistent).compliance)

