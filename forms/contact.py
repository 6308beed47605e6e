r"""Frictionless contact: a potential of the distance between a point and a facet of a surface.

A point x = X + u is opposed to the place y(xi) on a facet at which the distance between the two is
stationary. With the facet's tangents there and their normal n, out of the body,

.. math:: g = (x - y) \cdot n - r, \qquad n = \frac{y_{,1} \times y_{,2}}{|y_{,1} \times y_{,2}|},
    \qquad \Pi = \epsilon A \, \phi(\langle -g \rangle)

for a point that stands for an area A of its surface and keeps a distance r from the other (half
a bar's height, say). xi may be held fixed in the variation, since the distance is stationary in
it. The potential is the same after a rigid motion of the two, so that the contact forces are in
balance, their moments too (Wriggers: Computational Contact Mechanics, 2006, chapters 4 and 6).
"""

from __future__ import annotations

from collections.abc import Callable
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


def contact_energy(gap: Any, stiffness: Any, soft: float) -> Any:
    """Return the potential in N mm of a point, by `contact_force`."""
    d = penetration(gap)
    beyond = 0.5 * d**2 - 0.5 * soft * d + soft**2 / 6.0
    return stiffness * ufl.conditional(ufl.lt(d, soft), d**3 / (6.0 * soft), beyond)


def contact_force(gap: Any, stiffness: Any, soft: float) -> Any:
    """Return the force in N that pushes a point out.

    It grows with the square of the penetration up to ``soft`` (mm), as the pressure of rough
    surfaces does, and with ``stiffness`` (N/mm) beyond.
    """
    d = penetration(gap)
    return stiffness * ufl.conditional(ufl.lt(d, soft), d**2 / (2.0 * soft), d - 0.5 * soft)


def contact_correction(
    gap: Callable[[Any], Any], stiffness: Any, soft: float, w: Any, w_last: Any, step: Any
) -> Any:
    """Return what turns the consistent tangent's integrand into a mixed-point one.

    The force that multiplies the second variation of the gap is the one that the tangent of the
    iterate before has predicted, and never pulls; see `morphing_wing.forms.mixed_point`.

    Parameters
    ----------
    gap
        From the unknowns to g.
    stiffness, soft
        See `contact_force`.
    w, w_last, step
        Present unknown, the one of the iteration before, and the change between them or zero;
        functions of one space.
    """
    space = w.ufl_function_space()
    v, d = ufl.TestFunction(space), ufl.TrialFunction(space)
    last = contact_force(gap(w_last), stiffness, soft)
    predicted = last + ufl.derivative(last, w_last, step)
    predicted = ufl.conditional(ufl.gt(predicted, 0.0), predicted, 0.0)
    present = contact_force(gap(w), stiffness, soft)
    excess = ufl.conditional(ufl.lt(gap(w), 0.0), present - predicted, 0.0)
    return excess * ufl.derivative(ufl.derivative(gap(w), w, v), w, d)
