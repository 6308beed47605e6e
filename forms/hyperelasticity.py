"""Strain energies of nearly incompressible elastomers.

Each function returns a density in N/mm^2 (= N mm per mm^3) that the caller integrates, so that the
isochoric and the volumetric parts can have quadratures of their own.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import ufl

from .kinematics import cofactor, deformation_gradient, isochoric_first_invariant


def yeoh_energy(F: Any, coefficients: Sequence[float]) -> Any:
    """Return the isochoric Yeoh energy ``sum_i C_i0 (I1bar - 3)^i`` (paper, Eq. 3).

    Parameters
    ----------
    F
        Deformation gradient.
    coefficients
        ``(C10, C20, ...)`` in MPa, any number of terms.

    References
    ----------
    Yeoh, Rubber Chemistry and Technology 66 (1993) 754-771.
    """
    stretch = isochoric_first_invariant(F) - 3.0
    return sum(c * stretch ** (i + 1) for i, c in enumerate(coefficients))


def volumetric_energy(F: Any, bulk: Any) -> Any:
    """Return ``kappa/2 (J - 1)^2`` for the displacement form."""
    return 0.5 * bulk * (ufl.det(F) - 1.0) ** 2


def mixed_volumetric_energy(F: Any, p: Any, inverse_bulk: Any) -> Any:
    """Return the perturbed Lagrangian ``p (J - 1) - p^2 / (2 kappa)``.

    ``p`` is the mean Cauchy stress (tension positive) in MPa. Stationarity in p gives
    ``p = kappa (J - 1)``; ``inverse_bulk = 1/kappa`` may be zero: exactly incompressible.
    """
    return p * (ufl.det(F) - 1.0) - 0.5 * inverse_bulk * p**2


def mixed_point_tangent_correction(
    u: Any, u_last: Any, v: Any, w: Any, bulk: Any, linearised: Any
) -> Any:
    """Return what turns the consistent volumetric tangent into the mixed-integration-point one.

    The geometric term of the tangent of ``volumetric_energy`` weighs ``D^2 J[v, w]`` with
    ``kappa (J(u) - 1)``, which for large kappa is noise far from equilibrium. It is replaced by

        p_lin = kappa (J(u_last) - 1 + linearised * cof F(u_last) : grad(u - u_last)).

    The residual is unchanged. With ``linearised = 0`` the pressure of ``u_last`` is kept.

    References
    ----------
    Magisano, Leonetti, Garcea, Int. J. Numer. Meth. Engng 109 (2017) 1237-1262.
    """
    F, F_last = deformation_gradient(u), deformation_gradient(u_last)
    J = ufl.det(F)
    change = ufl.inner(cofactor(F_last), ufl.grad(u - u_last))
    pressure_error = bulk * (ufl.det(F_last) - 1.0 + linearised * change - (J - 1.0))
    second_variation = ufl.derivative(ufl.inner(cofactor(F), ufl.grad(v)), u, w)
    return pressure_error * second_variation
