"""Which spars and ribs Figure 6 is of: one factor at a time, the others at their middle levels.

The text says which factors, not which values. Each factor gets six: the three levels of the paper's
Table 2 or 3 and three more in the same steps (alpha and the lengths) or half of them (T_rs/l_cs),
three values below the middle level and two above. So three rows of each table, those with two
middle levels, are among the points.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property

import pandas as pd

from morphing_wing.printed_tables import TABLE_2, TABLE_3, PrintedTable

__all__ = ["PANELS", "Panel", "value_of"]


@dataclass(frozen=True)
class Panel:
    """One half of the figure.

    Attributes
    ----------
    letter, title
        As it is headed.
    table
        The paper's table of the same factors, angle and load.
    levels
        Of each factor its levels, as the table prints them, from the smallest to the largest.
    units
        Of each factor its unit, "" for none.
    """

    letter: str
    title: str
    table: PrintedTable
    levels: Mapping[str, tuple[str, ...]]
    units: Mapping[str, str]

    @cached_property
    def tabled(self) -> dict[str, list[str]]:
        """Of each factor the levels that the table has, from the smallest to the largest."""
        return {factor: sorted(set(self.table.rows[factor]), key=value_of)
                for factor in self.levels}

    @cached_property
    def middle(self) -> dict[str, str]:
        """The middle level of each factor."""
        return {factor: levels[1] for factor, levels in self.tabled.items()}

    @cached_property
    def points(self) -> pd.DataFrame:
        """One row a point: ``factor``, ``value``, the levels; ``row`` and ``printed_deg`` if any.

        The middle of all factors is a point of each of them.
        """
        points = pd.DataFrame([
            {"factor": factor, "value": value_of(level), **self.middle, factor: level}
            for factor, levels in self.levels.items() for level in levels])
        return points.merge(self.table.rows, "left", on=list(self.levels))

    def at(self, factor: str, level: str) -> str:
        """Return a point in words: ``h_t = 1.2 mm``."""
        return f"{factor} = {level} {self.units[factor]}".rstrip()


def value_of(level: str) -> float:
    """Return the number of a level; ratios are printed as two lengths: ``"1.5/5"``."""
    over, *under = map(float, level.split("/"))
    return over / under[0] if under else over


PANELS = {
    "spar": Panel(
        "A", "spar at 20 kPa", TABLE_2,
        {"l_s1": ("1.6", "1.8", "2.0", "2.2", "2.4", "2.6"),
         "l_c": ("1.2", "1.6", "2.0", "2.4", "2.8", "3.2"),
         "h_t": ("0.6", "0.8", "1.0", "1.2", "1.4", "1.6")},
        {"l_s1": "mm", "l_c": "mm", "h_t": "mm"}),
    "rib": Panel(
        "B", "rib under an end moment, fitted to three rows of Table 3", TABLE_3,
        {"alpha": ("60", "70", "80", "90", "100", "110"),
         "T_rs/l_cs": ("0.75/5", "1/5", "1.25/5", "1.5/5", "1.75/5", "2/5"),
         "D_cs/l_rs": ("1.5/9.5", "1.5/8.5", "1.5/7.5", "1.5/6.5", "1.5/5.5", "1.5/4.5")},
        {"alpha": "degrees", "T_rs/l_cs": "", "D_cs/l_rs": ""}),
}
"""By scene."""
