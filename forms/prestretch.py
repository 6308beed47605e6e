"""A skin that is stretched before it is built in."""

from __future__ import annotations

from typing import Any

import ufl


def prestretch_gradient(chordwise: Any, spanwise: Any) -> Any:
    r"""Return the deformation gradient of a membrane stretched along x and z at constant volume.

    .. math:: G = \mathrm{diag}\Big(\lambda_x, \frac{1}{\lambda_x \lambda_z}, \lambda_z\Big)

    The elastic deformation gradient of what is built in so is ``F G``: the energy is that of F G,
    per volume of the body as built, which G leaves as it is.
    """
    zero = 0.0 * chordwise
    return ufl.as_tensor([
        [chordwise, zero, zero],
        [zero, 1.0 / (chordwise * spanwise), zero],
        [zero, zero, spanwise],
    ])
