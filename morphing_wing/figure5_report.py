"""The facts of Figure 5 as a table for a terminal."""

from __future__ import annotations

from typing import Any

from rich.table import Table

from morphing_wing.figure5_curves import Curve
from morphing_wing.terminal_tables import text_table

__all__ = ["report"]

_UNITS = {"spar": (1000.0, "kPa"), "rib": (1.0, "N mm")}


def report(facts: list[dict[str, Any]]) -> Table:
    """Return a table of the curves; see `figure5.Figure5.facts`."""
    rows = []
    for fact in facts:
        factor, unit = _UNITS[fact["scene"]]
        rows.append([
            str(Curve(fact["scene"], fact["fidelity"], fact["reading"])),
            f"{fact['slope'] / factor:.4f} deg/{unit}",
            f"{fact['last_angle_deg']:.2f} deg at {fact['last_load'] * factor:g} {unit}",
            f"{100 * fact['off_line']:+.2f} %",
            *(f"{100 * fact[name]:+.1f} %" if name in fact else "-"
              for name in ("formula_first", "formula_last"))])
    return text_table(
        "Figure 5: formulas against finite elements (the paper's own curves are not at hand)",
        ["curve", "slope at first", "last point", "off the first slope", "formula, first load",
         "formula, last load"], rows)
