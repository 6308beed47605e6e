"""The paper's Tables 2 and 3 as printed, and where they contradict their own rows."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from importlib import resources

import pandas as pd

from .range_analysis import best_levels, range_analysis

__all__ = ["TABLE_2", "TABLE_3", "PrintedTable"]

ROUNDING = 0.006
"""Degrees by which a printed mean may differ from that of its rows."""


@dataclass(frozen=True)
class PrintedTable:
    """An orthogonal experiment of the paper.

    Attributes
    ----------
    name
        "table2" or "table3": of the files in ``printed/`` too.
    title
        What it is of.
    scene
        Whose ladder of fidelities it can be computed with.
    angle
        Column of a scene's measures that it is of.
    factors
        Column -> symbol and unit; levels are text as printed.
    stated_best
        Levels that the paper's Section 4 calls the best combination.
    """

    name: str
    title: str
    scene: str
    angle: str
    factors: Mapping[str, str]
    stated_best: Mapping[str, str]

    @property
    def heading(self) -> str:
        """The table's number: "Table 2"."""
        return f"Table {self.name[-1]}"

    @cached_property
    def rows(self) -> pd.DataFrame:
        """``row``, the factors' levels and ``printed_deg``, one line a test."""
        return self._read(self.name, list(self.factors))

    @cached_property
    def stated(self) -> pd.DataFrame:
        """``stated_mean_deg`` of each level and ``stated_range_deg`` of its factor, as printed."""
        return self._read(f"{self.name}_means", ["level"])

    @cached_property
    def levels(self) -> pd.DataFrame:
        """Range analysis of the printed rows."""
        return range_analysis(self.rows, list(self.factors), "printed_deg")

    @cached_property
    def untested(self) -> dict[str, str] | None:
        """The levels of the largest means, where no row has them together; else None."""
        best = best_levels(self.levels)
        return None if (self.rows[list(best)] == pd.Series(best)).all(axis=1).any() else best

    @cached_property
    def cases(self) -> pd.DataFrame:
        """The rows, and after them the untested combination of the best levels, if there is one."""
        if self.untested is None:
            return self.rows
        extra = pd.DataFrame([{"row": len(self.rows) + 1, **self.untested}])
        return pd.concat([self.rows, extra], ignore_index=True)

    @cached_property
    def misprints(self) -> pd.DataFrame:
        """The levels whose printed mean is not that of their rows."""
        both = self.levels.merge(self.stated, on=["factor", "level"])
        return both[(both["stated_mean_deg"] - both["mean"]).abs() > ROUNDING]

    def slips(self) -> list[str]:
        """Return in sentences where the table's means and best combination are not its rows'."""
        found = [
            f"Misprint: {self.heading} has {m.stated_mean_deg:.3f} as the mean of {m.factor} = "
            f"{m.level}; its rows give {m.mean:.3f}, so that R is {m.range:.3f}, not "
            f"{m.stated_range_deg:.3f}." for m in self.misprints.itertuples()]
        if self.untested is not None:
            best = self.rows.loc[self.rows["printed_deg"].idxmax()]
            found.append(
                f"The paper's \"best combination\", {words(self.stated_best)}, is the best of the "
                f"rows tested ({best['row']}, {best['printed_deg']:.2f} deg); the largest means "
                f"are those of {words(self.untested)}, which no row has.")
        return found

    def _read(self, name: str, text: Sequence[str]) -> pd.DataFrame:
        with (resources.files("morphing_wing") / "printed" / f"{name}.csv").open() as file:
            return pd.read_csv(file, dtype=dict.fromkeys(text, str))


def words(levels: Mapping[str, str]) -> str:
    """Return levels in words: ``l_c = 2.4, h_t = 1.0``."""
    return ", ".join(f"{factor} = {level}" for factor, level in levels.items())


TABLE_2 = PrintedTable(
    "table2", "nine spars at 20 kPa", "spar", "span_angle_deg",
    {"l_s1": "$l_{s1}$, mm", "l_c": "$l_{c}$, mm", "h_t": "$h_{t}$, mm"},
    {"l_s1": "2.4", "l_c": "2.4", "h_t": "1.0"})
TABLE_3 = PrintedTable(
    "table3", "nine ribs under one end moment, which is fitted", "rib", "chord_angle_deg",
    {"alpha": r"$\alpha$, degrees", "T_rs/l_cs": "$T_{rs}/l_{cs}$", "D_cs/l_rs": "$D_{cs}/l_{rs}$"},
    {"alpha": "80", "T_rs/l_cs": "1/5", "D_cs/l_rs": "1.5/8.5"})
