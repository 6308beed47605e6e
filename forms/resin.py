r"""Stored energy of resin: large displacements, small strains.

St Venant and Kirchhoff's law, quadratic in Green's strain,

.. math:: W = \tfrac{\lambda}{2} (\mathrm{tr} E)^2 + \mu \, E : E, \qquad
    E = \tfrac12 (F^T F - I) ,

is Hooke's law in a body that turns. It serves tension and small compression: crushed to 0.58 of
its length a body of it gives way, far beyond where resin yields (1.5 %).
"""

from __future__ import annotations

from typing import Any

import ufl

from .kinematics import deformation_gradient


def green_strain(u: Any) -> Any:
    """Return ``E = (grad u + grad u^T + grad u^T grad u)/2`` of a displacement."""
    H = ufl.grad(u)
    return 0.5 * (H + ufl.transpose(H) + ufl.transpose(H) * H)


def resin_stress(E: Any, lame: Any, shear: Any) -> Any:
    """Return the second Piola-Kirchhoff stress ``S = lambda tr(E) I + 2 mu E`` in MPa."""
    return lame * ufl.tr(E) * ufl.Identity(3) + 2.0 * shear * E


def resin_energy(u: Any, lame: Any, shear: Any) -> Any:
    """Return the stored energy ``S : E / 2`` in N/mm^2.

    Parameters
    ----------
    u
        Displacement in mm.
    lame, shear
        lambda and mu in MPa.
    """
    E = green_strain(u)
    return 0.5 * ufl.inner(resin_stress(E, lame, shear), E)


def resin_tangent_correction(u: Any, u_last: Any, step: Any, lame: Any, shear: Any) -> Any:
    """Return what makes of the consistent tangent's integrand the mixed-point one.

    See `morphing_wing.forms.mixed_point`; here all strains at once: with ``E_lin = E(u_last) +
    E'(u_last)[step]`` it is ``(S(E_lin) - S(E)) : sym(grad(v)^T grad(d))``.
    """
    space = u.ufl_function_space()
    v, d = ufl.TestFunction(space), ufl.TrialFunction(space)
    E = green_strain(u)
    expected = green_strain(u_last) + ufl.sym(
        ufl.transpose(deformation_gradient(u_last)) * ufl.grad(step))
    error = resin_stress(expected - E, lame, shear)
    return ufl.inner(error, ufl.sym(ufl.transpose(ufl.grad(v)) * ufl.grad(d)))


def von_mises_stress(u: Any, lame: Any, shear: Any) -> Any:
    """Return von Mises' equivalent of Cauchy's stress ``F S F^T / J`` in MPa."""
    F = deformation_gradient(u)
    cauchy = F * resin_stress(green_strain(u), lame, shear) * ufl.transpose(F) / ufl.det(F)
    deviator = cauchy - ufl.tr(cauchy) / 3.0 * ufl.Identity(3)
    return ufl.sqrt(1.5 * ufl.inner(deviator, deviator))
