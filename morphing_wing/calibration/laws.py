r"""Strain energies of incompressible rubber in the invariants; Ogden's stands in `ogden`.

A law gives the gradient and the Hessian of :math:`W(\lambda_1, \lambda_2, \lambda_3)`, taken as if
the stretches were independent; the pressure that keeps the volume drops out of what is asked here,
because one face is always free:

.. math:: P_1 = W_1 - \frac{\lambda_3}{\lambda_1} W_3 , \qquad W_i = \partial W/\partial\lambda_i ,

the nominal stress, force over the area at rest. Stresses and constants are in MPa.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from dataclasses import dataclass
from typing import Any

import numpy as np

from .deformation import principal

__all__ = ["Law", "MooneyRivlinLaw", "YeohLaw"]


class Law(ABC):
    """A strain energy with constants to be found."""

    @property
    @abstractmethod
    def name(self) -> str:
        """The law in words."""

    @property
    @abstractmethod
    def constants(self) -> tuple[str, ...]:
        """Names of the constants; those named alpha have no unit, the others are in MPa."""

    @abstractmethod
    def gradient(self, values: Any, stretches: np.ndarray) -> np.ndarray:
        """Return W_i in MPa at principal stretches, both of shape (..., 3)."""

    @abstractmethod
    def hessian(self, values: Any, stretches: np.ndarray) -> np.ndarray:
        """Return W_ij in MPa, of shape (..., 3, 3), at principal stretches of shape (..., 3)."""

    @abstractmethod
    def stress_slopes(self, values: Any, mode: str, stretch: np.ndarray) -> np.ndarray:
        """Return the nominal stress's derivatives by the constants, of shape (n, constants)."""

    @abstractmethod
    def shear_modulus(self, values: Any) -> float:
        """Return the shear modulus at rest in MPa."""

    @abstractmethod
    def neo_hooke(self, shear_modulus: float) -> np.ndarray:
        """Return constants of a law near neo-Hooke's of that shear modulus, stable everywhere."""

    @property
    def linear(self) -> bool:
        """Whether the stress is linear in the constants."""
        return True

    @property
    def units(self) -> tuple[str, ...]:
        """Units of the constants, ``""`` for none."""
        return tuple("" if name.startswith("alpha") else "MPa" for name in self.constants)

    def stress(self, values: Any, mode: str, stretch: Any) -> np.ndarray:
        """Return the nominal stress in MPa in a mode at stretches of any shape."""
        stretches = principal(mode, stretch)
        gradient = self.gradient(values, stretches)
        return gradient[..., 0] - stretches[..., 2] / stretches[..., 0] * gradient[..., 2]

    def _unit_stresses(self, mode: str, stretch: np.ndarray) -> np.ndarray:
        return np.stack([self.stress(unit, mode, stretch)
                         for unit in np.eye(len(self.constants))], axis=-1)


@dataclass(frozen=True)
class YeohLaw(Law):
    r"""Yeoh's law, one term of which is neo-Hooke's.

    .. math:: W = \sum_{i=1}^{n} C_{i0} (I_1 - 3)^i , \qquad I_1 = \sum_j \lambda_j^2

    (Yeoh 1993).

    Parameters
    ----------
    terms
        How many: 1, 2, 3, ...
    """

    terms: int

    @property
    def name(self) -> str:
        """The law in words."""
        return "neo-Hooke" if self.terms == 1 else f"Yeoh, {self.terms} terms"

    @property
    def constants(self) -> tuple[str, ...]:
        """C10, C20, ..."""
        return tuple(f"C{i}0" for i in range(1, self.terms + 1))

    def gradient(self, values: Any, stretches: np.ndarray) -> np.ndarray:
        """Return W_i = 2 lambda_i W'."""
        return 2.0 * self._slope(values, stretches)[..., None] * stretches

    def hessian(self, values: Any, stretches: np.ndarray) -> np.ndarray:
        """Return W_ij = 2 W' delta_ij + 4 lambda_i lambda_j W''."""
        slope, excess = self._slope(values, stretches), _excess(stretches)
        curvature = sum((i * (i - 1) * C * excess ** (i - 2)
                         for i, C in enumerate(values, start=1) if i > 1), np.zeros_like(excess))
        outer = stretches[..., :, None] * stretches[..., None, :]
        return 2.0 * slope[..., None, None] * np.eye(3) + 4.0 * curvature[..., None, None] * outer

    def stress_slopes(self, values: Any, mode: str, stretch: np.ndarray) -> np.ndarray:
        """Return the stress of each constant's unit."""
        return self._unit_stresses(mode, stretch)

    def shear_modulus(self, values: Any) -> float:
        """Return 2 C10."""
        return 2.0 * float(values[0])

    def neo_hooke(self, shear_modulus: float) -> np.ndarray:
        """Return C10 alone."""
        return np.array([0.5 * shear_modulus, *[0.0] * (self.terms - 1)])

    @staticmethod
    def _slope(values: Any, stretches: np.ndarray) -> np.ndarray:
        excess = _excess(stretches)
        return sum((i * C * excess ** (i - 1) for i, C in enumerate(values, start=1)),
                   np.zeros_like(excess))


@dataclass(frozen=True)
class MooneyRivlinLaw(Law):
    r"""Mooney and Rivlin's law.

    .. math:: W = C_{10} (I_1 - 3) + C_{01} (I_2 - 3) , \qquad I_2 = \sum_j \lambda_j^{-2}

    (Mooney 1940, Rivlin 1948; I2 as it is where the volume is kept).
    """

    @property
    def name(self) -> str:
        """The law in words."""
        return "Mooney-Rivlin"

    @property
    def constants(self) -> tuple[str, ...]:
        """C10 and C01."""
        return ("C10", "C01")

    def gradient(self, values: Any, stretches: np.ndarray) -> np.ndarray:
        """Return W_i = 2 C10 lambda_i - 2 C01 / lambda_i^3."""
        return 2.0 * values[0] * stretches - 2.0 * values[1] * stretches**-3

    def hessian(self, values: Any, stretches: np.ndarray) -> np.ndarray:
        """Return the diagonal 2 C10 + 6 C01 / lambda_i^4."""
        return (2.0 * values[0] + 6.0 * values[1] * stretches**-4)[..., None] * np.eye(3)

    def stress_slopes(self, values: Any, mode: str, stretch: np.ndarray) -> np.ndarray:
        """Return the stress of each constant's unit."""
        return self._unit_stresses(mode, stretch)

    def shear_modulus(self, values: Any) -> float:
        """Return 2 (C10 + C01)."""
        return 2.0 * float(values[0] + values[1])

    def neo_hooke(self, shear_modulus: float) -> np.ndarray:
        """Return C10 alone."""
        return np.array([0.5 * shear_modulus, 0.0])


def _excess(stretches: np.ndarray) -> np.ndarray:
    return np.sum(stretches**2, axis=-1) - 3.0
