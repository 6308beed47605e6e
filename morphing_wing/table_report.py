"""A table of the paper, computed and printed side by side, for a terminal."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

import pandas as pd
from rich.table import Table

from morphing_wing.terminal_tables import text_table

if TYPE_CHECKING:
    from morphing_wing.table_study import TableStudy

__all__ = ["report"]


def report(study: TableStudy) -> Iterator[Table | str]:
    """Yield the rows, the level means and the misfits as tables, then sentences."""
    printed = study.printed
    yield text_table(
        f"{printed.heading}, {printed.title}: degrees, and against the printed ones",
        ["row", *printed.factors, "printed", *map(str, study.parts)],
        [[str(case["row"]), *(case[factor] for factor in printed.factors),
          _or(case["printed_deg"], "{:.2f}", "not tested"),
          *(_angle(part.iloc[i], printed.angle) for part in study.parts.values())]
         for i, case in enumerate(printed.cases.to_dict("records"))])
    yield _levels(study)
    yield text_table(
        "Against the printed rows, relatively", ["", "rms", "mean", "largest", "end moment"],
        [[", ".join(fact[key] for key in study.keys),
          *(_or(fact.get(name), "{:.2%}", "-") for name in ("rms", "mean")),
          _or(fact.get("largest"), "{:.2%}", "-") + f", row {fact.get('largest_in_row', '-')}",
          _or(fact.get("fitted_torque_Nmm"), "{:.2f} N mm, fitted", "none: nothing is fitted")]
         for fact in study.misfits()])
    yield from study.sentences()


def _levels(study: TableStudy) -> Table:
    """Return level means, and below those of each factor R and its share of the squares."""
    levels = study.levels()
    found = {", ".join(filter(None, key)): part for key, part in levels.groupby(study.keys,
                                                                                sort=False)}
    rows = []
    for factor in study.printed.factors:
        parts = [part[part["factor"] == factor] for part in found.values()]
        for i, level in enumerate(parts[0]["level"]):
            rows.append([factor, level, *(f"{part['mean_deg'].iloc[i]:.2f}" for part in parts)])
        first = [part.iloc[0] for part in parts]
        rows.append(["", "R", *(f"{part['range_deg']:.2f}" for part in first)])
        rows.append(["", "squares", *(f"{part['sum_of_squares_deg2']:.1f} ({part['share']:.1%})"
                                      for part in first)])
    return text_table("Means of levels, degrees; R; sums of squares, deg^2, and their share",
                      ["factor", "level", *found], rows)


def _angle(row: pd.Series, angle: str) -> str:
    if not row[angle] > 0.0:
        return "refused" if row["refused"] else "stopped"
    off = row[angle] / row["printed_deg"] - 1.0
    return f"{row[angle]:.2f}" + _or(off, " ({:+.1%})" if abs(off) < 0.1 else " ({:+.0%})", "")


def _or(value: float | None, form: str, otherwise: str) -> str:
    return otherwise if value is None or pd.isna(value) else form.format(value)
