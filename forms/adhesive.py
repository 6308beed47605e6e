"""Elastic glue between a deformable face and a rigid foot."""

from __future__ import annotations

from typing import Any

import ufl

from .beam import rotation as rotation_matrix


def foot_displacement(X: Any, origin: Any, translation: Any, rotation: Any) -> Any:
    """Return the displacement at X of a rigid foot: ``t + (exp(theta^) - I)(X - origin)``."""
    R = rotation_matrix(rotation)
    return translation + (R - ufl.Identity(3)) * (X - origin)


def adhesive_energy(u: Any, foot: Any, stiffness: Any) -> Any:
    """Return the potential per glued area of a linear elastic glue, ``k/2 |u - u_foot|^2``.

    Parameters
    ----------
    u, foot
        Displacements in mm of the face and of the foot that is glued to it.
    stiffness
        Traction per separation in N/mm^3; perfect glue is the limit of large values.
    """
    separation = u - foot
    return 0.5 * stiffness * ufl.inner(separation, separation)
