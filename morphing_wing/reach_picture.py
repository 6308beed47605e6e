"""The map of reachable angles drawn: lines of one pressure, lines of one tension, limits."""

from __future__ import annotations

import os
import pathlib
from typing import TYPE_CHECKING

import matplotlib
import numpy as np
import pandas as pd
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from morphing_wing.curves import COLOURS, STYLE, save_figure
from morphing_wing.materials import FRACTURE_STRETCH, YIELD_MPA

if TYPE_CHECKING:
    from matplotlib.axes import Axes

__all__ = ["draw", "figure"]

# Column -> (value at which it is a limit, what it is, colour).
LIMITS = {
    "rib_stress_MPa": (YIELD_MPA, f"resin yields ({YIELD_MPA:g} MPa)", COLOURS[3]),
    "largest_stretch": (FRACTURE_STRETCH, f"silicone tears (stretch {FRACTURE_STRETCH:g})",
                        COLOURS[4]),
    "glue_damage": (0.5, "glue gives way (half damaged)", COLOURS[2]),
    "negative_pivots": (0.5, "unstable", "k"),
    "contact": (0.5, "skin passes through itself or a rib", "#8a8a8a"),
}
CONTINUOUS = ("rib_stress_MPa", "largest_stretch", "glue_damage")  # the others say yes or no
FAMILIES = (("upper_MPa", COLOURS[0], 1000.0, "kPa"), ("cable_N", COLOURS[1], 1.0, "N"))


def draw(table: pd.DataFrame, file: str | os.PathLike) -> pathlib.Path:
    """Draw a map's table (`reach.Reach.table`) into a PNG, PDF or SVG. Call on rank 0."""
    with matplotlib.rc_context(STYLE):
        return save_figure(figure(table), file)


def figure(table: pd.DataFrame) -> Figure:
    """Return the figure."""
    made = Figure(figsize=(8.6, 7.4), dpi=150, layout="constrained")
    FigureCanvasAgg(made)
    axes = made.subplots()
    for (name, colour, factor, unit), (other, *_) in zip(FAMILIES, FAMILIES[::-1], strict=True):
        for value, line in table.groupby(name):
            line = line.sort_values(other)
            axes.plot(line["span_angle_deg"], line["chord_angle_deg"], color=colour, zorder=2)
            end = line.iloc[-1]
            axes.annotate(f"{factor * value:.3g} {unit}",
                          (end["span_angle_deg"], end["chord_angle_deg"]),
                          (0, 11) if name == "upper_MPa" else (13, 0), textcoords="offset points",
                          ha="center" if name == "upper_MPa" else "left",
                          va="bottom" if name == "upper_MPa" else "center",
                          color=colour, fontsize=9.5)
    axes.plot(table["span_angle_deg"], table["chord_angle_deg"], linestyle="none", marker="o",
              markersize=4.5, color="#333", zorder=3)
    axes.use_sticky_edges = False  # those of contours would cut the labels
    axes.margins(0.09)
    handles = [Line2D([], [], color=COLOURS[0], label="one pressure in the upper chambers"),
               Line2D([], [], color=COLOURS[1], label="one tension in each cable")]
    handles += [_limit(axes, table, name) for name in LIMITS if name in table]
    axes.set_xlabel(r"span $\varphi_1$, degrees (down: positive)")
    axes.set_ylabel(r"chord $\varphi_2$, degrees (down: positive)")
    axes.set_title("What pressure and cables reach together", loc="left", fontweight="bold",
                   fontsize=12.5)
    made.legend(handles=[h for h in handles if h is not None], loc="outside lower center", ncols=2,
                fontsize=9.5)
    return made


def _limit(axes: Axes, table: pd.DataFrame, name: str) -> Line2D | None:
    """Ring the points beyond a limit, draw where between them it is passed; return the legend's.

    None where no point is beyond.
    """
    limit, label, colour = LIMITS[name]
    beyond = table[name].astype(float) >= limit
    if not beyond.any():
        return None
    points = table[beyond]
    axes.plot(points["span_angle_deg"], points["chord_angle_deg"], linestyle="none", marker="o",
              markersize=8.0 + 2.5 * list(LIMITS).index(name), markerfacecolor="none",
              markeredgecolor=colour, markeredgewidth=1.4, zorder=2.5)
    columns = ("span_angle_deg", "chord_angle_deg", name)
    x, y, z = (table.pivot(index="upper_MPa", columns="cable_N", values=c).to_numpy(float)
               for c in columns)
    drawable = name in CONTINUOUS and min(x.shape) > 1 and bool(np.isfinite(x).all())
    if drawable and not beyond.all():
        axes.contour(x, y, z, levels=[limit], colors=[colour], linewidths=2.2, linestyles="--",
                     zorder=2.6)
    return Line2D([], [], color=colour, linestyle="--" if drawable else "none", marker="o",
                  markerfacecolor="none", markersize=9.0, markeredgewidth=1.4, label=label)
