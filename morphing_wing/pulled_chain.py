r"""Equilibrium of a chain of condensed pieces under a moment and a cable at its tail.

With the chain's unknowns y, their stiffness K, the tail's turn :math:`\theta` and place x,

.. math:: \Pi = \tfrac12 y \cdot K y + M \theta + T |x(y) - g| :

under a moment alone it is linear.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from .newton import NewtonResult
from .rib_chain import RibChain

MOST_ITERATIONS = 25


@dataclass(frozen=True)
class Pull:
    """What works on the tail.

    Attributes
    ----------
    torque
        M in N mm, about z; positive turns the tail down.
    tension
        T in N.
    guide : (3,) array
        g, from the root's middle, mm.
    """

    torque: float
    tension: float
    guide: np.ndarray


def cable_length(
    chain: RibChain, y: np.ndarray, guide: np.ndarray
) -> tuple[float, np.ndarray, np.ndarray]:
    """Return the distance in mm of tail and guide, its first and second derivatives by y."""
    place, first, second = chain.tail(y)
    away = np.array([*place, 0.0]) - guide
    length = float(np.linalg.norm(away))
    e = away[:2] / length
    turning = (np.eye(2) - np.outer(e, e)) / length
    return length, e @ first, first.T @ turning @ first + np.tensordot(e, second, 1)


def potential(
    chain: RibChain, y: np.ndarray, pull: Pull
) -> tuple[float, np.ndarray, np.ndarray]:
    """Return the potential in N mm, its gradient and its Hessian."""
    length, first, second = cable_length(chain, y, pull.guide)
    force = chain.stiffness @ y
    gradient = force + pull.tension * first
    gradient[-1] += pull.torque
    value = 0.5 * y @ force + pull.torque * y[-1] + pull.tension * length
    return float(value), gradient, chain.stiffness + pull.tension * second


def equilibrium(
    chain: RibChain, y: np.ndarray, pull: Pull
) -> tuple[np.ndarray, NewtonResult]:
    """Return the unknowns at rest under a pull, by Newton's method from others."""
    for iteration in range(MOST_ITERATIONS + 1):
        with np.errstate(all="ignore"):  # what is not finite is told below
            _, gradient, hessian = potential(chain, y, pull)
            step = _solved(hessian, -gradient)
            y = y + step
            decrement = abs(gradient @ step)
        residual = float(np.linalg.norm(gradient))
        if not np.isfinite(decrement):
            return y, NewtonResult(False, "the residual grew without bound", iteration, residual, 0)
        # The last step, which is not counted, leaves the square of what it takes away.
        if decrement <= 1e-16 * (y @ chain.stiffness @ y) + 1e-24:
            negative = int((np.linalg.eigvalsh(hessian) < 0.0).sum())
            return y, NewtonResult(True, "converged", iteration, residual, negative)
    return y, NewtonResult(False, "Newton used up its iterations", iteration, residual, 0)


def compliance(chain: RibChain, y: np.ndarray, pull: Pull, names: list[str]) -> np.ndarray:
    """Return the derivative of each load's displacement by each load, see `displacements`."""
    _, _, hessian = potential(chain, y, pull)
    forces = {"torque_Nmm": -np.eye(len(y))[-1],
              "cable_N": -cable_length(chain, y, pull.guide)[1]}
    F = np.array([forces[name] for name in names]).reshape(len(names), len(y))
    return F @ _solved(hessian, F.T)


def displacements(chain: RibChain, y: np.ndarray, pull: Pull) -> dict[str, float]:
    """Return what each load works on: turn in radians, shortening of the cable in mm."""
    return {"torque_Nmm": -float(y[-1]), "cable_N": -cable_length(chain, y, pull.guide)[0]}


def _solved(hessian: np.ndarray, right: np.ndarray) -> np.ndarray:
    try:
        return np.linalg.solve(hessian, right)
    except np.linalg.LinAlgError:
        return np.full_like(right, np.nan)
