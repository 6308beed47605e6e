"""Figure 7 drawn: both panels, beside them what the paper's text states, below them the coupling.

The paper's own curves are not at hand. Its text says that the test reached 12 degrees along the
span and 35 along the chord, and that beyond 25 kPa the test is softer than the paper's
finite-element model; that is drawn, and no more.
"""

from __future__ import annotations

import os
import pathlib
from collections.abc import Mapping
from typing import TYPE_CHECKING

import matplotlib
import numpy as np
import pandas as pd
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from morphing_wing.curves import AXES, COLOURS, STYLE, save_figure
from morphing_wing.figure7_facts import KEYS, PANELS, Panel

if TYPE_CHECKING:
    from matplotlib.axes import Axes

__all__ = ["draw", "figure"]

SOFTER_FROM_KPA = 25.0
TITLES = {"pressure": "B-1   Pressure bends the span", "cables": "B-2   Cables bend the chord"}
SYMBOLS = {"span_angle_deg": r"$\varphi_1$", "chord_angle_deg": r"$\varphi_2$"}
SKINS = {True: ("with skin", COLOURS[0]), False: ("without skin", COLOURS[1])}
MARKERS = {"draft": "o", "standard": "s", "reference": "D"}
_DASHES = (0, (4, 2))
_STATED = "#6b6b6b"
_SOFTER = "#ede6d3"


def draw(
    table: pd.DataFrame, file: str | os.PathLike, stopped: Mapping[tuple, str] | None = None
) -> pathlib.Path:
    """Draw a study's table into a file. Call on rank 0.

    Parameters
    ----------
    table
        See `figure7.Figure7.table`.
    file
        PNG, PDF or SVG by its suffix.
    stopped
        Curves, by (panel, skin, direction, fidelity), that ended before their last load.
    """
    with matplotlib.rc_context(STYLE):
        return save_figure(figure(table, stopped or {}), file)


def figure(table: pd.DataFrame, stopped: Mapping[tuple, str]) -> Figure:
    """Return the figure: two panels, below each the angle that its load should leave alone."""
    made = Figure(figsize=(12.4, 8.4), dpi=150, layout="constrained")
    FigureCanvasAgg(made)
    made.get_layout_engine().set(w_pad=0.12, h_pad=0.06, wspace=0.03)
    axes = made.subplots(2, 2, sharex="col", height_ratios=[2.7, 1.0])
    for (above, below), (name, panel) in zip(axes.T, PANELS.items(), strict=True):
        rows = table[table["panel"] == name]
        for key, curve in rows.groupby(KEYS, sort=False):
            end = key in stopped
            _curve(above, panel, curve, panel.line, light=True)
            _curve(above, panel, curve, panel.space, light=True, linestyle=":")
            _curve(above, panel, curve, panel.angle, end=end)
            _curve(below, panel, curve, panel.other, end=end)
        _stated(above, name, panel, both_ways=rows["direction"].nunique() > 1,
                up=set(rows["direction"]) == {"up"})
        above.set_title(TITLES[name], loc="left", fontweight="bold", fontsize=12.5)
        above.set_ylabel(f"{SYMBOLS[panel.angle]}, degrees (down: positive)")
        below.set_ylabel(f"{SYMBOLS[panel.other]} caused\nby {name}, deg")
        below.set_xlabel(AXES[panel.load][1])
        below.set_xlim(left=0.0)
        for each in (above, below):
            each.axhline(0.0, color="#999", linewidth=0.8, zorder=0.5)
    made.legend(handles=_legend(table, stopped), loc="outside lower center", ncols=3,
                fontsize=10, handlelength=3.2, columnspacing=2.5)
    return made


def _curve(
    axes: Axes, panel: Panel, curve: pd.DataFrame, column: str | None, light: bool = False,
    end: bool = False, linestyle: str = "-",
) -> None:
    """Draw one curve from rest; dashed from where the skin passes through something."""
    if column not in curve or curve[column].isna().all():
        return
    x, y = panel.factor * curve["load"].to_numpy(float), curve[column].to_numpy(float)
    colour = SKINS[bool(curve["skin"].iloc[0])][1]
    marker = MARKERS.get(curve["fidelity"].iloc[0], "v")
    flags = {name: curve[name].to_numpy(float) > 0.0 if name in curve else np.zeros(len(x), bool)
             for name in ("contact", "negative_pivots")}
    open_marker = marker == "o"  # of the coarsest: it lies on top, finer ones show through
    look = {"color": colour, "linewidth": 0.9 if light else 1.5 if open_marker else 2.2,
            "alpha": 0.75 if light else 1.0}
    into_contact = flags["contact"] | np.append(flags["contact"][1:], False)
    axes.plot(x, np.where(flags["contact"], np.nan, y), linestyle=linestyle, **look)
    axes.plot(x, np.where(into_contact, y, np.nan), linestyle=_DASHES, **look)
    if light:
        return
    asked = curve["requested"].to_numpy(bool)
    axes.plot(x[asked], y[asked], linestyle="none", marker=marker, color=colour,
              markersize=8.0 if open_marker else 4.5, zorder=3.0 if open_marker else 2.5,
              markerfacecolor="none" if open_marker else colour)
    unstable = flags["negative_pivots"]
    axes.plot(x[unstable], y[unstable], linestyle="none", marker="x", markersize=10, color="k")
    if end:
        axes.plot(x[-1:], y[-1:], linestyle="none", marker="|", markersize=18, color=colour,
                  markeredgewidth=2.5)


def _stated(axes: Axes, name: str, panel: Panel, both_ways: bool, up: bool) -> None:
    """Draw what the paper's text states: outside of the axes, where no curve can be."""
    for sign in (1, -1) if both_ways else (-1,) if up else (1,):
        axes.axhline(sign * panel.limit_deg, color=_STATED, linestyle=":", linewidth=1.6)
        axes.annotate(f"reached in\nthe test:\n{sign * panel.limit_deg:g}\N{DEGREE SIGN}"
                      .replace("-", "\N{MINUS SIGN}"),
                      (1.0, sign * panel.limit_deg), (5, 0), ("axes fraction", "data"),
                      textcoords="offset points", va="center", fontsize=9.5, color=_STATED)
    if name != "pressure":
        return
    right = max(axes.get_xlim()[1], SOFTER_FROM_KPA + 5.0)
    axes.axvspan(SOFTER_FROM_KPA, right, color=_SOFTER, zorder=0.1, linewidth=0.0)
    axes.set_xlim(right=right)
    # Between the axis and the curves, which have left it long before 25 kPa.
    axes.annotate(f"beyond {SOFTER_FROM_KPA:g} kPa\nthe test is softer than\nthe paper's FEM",
                  (0.5 * (SOFTER_FROM_KPA + right), 0.0), (0, -7 if up else 7), "data",
                  textcoords="offset points", ha="center", va="top" if up else "bottom",
                  fontsize=9.0, color="#7a6a35", linespacing=1.15)


def _legend(table: pd.DataFrame, stopped: Mapping[tuple, str]) -> list[Line2D]:
    """Return what is in the figure, each thing once."""
    entries = [Line2D([], [], color=colour, linewidth=2.0, label=label)
               for skin, (label, colour) in SKINS.items() if skin in set(table["skin"])]
    entries += [Line2D([], [], color="#333", marker=MARKERS.get(name, "v"),
                       linewidth=1.5 if MARKERS.get(name) == "o" else 2.2,
                       markersize=8.0 if MARKERS.get(name) == "o" else 4.5,
                       markerfacecolor="none" if MARKERS.get(name) == "o" else "#333",
                       label=f"fidelity \u201c{name}\u201d")
                for name in dict.fromkeys(table["fidelity"])]
    entries += [
        Line2D([], [], color="#333", linewidth=2.0, label="rotation of the end face"),
        Line2D([], [], color="#333", linewidth=0.9, label="deflection line: perhaps what was read"),
    ]
    spaces = [panel.space for panel in PANELS.values() if panel.space in table]
    if table[spaces].notna().any(axis=None):
        entries.append(Line2D([], [], color="#333", linewidth=0.9, linestyle=":",
                              label="trailing edge against the horizontal: or this"))
    if "contact" in table and table["contact"].any():
        entries.append(Line2D([], [], color="#333", linewidth=2.0, linestyle=_DASHES,
                              label="no contact forces: skin passes through"))
    if "negative_pivots" in table and (table["negative_pivots"] > 0).any():
        entries.append(Line2D([], [], color="k", linestyle="none", marker="x", markersize=10,
                              label="unstable"))
    if stopped:
        entries.append(Line2D([], [], color="#333", linestyle="none", marker="|", markersize=18,
                              markeredgewidth=2.5, label="stopped before the last load"))
    return entries
