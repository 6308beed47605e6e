r"""The paper's formulas for the rib (Eqs 13-18), dimensions mended.

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

import math

from morphing_wing.errors import require
from morphing_wing.geometry.rib import RibGeometry
from morphing_wing.materials import Elastic

__all__ = ["rib_compliance"]


def rib_compliance(geometry: RibGeometry, material: Elastic, consistent: bool = False) -> float:
    """Return phi_2 in degrees per N mm of moment at the tail (Eqs 17 and 18, mended).

    Parameters
    ----------
    geometry, material
        As a rib has them; ``bosses`` are not part of the formula.
    consistent
        Whether c is 6, from moments T, 2T, T, in place of the paper's 27/4.
    """
    require(geometry.layers == 3, "layers", geometry.layers, "", "3 for the paper's formulas")
    g, E, G = geometry, material.E, material.shear_modulus
    twisted = math.pi * g.pivot_diameter**4 / 32
    bent = twisted / 2
    shaft = E * g.shaft_thickness * g.shaft_width**3 / 12
    pivot = G * twisted / g.pivot_length
    k = 3 * pivot * g.shaft_length / (2 * shaft)
    rising = math.sin(math.radians(g.crossing_angle) / 2)
    leaning = 9 * E * bent * (g.shaft_length * rising) ** 2 / (2 * g.pivot_length**3)
    first = 1.0 / (3 * shaft / g.shaft_length + leaning / 16)
    c = 6.0 if consistent else 27.0 / 4.0
    other = (1 + k) ** 2 / (4 * pivot + c * pivot**2 * g.shaft_length / shaft + leaning)
    return math.degrees(first + (g.n_cells - 1) * other)
