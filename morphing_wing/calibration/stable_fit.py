"""Least squares under the condition that the law is stable up to a stretch, in all three modes."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from scipy.optimize import minimize

from .deformation import MODES
from .laws import Law
from .stability import ENFORCED, margin

__all__ = ["Objective", "is_stable", "stable_values"]

SPARE = 1e-4
"""Part of the shear modulus that every margin must have left, so that rounding decides nothing."""

CONDITIONS = [(criterion, mode) for criterion in ENFORCED for mode in MODES]


@dataclass(frozen=True)
class Objective:
    """What is minimised.

    Attributes
    ----------
    law
        The law.
    computed, slopes
        Its nominal stresses in MPa at the data's points, and their derivatives by the constants.
    stress, weights
        The data's stresses in MPa, and weights.
    """

    law: Law
    computed: Callable[[Law, Any], np.ndarray]
    slopes: Callable[[Law, Any], np.ndarray]
    stress: np.ndarray
    weights: np.ndarray

    def __call__(self, values: np.ndarray) -> tuple[float, np.ndarray]:
        """Return the weighted squares over those of the stress, and their gradient."""
        off, size = self.computed(self.law, values) - self.stress, self.weights @ self.stress**2
        gradient = 2.0 * (self.weights * off) @ self.slopes(self.law, values)
        return float(self.weights @ off**2 / size), gradient / size


def is_stable(law: Law, values: Any, stable: float, points: int = 200) -> bool:
    """Whether a law is stable from 1 to a stretch in all three modes."""
    return bool((_margins(law, values, np.geomspace(1.0, stable, points)) > 0.0).all())


def stable_values(objective: Objective, free: np.ndarray, stable: float) -> np.ndarray:
    """Return the constants of least squares among those that are stable up to a stretch.

    Parameters
    ----------
    objective
        What is minimised.
    free
        The constants of least squares without the condition, which they violate.
    stable
        Stretch up to which the law must be stable.
    """
    law = objective.law
    size = np.sqrt(np.sum(objective.weights) / np.sum(
        objective.weights[:, None] * objective.slopes(law, law.neo_hooke(1.0)) ** 2, axis=0))
    level = float(np.sqrt(np.average(objective.stress**2, weights=objective.weights)))
    modulus = max(law.shear_modulus(free), 0.1 * level)
    scale = np.array([level * each if unit else 1.0
                      for each, unit in zip(size, law.units, strict=True)])
    return (_by_cuts if law.linear else _by_margins)(
        objective, scale, law.neo_hooke(modulus), free, SPARE * modulus, stable)


def _by_cuts(
    objective: Objective, scale: np.ndarray, safe: np.ndarray, free: np.ndarray, spare: float,
    stable: float,
) -> np.ndarray:
    """Return the optimum where margins are concave in the constants, by cutting planes.

    The least eigenvalue of a matrix that is linear in the constants is concave and homogeneous of
    them, so that its gradient g at any constants gives a plane, g . c >= spare, that no stable
    constants violate. Planes are added where the optimum under those known is not stable.
    """
    law, values = objective.law, free
    stretches = np.geomspace(1.0, stable, 100)
    planes: list[np.ndarray] = []
    for _ in range(100):
        found = _margins(law, values, stretches)
        worst = found.argmin(axis=1)
        lost = [(*CONDITIONS[i], stretches[at]) for i, at in enumerate(worst)
                if found[i, at] < 0.99 * spare]
        if not lost:
            return values
        planes += [scale * _gradient(law, values, scale, *where) for where in lost]
        matrix = np.array(planes)
        end = minimize(
            lambda z: _scaled(objective, z, scale), safe / scale, jac=True, method="SLSQP",
            constraints={"type": "ineq", "fun": lambda z, m=matrix: (m @ z - spare) / spare,
                         "jac": lambda z, m=matrix: m / spare},
            options={"maxiter": 500, "ftol": 1e-15})
        values = scale * end.x
    return safe


def _by_margins(
    objective: Objective, scale: np.ndarray, safe: np.ndarray, free: np.ndarray, spare: float,
    stable: float,
) -> np.ndarray:
    """Return a local optimum where the law is nonlinear: moduli of at least 0, all margins."""
    law, stretches = objective.law, np.geomspace(1.0, stable, 12)
    bounds = [(0.0 if unit else None, None) for unit in law.units]
    ends = [safe]
    for start in (safe, free):
        end = minimize(
            lambda z: _scaled(objective, z, scale), start / scale, jac=True, method="SLSQP",
            bounds=bounds, options={"maxiter": 100, "ftol": 1e-10}, constraints={
                "type": "ineq",
                "fun": lambda z: (_margins(law, scale * z, stretches).ravel() - spare) / spare})
        if np.isfinite(end.x).all() and is_stable(law, scale * end.x, stable):
            ends.append(scale * end.x)
    return min(ends, key=lambda values: objective(values)[0])


def _scaled(objective: Objective, z: np.ndarray, scale: np.ndarray) -> tuple[float, np.ndarray]:
    squares, gradient = objective(scale * z)
    return squares, scale * gradient


def _margins(law: Law, values: Any, stretches: Sequence[float] | np.ndarray) -> np.ndarray:
    """Return the margins in MPa, of shape (conditions, stretches)."""
    return np.stack([margin(law, values, *condition, stretches) for condition in CONDITIONS])


def _gradient(
    law: Law, values: np.ndarray, scale: np.ndarray, criterion: str, mode: str, stretch: float
) -> np.ndarray:
    """Return a margin's derivatives by the constants."""
    steps = 1e-6 * np.diag(scale)
    return np.array([float(margin(law, values + step, criterion, mode, stretch)
                           - margin(law, values - step, criterion, mode, stretch))
                     / (2.0 * step.sum()) for step in steps])
