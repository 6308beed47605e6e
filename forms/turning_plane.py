"""A plane that points stay on, free to turn about x and to move along its normal."""

from __future__ import annotations

from typing import Any

import ufl


def turned_z(turn: Any) -> Any:
    """Return z turned about x by radians, down where they are positive."""
    return ufl.as_vector([ufl.zero(), -ufl.sin(turn), ufl.cos(turn)])


def plane_energy(stiffness: Any, normal: Any, distance: Any, position: Any) -> Any:
    """Return the integrand over a face of the energy (N/mm) that holds it on a plane.

    ``k/2 (n . x - d)^2``: stiffness k in MPa/mm, distance d of the plane from the origin and
    position x in mm. With turn and distance as unknowns the plane bears neither moment nor force,
    as a mirror plane of a structure that repeats itself.
    """
    return 0.5 * stiffness * (ufl.inner(normal, position) - distance) ** 2
