r"""What limits cost an optimum: the multipliers of the Karush-Kuhn-Tucker conditions.

At an optimum the slope of the cost is held by those of active limits,

.. math:: -\nabla f = \sum_i \lambda_i \nabla g_i , \qquad \lambda_i \ge 0 ,

and :math:`\lambda_i` says how much of the goal one unit more of the limit would allow. They are
found by least squares that are not negative; what remains says how far from an optimum it is.
"""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
from scipy.optimize import nnls

from .box_search import Pieces
from .problem import Constraint, Problem

__all__ = ["prices"]

STEP = 1e-5
AT_LIMIT = 3e-3
"""Part of a limit, or of a variable's range, within which it counts as reached."""


def prices(
    problem: Problem, limits: Mapping[Constraint, float], scale: float, point: np.ndarray,
    pieces: Pieces,
) -> tuple[dict[str, float], float]:
    """Return what active limits cost, and what of the goal's slope they do not hold.

    Parameters
    ----------
    problem
        Whose goal is to maximise or minimise.
    limits
        Of each constraint.
    scale
        Of the goal in its cost.
    point
        In the unit cube.
    pieces
        Costs and violations, a column a constraint, at points of the unit cube.

    Returns
    -------
    prices
        Of each active constraint (``"mass_g max"``) and bound (``"geometry.wall_length min"``),
        the goal that one unit more of it would gain, in units of both outputs; 0 where the limit is
        reached but holds nothing.
    residual
        Relative to the goal's slope.
    """
    d = len(point)
    steps = STEP * np.eye(d)
    costs, violations = pieces(np.vstack([point + steps, point - steps]))
    slope = (costs[:d] - costs[d:]) / (2 * STEP)
    slopes = (violations[:d] - violations[d:]) / (2 * STEP)
    now = pieces(point[None])[1][0]
    names, columns, units = [], [], []
    for i, (c, limit) in enumerate(limits.items()):
        if now[i] > -AT_LIMIT:
            names.append(f"{c.output} {c.side}")
            columns.append(slopes[:, i])
            units.append(abs(limit) or 1.0)
    for i, v in enumerate(problem.variables):
        for side, reached, sign in (("min", point[i] < AT_LIMIT, -1.0),
                                    ("max", point[i] > 1.0 - AT_LIMIT, 1.0)):
            if reached:
                names.append(f"{v.key} {side}")
                columns.append(sign * np.eye(d)[i])
                units.append(v.highest - v.lowest)
    size = np.linalg.norm(slope)
    if not names or size == 0.0 or not np.isfinite(slope).all():
        return {}, 1.0 if size > 0.0 else 0.0
    multipliers, rest = nnls(np.stack(columns, axis=1), -slope)
    worth = multipliers * scale / np.array(units)
    return dict(zip(names, worth.tolist(), strict=True)), float(rest / size)
