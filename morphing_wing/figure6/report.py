"""Figure 6 for a terminal: how the angles answer to each factor, and what the paper says of it."""

from __future__ import annotations

from collections.abc import Iterator

import pandas as pd
from rich.table import Table

from morphing_wing.figure5_curves import Curve
from morphing_wing.terminal_tables import text_table

from .points import PANELS
from .result import Figure6

__all__ = ["report"]


def report(study: Figure6) -> Iterator[Table | str]:
    """Yield the sensitivities of each half as tables, then the claims and what else is to tell."""
    found = study.sensitivities()
    for scene, rows in found.groupby("scene", sort=False):
        panel = PANELS[scene]
        yield text_table(
            f"Figure 6{panel.letter}, {panel.title}: one factor at a time about "
            + ", ".join(panel.at(*level) for level in panel.middle.items()),
            ["series", "factor", "slope, deg", "first, last", "% per %",
             f"range, {panel.table.heading}", "all points", "off straight", "trend"],
            [[", ".join(filter(None, (row.fidelity, row.reading))), row.factor,
              _or(row.slope, "{:+.3g}") + (f" / {_short(row.unit)}" if row.unit else ""),
              _or(row.first_slope, "{:+.3g}") + ", " + _or(row.last_slope, "{:+.3g}"),
              _or(row.elasticity, "{:+.2f}"), _or(row.table_range_deg, "{:.2f} deg"),
              _or(row.range_deg, "{:.2f} deg"), _or(row.off_straight, "{:.0%}"), row.trend]
             for row in rows.itertuples()])
    said = None
    for claim in sorted(study.claims(), key=lambda claim: (claim["scene"] != "spar",
                                                           claim["claim"])):
        if claim["claim"] != said:
            said = claim["claim"]
            yield f"The paper says: {said}."
        curve = Curve(*(claim[name] for name in Curve._fields))
        yield f"  {curve}: {'so it is' if claim['holds'] else 'not so'}: {claim['figures']}."
    yield from study.sentences()


def _short(unit: str) -> str:
    return {"degrees": "deg"}.get(unit, unit)


def _or(value: float, form: str) -> str:
    return "-" if pd.isna(value) else form.format(value)
