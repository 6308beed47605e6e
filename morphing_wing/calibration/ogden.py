"""Ogden's strain energy of incompressible rubber."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import combinations
from typing import Any

import numpy as np

from .deformation import principal
from .laws import Law

__all__ = ["OgdenLaw"]


@dataclass(frozen=True)
class OgdenLaw(Law):
    r"""Ogden's law; its exponents make it nonlinear in its constants.

    .. math:: W = \sum_{k=1}^{n} \frac{2 \mu_k}{\alpha_k^2}
        \Big(\sum_j \lambda_j^{\alpha_k} - 3\Big)

    (Ogden 1972, with moduli scaled so that their sum is the shear modulus at rest).

    Parameters
    ----------
    terms
        How many: 1, 2, ...; the constants are the moduli first, then the exponents.
    """

    terms: int

    @property
    def name(self) -> str:
        """The law in words."""
        return f"Ogden, {self.terms} term{'s' if self.terms > 1 else ''}"

    @property
    def linear(self) -> bool:
        """It is not."""
        return False

    @property
    def constants(self) -> tuple[str, ...]:
        """mu1, mu2, ..., alpha1, alpha2, ..."""
        return tuple(f"{name}{k}" for name in ("mu", "alpha") for k in range(1, self.terms + 1))

    def gradient(self, values: Any, stretches: np.ndarray) -> np.ndarray:
        """Return W_i without its part that is equal in lambda_i W_i, a pressure."""
        return sum(2.0 * mu * _power(stretches, alpha) / stretches
                   for mu, alpha in self._pairs(values))

    def hessian(self, values: Any, stretches: np.ndarray) -> np.ndarray:
        """Return the derivative of the gradient, a diagonal."""
        second = sum(2.0 * mu * (stretches**alpha - _power(stretches, alpha)) / stretches**2
                     for mu, alpha in self._pairs(values))
        return second[..., None] * np.eye(3)

    def stress_slopes(self, values: Any, mode: str, stretch: np.ndarray) -> np.ndarray:
        """Return the derivatives by the moduli, then by the exponents."""
        stretches = principal(mode, stretch)
        first, third = stretches[..., 0], stretches[..., 2]
        by_mu, by_alpha = [], []
        for mu, alpha in self._pairs(values):
            by_mu.append(2.0 * (_power(first, alpha) - _power(third, alpha)) / first)
            by_alpha.append(2.0 * mu * (_by_exponent(first, alpha) - _by_exponent(third, alpha))
                            / first)
        return np.stack([*by_mu, *by_alpha], axis=-1)

    def shear_modulus(self, values: Any) -> float:
        """Return the sum of the moduli."""
        return float(np.sum(values[: self.terms]))

    def neo_hooke(self, shear_modulus: float) -> np.ndarray:
        """Return exponents 2, -2, ...: Mooney and Rivlin's law with a small second term."""
        shares = np.array([0.9, *[0.1 / max(self.terms - 1, 1)] * (self.terms - 1)])
        exponents = [2.0, -2.0, 4.0, -4.0, 6.0][: self.terms]
        return np.concatenate([shear_modulus * shares / shares.sum(), exponents])

    def exponents(self) -> list[tuple[float, ...]]:
        """Return exponents from which a search begins, in ascending order."""
        grid = [a for a in np.arange(-8.0, 16.5, 1.0) if a != 0.0]
        return list(combinations(grid, self.terms))

    def in_order(self, values: np.ndarray) -> np.ndarray:
        """Return the constants with ascending exponents: their order has no meaning."""
        order = np.argsort(values[self.terms:])
        return np.concatenate([values[: self.terms][order], values[self.terms:][order]])

    def _pairs(self, values: Any) -> Any:
        return zip(values[: self.terms], values[self.terms:], strict=True)


def _power(stretch: np.ndarray, alpha: float) -> np.ndarray:
    """Return (stretch^alpha - 1) / alpha, the logarithm where alpha is 0."""
    log = np.log(stretch)
    return log if alpha == 0.0 else np.expm1(alpha * log) / alpha


def _by_exponent(stretch: np.ndarray, alpha: float) -> np.ndarray:
    """Return the derivative of `_power` by alpha."""
    log = np.log(stretch)
    if abs(alpha) < 1e-5:  # its series, where the quotient cancels
        return log**2 / 2.0 + alpha * log**3 / 3.0
    return (log * np.exp(alpha * log) - _power(stretch, alpha)) / alpha
