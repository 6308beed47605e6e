"""Cross-sections of bars: areas, moments and the six stiffnesses of a Timoshenko beam."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Protocol

import numpy as np


class Section(Protocol):
    """Anything with an area that turns Young's modulus and Poisson's ratio into a stiffness."""

    @property
    def area(self) -> float:
        """Area of the cross-section in mm^2."""

    def stiffness(self, E: float, nu: float) -> np.ndarray:
        """Return EA, GA2, GA3 in N and GJ, EI2, EI3 in N mm^2, shape (6,)."""


@dataclass(frozen=True)
class Rectangle:
    """A rectangle, ``width`` mm along the second local axis, ``depth`` mm along the third."""

    width: float
    depth: float

    @property
    def area(self) -> float:
        """Area in mm^2."""
        return self.width * self.depth

    def stiffness(self, E: float, nu: float) -> np.ndarray:
        """Return the beam's stiffness with shear factor 5/6 and Saint-Venant's torsion."""
        G, A = E / (2.0 * (1.0 + nu)), self.area
        I2, I3 = self.width * self.depth**3 / 12.0, self.depth * self.width**3 / 12.0
        shear, J = 5.0 / 6.0 * G * A, torsion_constant(self.width, self.depth)
        return np.array([E * A, shear, shear, G * J, E * I2, E * I3])


@dataclass(frozen=True)
class Circle:
    """A full circle of ``diameter`` mm."""

    diameter: float

    @property
    def area(self) -> float:
        """Area in mm^2."""
        return np.pi * self.diameter**2 / 4.0

    def stiffness(self, E: float, nu: float) -> np.ndarray:
        """Return the beam's stiffness with shear factor 6 (1 + nu)/(7 + 6 nu).

        The factor is Cowper's, Journal of Applied Mechanics 33 (1966) 335-340.
        """
        G, A = E / (2.0 * (1.0 + nu)), self.area
        I = np.pi * self.diameter**4 / 64.0  # noqa: E741
        shear = 6.0 * (1.0 + nu) / (7.0 + 6.0 * nu) * G * A
        return np.array([E * A, shear, shear, G * 2.0 * I, E * I, E * I])


@dataclass(frozen=True)
class Stiffened:
    """A nearly rigid piece: forces ``force`` times, moments ``moment`` times those of ``of``.

    Forces are raised less than moments: rounding of the residual grows with the largest axial
    stiffness, while only bending and torsion of such short pieces matter.
    """

    of: Section
    force: float = 100.0
    moment: float = 1000.0

    @property
    def area(self) -> float:
        """Area in mm^2 of the piece itself."""
        return self.of.area

    def stiffness(self, E: float, nu: float) -> np.ndarray:
        """Return the raised stiffness."""
        return self.of.stiffness(E, nu) * np.repeat([self.force, self.moment], 3)


def torsion_constant(width: float, depth: float) -> float:
    r"""Return Saint-Venant's torsion constant of a rectangle, in mm^4.

    .. math:: J = a b^3 \Big(\frac13 - \frac{64}{\pi^5} \frac{b}{a}
        \sum_{k = 1, 3, \dots} \frac{\tanh(k \pi a / 2 b)}{k^5}\Big), \qquad a \ge b

    (Timoshenko, Goodier: Theory of Elasticity, art. 109.)
    """
    a, b = max(width, depth), min(width, depth)
    k = np.arange(1, 60, 2)
    series = np.sum(np.tanh(k * np.pi * a / (2.0 * b)) / k**5)
    return float(a * b**3 * (1.0 / 3.0 - 64.0 / np.pi**5 * b / a * series))
