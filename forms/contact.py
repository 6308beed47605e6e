r"""Frictionless contact: a potential of the distance between a point and a facet of a surface.

A point x = X + u is opposed to the place y(xi) on a facet at which the distance between the two is
stationary. With the facet's tangents there and their normal n, out of the body,

.. math:: g = (x - y) \cdot n - r, \qquad n = \frac{y_{,1} \times y_{,2}}{|y_{,1} \times y_{,2}|},
    \qquad \Pi = \tfrac12 \, \epsilon A \, \langle -g \rangle^2

for a point that stands for an area A of its surface and keeps a distance r from the other (half
a bar's height, say). xi may be held fixed in the variation, since the distance is stationary in
it. The potential is the same after a rigid motion of the two, so that the contact forces are in
balance, their moments too (Wriggers: Computational Contact Mechanics, 2006, chapters 4 and 6).
"""

from __future__ import annotations

from typing import Any

import ufl


def contact_gap(point: Any, place: Any, first: Any, second: Any, distance: Any) -> Any:
    """Return g in mm, negative where the point has entered.

    Parameters
    ----------
    point, place
        Deformed positions x of the point and y of the place opposed to it, mm.
    first, second
        Deformed tangents of the facet there; their cross product looks out of the body.
    distance
        r in mm.
    """
    normal = ufl.cross(first, second)
    return ufl.inner(point - place, normal) / ufl.sqrt(ufl.inner(normal, normal)) - distance


def penetration(gap: Any) -> Any:
    """Return <-g>: how deep a point has entered, mm."""
    return ufl.conditional(ufl.lt(gap, 0.0), -gap, 0.0)


def contact_energy(gap: Any, stiffness: Any) -> Any:
    """Return the potential in N mm of a point with ``stiffness`` epsilon A in N/mm."""
    return 0.5 * stiffness * penetration(gap) ** 2
