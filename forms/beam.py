r"""The geometrically exact beam of Simo and Reissner with shear, by its stored energy.

The unknown is w = (u, theta): displacement in mm and total rotation vector. Sections turn by
R = exp(theta^), so that with local axes e_i (rows of the matrix ``axes``) and the derivative '
along e_1 in the reference configuration

.. math:: \Gamma_i = (R e_i) \cdot (e_1 + u') - e_i \cdot e_1, \qquad
    K_i = e_i \cdot T(\theta)^T \theta', \qquad
    W = \tfrac12 \left(\Gamma \cdot C_N \Gamma + K \cdot C_M K\right)

(Reissner, ZAMP 32 (1981) 734-744; Simo, Computer Methods in Applied Mechanics and Engineering 49
(1985) 55-70). A rigid motion stores nothing. The rotation vector is a chart for turns below a
full one, |theta| < 2 pi; its interpolation is not frame-invariant for coarse cells (Jelenic,
Crisfield, same journal 171 (1999) 141-171), which refinement cures.

Quadratic u and theta with two Gauss points a cell (quadrature degree 3) are free of shear locking
and exact at the points for end loads on a straight bar at small rotations: one cell a bar does.
"""

from __future__ import annotations

import math
from typing import Any

import ufl

QUADRATURE_DEGREE = 3
"""Two Gauss points a cell: reduced integration of quadratic cells."""

_TERMS = 19


def beam_energy(w: Any, axes: Any, stiffness: Any) -> Any:
    """Return the stored energy per reference length in N mm/mm.

    Parameters
    ----------
    w
        Displacement (mm) and rotation vector, 6 components.
    axes
        Local axes of each cell as rows e1, e2, e3, 3 x 3; e1 along the cell.
    stiffness
        EA, GA2, GA3 (N), GJ, EI2, EI3 (N mm^2) of each cell, 6 components.
    """
    measures = [part[i] for part in beam_strains(w, axes) for i in range(3)]
    return sum(stiffness[i] * measures[i] ** 2 for i in range(6)) / 2


def beam_strains(w: Any, axes: Any) -> tuple[Any, Any]:
    """Return axial and shear strains Gamma, and torsion and curvatures K in 1/mm."""
    theta, e1 = rotation_vector(w), axes[0, :]
    u_prime, theta_prime = ufl.dot(ufl.grad(displacement(w)), e1), ufl.dot(ufl.grad(theta), e1)
    # The difference before turning to local axes is exactly zero in the reference state.
    strain = axes * (ufl.dot(ufl.transpose(rotation(theta)), e1 + u_prime) - e1)
    curvature = axes * ufl.dot(ufl.transpose(tangent_map(theta)), theta_prime)
    return strain, curvature


def displacement(w: Any) -> Any:
    """Return the first three components."""
    return ufl.as_vector([w[i] for i in range(3)])


def rotation_vector(w: Any) -> Any:
    """Return the last three components."""
    return ufl.as_vector([w[i] for i in range(3, 6)])


def rotation(theta: Any) -> Any:
    r"""Return R = exp(theta^) = I + sin(t)/t S + (1 - cos t)/t^2 S^2, S = theta^, t = |theta|."""
    S, q = skew(theta), ufl.inner(theta, theta)
    return ufl.Identity(3) + (1 - q * _c(q)) * S + _b(q) * S * S


def tangent_map(theta: Any) -> Any:
    r"""Return T with R' R^T = (T theta')^: I + (1 - cos t)/t^2 S + (t - sin t)/t^3 S^2."""
    S, q = skew(theta), ufl.inner(theta, theta)
    return ufl.Identity(3) + _b(q) * S + _c(q) * S * S


def skew(v: Any) -> Any:
    """Return the matrix v^ with v^ a = v x a."""
    return ufl.as_matrix([[0, -v[2], v[1]], [v[2], 0, -v[0]], [-v[1], v[0], 0]])


# (1 - cos t)/t^2 and (t - sin t)/t^3 are entire functions of q = t^2. Their power series serve all
# turns below a full one to rounding, and have, unlike the closed forms, no 0/0 in the tangent.


def _b(q: Any) -> Any:
    return _series(q, 2)


def _c(q: Any) -> Any:
    return _series(q, 3)


def _series(q: Any, first: int) -> Any:
    """Return sum over k of (-q)^k/(2 k + first)! by Horner's rule."""
    value = 1.0 / math.factorial(2 * (_TERMS - 1) + first)
    for k in reversed(range(_TERMS - 1)):
        value = 1.0 / math.factorial(2 * k + first) - q * value
    return value
