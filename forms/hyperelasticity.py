"""Strain energies of nearly incompressible elastomers.

Each function returns a density in N/mm^2 (= N mm per mm^3) that the caller integrates, so that the
isochoric and the volumetric parts can have quadratures of their own.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import ufl

from .kinematics import isochoric_first_invariant


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
