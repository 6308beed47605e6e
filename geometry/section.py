"""Cross-sections of bars: areas, moments and the six stiffnesses of a Timoshenko beam."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Protocol

import numpy as np

Array = np.ndarray

class Section(Protocol):
    """Anything with an area that turns Young's modulus and Poisson's ratio into a stiffness."""

    @property
    def area(self) -> float:
        """Area of the cross-section in mm^2."""

    def stiffness(self, E: float, nu: float) -> np.ndarray:
        """Return EA, GA2, GA3 in N and GJ, EI2, EI3 in N mm^2, shape (6,)."""

    def largest_stress(self, N: Array, T: Array, M2: Array, M3: Array) -> Array:
        """Return von Mises' largest stress in MPa of N (N) and the moments T, M2, M3 (N mm)."""


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

    def largest_stress(self, N: Array, T: Array, M2: Array, M3: Array) -> Array:
        """Return the stress of a corner with the shear stress of the longer side: a bound."""
        A, W2, W3 = self.width * self.depth, self.depth / 6.0, self.width / 6.0
        normal = (np.abs(N) + np.abs(M2) / W2 + np.abs(M3) / W3) / A
        shear = np.abs(T) / torsion_modulus(self.width, self.depth)
        return np.sqrt(normal**2 + 3.0 * shear**2)


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

    def largest_stress(self, N: Array, T: Array, M2: Array, M3: Array) -> Array:
        """Return the stress on the circumference, where the two moments act as one."""
        A, W = np.pi * self.diameter**2 / 4.0, np.pi * self.diameter**3 / 32.0
        normal = np.abs(N) / A + np.hypot(M2, M3) / W
        return np.sqrt(normal**2 + 3.0 * (T / (2.0 * W)) ** 2)


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

    def largest_stress(self, N: Array, T: Array, M2: Array, M3: Array) -> Array:
        """Return 0: where bars meet there is a solid knot, in which beam theory says nothing."""
        return np.zeros_like(N)


@dataclass(frozen=True)
class Lattice:
    """What a link of many bars has in common with a bar: no stiffness that a section could tell.

    ``area`` is their volume over the link's length in mm^2, ``height`` from face to face in mm.
    """

    area: float
    height: float


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


def torsion_modulus(width: float, depth: float) -> float:
    r"""Return the twisting moment over the largest shear stress of a rectangle, in mm^3.

    .. math:: \frac{T}{\tau} = \frac{J}{b} \Big(1 - \frac{8}{\pi^2}
        \sum_{k = 1, 3, \dots} \frac{1}{k^2 \cosh(k \pi a / 2 b)}\Big)^{-1}, \qquad a \ge b

    (Timoshenko, Goodier: Theory of Elasticity, art. 109.)
    """
    a, b = max(width, depth), min(width, depth)
    k = np.arange(1, 20, 2)
    series = np.sum(1.0 / (k**2 * np.cosh(k * np.pi * a / (2.0 * b))))
    return torsion_constant(width, depth) / b / float(1.0 - 8.0 / np.pi**2 * series)
