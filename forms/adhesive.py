r"""Glue between a deformable face and a rigid foot: traction against separation, with damage.

With the separation s of the foot from the face, its part along the face's normal, which turns with
the foot, s_n = s . R N, and the rest s_t,

.. math:: e = \tfrac{k}{2} \langle s_n \rangle^2 + \tfrac{k_t}{2} |s_t|^2, \qquad
    \lambda = \sqrt{e / e_0}, \qquad e_0 = \frac{\sigma^2}{2 k},

the glue is elastic up to lambda = 1, where a pull reaches the strength sigma, softens linearly and
has let go at lambda_f = G/e_0, where the fracture energy G is spent. The largest lambda so far,
kappa, says how far it is damaged: the stiffness is (1 - d(kappa)) times the virgin one. Pressing
it together, s_n < 0, stays elastic. Everything derives from one potential of s for given kappa:
its growth beyond kappa is the energy stored and dissipated on the way. One norm e for both modes
is what makes it so, and with it k_t = k (tau/sigma)^2 for a shear strength tau, the relation of
Turon, Camanho, Costa, Renart (Composite Structures 92 (2010) 1857-1864) for equal fracture
energies.

References
----------
Ortiz, Pandolfi, Int. J. Numer. Meth. Engng 44 (1999) 1267-1282: such laws from a potential.
"""

from __future__ import annotations

from typing import Any

import ufl

from .beam import rotation as rotation_matrix


def foot_displacement(X: Any, origin: Any, translation: Any, rotation: Any) -> Any:
    """Return the displacement at X of a rigid foot: ``t + (exp(theta^) - I)(X - origin)``."""
    R = rotation_matrix(rotation)
    return translation + (R - ufl.Identity(3)) * (X - origin)


def separation_energies(separation: Any, normal: Any, stiffness: Any, shear: Any) -> Any:
    """Return e of opening and sliding, and the energy of closing, both in N/mm, of virgin glue.

    Parameters
    ----------
    separation
        s in mm, foot against face.
    normal
        Unit normal R N, out of the face.
    stiffness, shear
        k and k_t in N/mm^3.
    """
    along = ufl.inner(separation, normal)
    opening = ufl.conditional(ufl.gt(along, 0.0), along, 0.0)
    across = ufl.inner(separation, separation) - along**2
    return (0.5 * (stiffness * opening**2 + shear * across),
            0.5 * stiffness * (along - opening) ** 2)


def used(energy: Any, onset: Any) -> Any:
    """Return lambda. Rounding of the two parts of a separation may leave e below zero."""
    return ufl.sqrt(ufl.conditional(ufl.gt(energy, 0.0), energy / onset, 0.0))


def damage(kappa: Any, last: Any) -> Any:
    """Return d(kappa) for ``last`` = lambda_f: 0 up to 1, 1 from lambda_f on."""
    inside = last * (kappa - 1.0) / (kappa * (last - 1.0))
    return ufl.conditional(ufl.lt(kappa, last), inside, 1.0)


def adhesive_energy(energy: Any, kappa: Any, onset: Any, last: Any) -> Any:
    """Return the potential per glued area in N/mm of e (without closing), for given history.

    Parameters
    ----------
    energy
        e in N/mm of virgin glue.
    kappa
        The largest lambda so far, at least 1.
    onset, last
        e_0 in N/mm and lambda_f.
    """
    reached = ufl.sqrt(ufl.conditional(ufl.gt(energy, onset), energy / onset, 1.0))

    def spent(x: Any) -> Any:
        """Integral of the softening curve: stored and dissipated up to x > 1."""
        inside = 1.0 + ((last - 1.0) ** 2 - (last - x) ** 2) / (last - 1.0)
        return onset * ufl.conditional(ufl.lt(x, last), inside, last)

    sound = 1.0 - damage(kappa, last)
    before = sound * energy + spent(kappa) - sound * onset * kappa**2
    return ufl.conditional(ufl.gt(reached, kappa), spent(reached), before)


def dissipated_energy(kappa: Any, onset: Any, last: Any) -> Any:
    """Return the energy per glued area in N/mm that damage took: what is left at rest."""
    return adhesive_energy(0.0, kappa, onset, last)
