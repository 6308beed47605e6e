"""A cable under constant tension."""

from __future__ import annotations

from typing import Any

import ufl


def cable_potential(tension: Any, point: Any, guide: Any) -> Any:
    r"""Return the potential in N mm of a cable of constant tension between point and guide.

    .. math:: \Pi = T \, |x - g|

    Its negative derivative is the force T (g - x)/|g - x| on the point: the cable always pulls
    towards its guide, as a weight over a small frictionless pulley does.

    Parameters
    ----------
    tension
        T in N.
    point
        Deformed position x of the attachment in mm.
    guide
        Fixed position g of the guide in mm; must not coincide with the point.
    """
    reach = point - guide
    return tension * ufl.sqrt(ufl.inner(reach, reach))
