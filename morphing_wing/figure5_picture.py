"""Figure 5 drawn: formulas against finite elements, and below how far they are apart."""

from __future__ import annotations

import os
import pathlib
from typing import TYPE_CHECKING

import matplotlib
import numpy as np
import pandas as pd
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure

from morphing_wing.curves import AXES, STYLE, save_figure
from morphing_wing.figure5_curves import COLUMNS, Curve, points_of
from morphing_wing.level_picture import look

if TYPE_CHECKING:
    from matplotlib.axes import Axes

__all__ = ["draw"]

TITLES = {"spar": "B-1   Spar, bent by pressure", "rib": "B-2   Rib, bent by an end moment"}
SYMBOLS = {"spar": r"$\varphi_1$", "rib": r"$\varphi_2$"}


def draw(table: pd.DataFrame, file: str | os.PathLike) -> pathlib.Path:
    """Draw a study's table into a PNG, PDF or SVG file. Call on rank 0."""
    with matplotlib.rc_context(STYLE):
        figure = Figure(figsize=(11.0, 7.4), dpi=150, layout="constrained")  # no display
        FigureCanvasAgg(figure)
        figure.get_layout_engine().set(w_pad=0.12, h_pad=0.06, wspace=0.03)
        axes = figure.subplots(2, 2, sharex="col", height_ratios=[2.5, 1.0])
        for (above, below), scene in zip(axes.T, COLUMNS, strict=True):
            _half(above, below, table[table["scene"] == scene], scene)
        return save_figure(figure, file)


def _half(above: Axes, below: Axes, table: pd.DataFrame, scene: str) -> None:
    curves = [Curve(*key) for key in dict.fromkeys(
        table[list(Curve._fields)].itertuples(index=False, name=None))]
    fidelities = list(dict.fromkeys(curve.fidelity for curve in curves))
    readings = list(dict.fromkeys(curve.reading for curve in curves))
    factor, text = AXES[COLUMNS[scene][0]]
    for curve in curves:
        # The formula keeps its open triangles, whatever else is drawn.
        marker = 0 if curve.fidelity == "instant" else 1 + [
            name for name in fidelities if name != "instant"].index(curve.fidelity)
        colour = readings.index(curve.reading) if len(readings) > 1 else marker
        drawn = look(marker, colour)
        load, angle = points_of(table, curve)
        label = "formula" if curve.fidelity == "instant" else f"\u201c{curve.fidelity}\u201d"
        label += f", section \u201c{curve.reading}\u201d" if curve.reading else ""
        above.plot(factor * np.append(0.0, load), np.append(0.0, angle), label=label, **drawn)
        theirs_at, theirs = points_of(table, curve._replace(fidelity="instant"))
        if marker and len(theirs):
            below.plot(factor * load, 100.0 * (np.interp(load, theirs_at, theirs) / angle - 1.0),
                       **drawn)
    above.set_title(TITLES[scene], loc="left", fontweight="bold", fontsize=12.5)
    above.set_ylabel(f"{SYMBOLS[scene]}, degrees")
    if curves:  # a half may not have been run yet
        above.legend(loc="lower right", fontsize=10, handlelength=3.0)
    above.set_ylim(bottom=0.0)
    above.set_xlim(left=0.0)
    below.axhline(0.0, color="#999", linewidth=0.8, zorder=0.5)
    below.set_ylabel("formula against\nfinite elements, %")
    below.set_xlabel(text)
    below.margins(y=0.25)
