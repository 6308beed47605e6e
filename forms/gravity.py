"""Weight of a body or of a beam."""

from __future__ import annotations

from typing import Any

STANDARD_GRAVITY = 9.80665
"""In m/s^2."""

_PER_CUBIC_MM = 1e-9  # cubic metres


def mass_density(density: float) -> float:
    """Return the density in kg/mm^3 of one in kg/m^3."""
    return density * _PER_CUBIC_MM


def specific_weight(density: float) -> float:
    """Return the weight in N/mm^3 under standard gravity of a density in kg/m^3."""
    return mass_density(density) * STANDARD_GRAVITY


def gravity_potential(weight: Any, u: Any) -> Any:
    r"""Return the integrand of the potential of a weight that points along -y.

    .. math:: \Pi = \int n \rho g \, u_y \, dV

    over the reference volume, for mass is conserved; zero in the reference state. Its second
    variation vanishes: a weight adds nothing to the tangent.

    Parameters
    ----------
    weight
        n rho g, n multiples of standard gravity: N/mm^3 of a body, N/mm of a beam.
    u
        Displacement in mm.
    """
    return weight * u[1]
