"""Newton tangents that stay good far from equilibrium: mixed integration points.

An energy ``1/2 sum_i C_i s_i(w)^2`` of stiff strains s_i has the tangent ``C s'[v] s'[d] + S
s''[v, d]`` with the stress S = C s(w). Far from equilibrium that stress is mostly error, and the
geometric term with it. Here S is what Newton's method would give if it were an unknown of its own:

    S_lin = C (s(w_last) + s'(w_last)[step]),  step = w - w_last.

The residual is unchanged, and so is the tangent at convergence. With ``step = 0`` the stress of
``w_last`` is kept: for the first tangent of a load step.

References
----------
Magisano, Leonetti, Garcea, Int. J. Numer. Meth. Engng 109 (2017) 1237-1262.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any

import ufl


def mixed_point_correction(
    strains: Callable[[Any], Sequence[Any]],
    stiffness: Sequence[Any],
    w: Any,
    w_last: Any,
    step: Any,
) -> Any:
    """Return what turns the consistent tangent's integrand into the mixed-point one.

    Parameters
    ----------
    strains
        From the unknown to the strains s_i.
    stiffness
        C_i of each strain.
    w, w_last, step
        Present unknown, the one of the iteration before, and the change between them or zero;
        functions of one space.
    """
    space = w.ufl_function_space()
    v, d = ufl.TestFunction(space), ufl.TrialFunction(space)
    total: Any = 0
    for C, s, s_last in zip(stiffness, strains(w), strains(w_last), strict=True):
        expected = s_last + ufl.derivative(s_last, w_last, step)
        second_variation = ufl.derivative(ufl.derivative(s, w, v), w, d)
        total = total + C * (expected - s) * second_variation
    return total
