r"""Strong ellipticity of an incompressible law: the least modulus of a plane wave.

In principal axes the moduli about the deformed state are (Ogden 1984, Section 6.1; what a pressure
adds drops out where m and n are perpendicular)

.. math:: \mathcal A_{0iijj} = \lambda_i \lambda_j W_{ij} , \qquad
    \mathcal A_{0ijij} = \frac{\lambda_i W_i - \lambda_j W_j}{\lambda_i^2 - \lambda_j^2} \lambda_i^2
    , \qquad \mathcal A_{0ijji} = \mathcal A_{0ijij} - \lambda_i W_i .

Of the acoustic tensor :math:`Q_{jl}(n) = \mathcal A_{0ijkl} n_i n_k`, as it acts on the plane
across n, trace and determinant depend on the squares of n's components alone. So the least
eigenvalue of all directions is searched for on a triangle.
"""

from __future__ import annotations

import numpy as np

__all__ = ["least_wave_modulus"]

CYCLES = ((0, 1, 2), (1, 2, 0), (2, 0, 1))
ALIKE = 1e-5
"""Relative difference of two stretches below which their quotient is taken at its limit."""

_steps = np.linspace(0.0, 1.0, 13)
_COARSE = np.array([(x, y, 1.0 - x - y) for x in _steps for y in _steps if x + y < 1.0 + 1e-12])
_near = np.linspace(-1.0, 1.0, 5)
_FINE = np.array([(x, y, -x - y) for x in _near for y in _near])


def least_wave_modulus(
    stretches: np.ndarray, gradient: np.ndarray, hessian: np.ndarray
) -> np.ndarray:
    """Return the least of density times squared wave speed, over all directions, in MPa.

    Parameters
    ----------
    stretches
        Principal stretches, of shape (..., 3).
    gradient, hessian
        W_i and W_ij there in MPa, of shapes (..., 3) and (..., 3, 3).

    Returns
    -------
    Array of shape (...): greater than 0 where the law is strongly elliptic.
    """
    shear, coupled = _moduli(stretches, gradient, hessian)
    squares = np.broadcast_to(_COARSE, (*stretches.shape[:-1], *_COARSE.shape))
    width = _steps[1]
    for _ in range(7):
        found = _least_across(shear, coupled, squares)
        best = np.argmin(found, axis=-1)[..., None, None]
        here = np.take_along_axis(squares, best, axis=-2)
        squares = np.clip(here + width * _FINE, 0.0, None)
        squares = squares / squares.sum(axis=-1, keepdims=True)
        width *= 0.4
    return np.minimum(found.min(axis=-1), _least_across(shear, coupled, squares).min(axis=-1))


def _moduli(
    stretches: np.ndarray, gradient: np.ndarray, hessian: np.ndarray
) -> tuple[np.ndarray, np.ndarray]:
    """Return A_ijij (on its diagonal A_iiii) and A_iijj + A_ijji, both of shape (..., 3, 3)."""
    normal = hessian * stretches[..., :, None] * stretches[..., None, :]
    force = stretches * gradient
    squared = stretches**2
    gap = squared[..., :, None] - squared[..., None, :]
    alike = np.abs(gap) < ALIKE * squared[..., :, None]
    ii = np.diagonal(normal, axis1=-2, axis2=-1)
    limit = 0.5 * (ii[..., :, None] - normal + force[..., :, None])
    quotient = (force[..., :, None] - force[..., None, :]) / np.where(alike, 1.0, gap)
    shear = np.where(alike, limit, quotient * squared[..., :, None])
    coupled = normal + shear - force[..., :, None]
    diagonal = np.eye(3, dtype=bool)
    return np.where(diagonal, normal, shear), coupled


def _least_across(shear: np.ndarray, coupled: np.ndarray, squares: np.ndarray) -> np.ndarray:
    """Return the acoustic tensor's least eigenvalue across n, of n's squares (..., k, 3)."""
    along = np.einsum("...ki,...ij->...kj", squares, shear)
    off, x = coupled[..., None, :, :], squares
    own = np.sum(along * x, axis=-1)
    determinant = np.zeros_like(own)
    for i, j, k in CYCLES:
        own = own + 2.0 * off[..., j, k] * x[..., j] * x[..., k]
        determinant = determinant + x[..., i] * (
            along[..., j] * along[..., k] - off[..., j, k] ** 2 * x[..., j] * x[..., k])
        determinant = determinant - 2.0 * x[..., j] * x[..., k] * (
            off[..., j, k] * along[..., i] - off[..., i, j] * off[..., i, k] * x[..., i])
    half = 0.5 * (along.sum(axis=-1) - own)
    root = np.sqrt(np.maximum(half**2 - determinant, 0.0))
    # Of a small eigenvalue beside a large one the difference would leave rounding alone.
    return np.where(half > 0.0, determinant / np.where(half > 0.0, half + root, 1.0), half - root)
