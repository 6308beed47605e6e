"""Which rungs no other one beats, as a column and as a picture."""

from __future__ import annotations

import os
from typing import Any

import pandas as pd

__all__ = ["beaten_by", "draw"]

CASE = ["case", "n_cells", "load"]


def beaten_by(table: pd.DataFrame) -> list[str]:
    """Return of each row the rung that is both cheaper and more accurate in its case, or ""."""
    names = []
    for _, this in table.iterrows():
        same = table[(table[CASE] == this[CASE]).all(axis=1)]
        better = same[(same["seconds"] < this["seconds"])
                      & (same["error"].abs() < abs(this["error"]))]
        names.append("" if better.empty else better.sort_values("seconds")["fidelity"].iloc[-1])
    return names


def draw(table: pd.DataFrame, title: str, file: str | os.PathLike) -> None:
    """Draw error against seconds, one line a case, through the rungs that none beats."""
    from matplotlib.figure import Figure

    figure = Figure(figsize=(7.5, 5.0), layout="constrained")
    axes = figure.add_subplot()
    timed = table.dropna(subset=["seconds"])
    for i, (case, rows) in enumerate(timed.groupby(CASE, sort=False)):
        label = "{}, N = {}, {}".format(*case)
        _draw_case(axes, rows.sort_values("seconds"), f"C{i}", label)
    axes.margins(x=0.15)  # for the last one's name
    axes.set(xscale="log", yscale="log", xlabel="seconds, build and solve",
             ylabel="error of the angle, %", title=title)
    axes.grid(alpha=0.3, which="both")
    axes.legend(fontsize=8, title="filled: no rung is both faster and nearer")
    figure.savefig(file, dpi=150)


def _draw_case(axes: Any, rows: pd.DataFrame, colour: str, label: str) -> None:
    percent = 100.0 * rows["error"].abs()
    best = rows["beaten_by"] == ""
    axes.plot(rows["seconds"][best], percent[best], "-", color=colour, label=label)
    for points, filled in ((best, colour), (~best, "white")):
        axes.plot(rows["seconds"][points], percent[points], "o", color=colour, mfc=filled)
    for name, x, y in zip(rows["fidelity"], rows["seconds"], percent, strict=True):
        axes.annotate(name, (x, y), xytext=(5, 5), textcoords="offset points", fontsize=8)
