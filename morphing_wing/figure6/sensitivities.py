"""How an angle answers to each factor of Figure 6: slopes, ranges, how straight its curve is."""

from __future__ import annotations

from typing import Any

import numpy as np
import pandas as pd

from .points import Panel, value_of

__all__ = ["sensitivities"]


def sensitivities(part: pd.DataFrame, panel: Panel) -> list[dict[str, Any]]:
    """Return one dict a factor, of the points that are known.

    Parameters
    ----------
    part
        Points of a series: columns ``factor``, ``value`` and the angle in degrees.
    panel
        The half of the figure that it is of.

    Returns
    -------
    list of dict
        ``factor``; ``range_deg`` over all points, and ``table_range_deg`` over the levels that the
        paper's table has; ``slope`` at the middle level, degrees per unit of the factor, and
        ``elasticity``, the same in per cent of the angle per per cent of the factor: by the
        parabola through the middle level and its neighbours; ``trend``: "rises", "falls" or
        "turns"; ``off_straight``, the largest distance from the straight line through both ends,
        relative to the range; ``first_slope`` and ``last_slope``, degrees per unit between the
        first two and the last two points; ``power``, the exponent of the power of the factor that
        fits best (least squares of logarithms). Not a number where points are missing.
    """
    found = []
    for factor, rows in part.groupby("factor", sort=False):
        middle = value_of(panel.middle[factor])
        known = rows[rows[panel.table.angle].notna()].sort_values("value")
        x, y = known["value"].to_numpy(float), known[panel.table.angle].to_numpy(float)
        tabled = known[factor].isin(panel.tabled[factor])
        fact = {"factor": factor, "unit": panel.units[factor], "points": len(known),
                **dict.fromkeys(_NUMBERS, np.nan), "trend": ""}
        if tabled.sum() == len(panel.tabled[factor]):
            fact["table_range_deg"] = float(np.ptp(y[tabled]))
        if 0 < (place := int(np.searchsorted(x, middle))) < len(x) - 1 and x[place] == middle:
            slope = np.gradient(y[place - 1:place + 2], x[place - 1:place + 2])[1]
            fact |= {"slope": slope, "elasticity": slope * middle / y[place]}
        if len(known) > 1:
            steps = np.diff(y) / np.diff(x)
            straight = y[0] + (y[-1] - y[0]) * (x - x[0]) / (x[-1] - x[0])
            fact |= {
                "range_deg": float(np.ptp(y)), "first_slope": steps[0], "last_slope": steps[-1],
                "off_straight": np.abs(y - straight).max() / np.ptp(y) if np.ptp(y) else 0.0,
                "power": np.polyfit(np.log(x), np.log(y), 1)[0],
                "trend": "rises" if (steps > 0).all() else "falls" if (steps < 0).all()
                else "turns"}
        found.append(fact)
    return found


_NUMBERS = ("table_range_deg", "range_deg", "slope", "elasticity", "off_straight", "first_slope",
            "last_slope", "power")
