"""Figure 6 drawn: a row for the spar, one for the rib; in each the angle against three factors."""

from __future__ import annotations

import os
import pathlib
from collections.abc import Mapping
from typing import TYPE_CHECKING

import matplotlib
import pandas as pd
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure

from morphing_wing.curves import STYLE, save_figure
from morphing_wing.figure5_curves import Curve
from morphing_wing.level_picture import look

from .points import PANELS, Panel, value_of

if TYPE_CHECKING:
    from matplotlib.axes import Axes

__all__ = ["draw"]

SYMBOLS = {"spar": r"$\varphi_1$", "rib": r"$\varphi_2$"}

HIGHEST = 90.0
"""Degrees up to which is drawn: a larger angle, of bars that are too thin, is told in figures."""


def draw(parts: Mapping[Curve, pd.DataFrame], file: str | os.PathLike) -> pathlib.Path:
    """Draw the points of some series into a PNG, PDF or SVG file. Call on rank 0."""
    with matplotlib.rc_context(STYLE):
        scenes = [scene for scene in PANELS if any(curve.scene == scene for curve in parts)]
        figure = Figure(figsize=(11.0, 4.5 * len(scenes)), dpi=150, layout="constrained")
        FigureCanvasAgg(figure)  # no display
        figure.get_layout_engine().set(hspace=0.02)
        rows = figure.subfigures(len(scenes), 1, squeeze=False)[:, 0]
        for half, scene in zip(rows, scenes, strict=True):
            panel = PANELS[scene]
            axes = half.subplots(1, len(panel.levels), sharey=True)
            for each, factor in zip(axes, panel.levels, strict=True):
                _factor(each, panel, factor,
                        {curve: part for curve, part in parts.items() if curve.scene == scene})
            axes[0].set_ylabel(f"{SYMBOLS[scene]}, degrees")
            axes[0].set_ylim(0.0, min(axes[0].get_ylim()[1], HIGHEST))
            title = panel.title[0].upper() + panel.title[1:]
            half.suptitle(f"{panel.letter}   {title}", x=0.01, ha="left", fontweight="bold",
                          fontsize=12.5)
            levels, *curves = zip(*axes[0].get_legend_handles_labels(), strict=True)
            half.legend(*zip(*curves, levels, strict=True), loc="outside lower center",
                        ncols=4 if len(curves) < 4 else 3, fontsize=10, handlelength=3.0,
                        columnspacing=1.6)
        return save_figure(figure, file)


def _factor(
    axes: Axes, panel: Panel, factor: str, parts: Mapping[Curve, pd.DataFrame]
) -> None:
    fidelities = list(dict.fromkeys(curve.fidelity for curve in parts))
    readings = list(dict.fromkeys(curve.reading for curve in parts))
    tabled = [value_of(level) for level in panel.tabled[factor]]
    axes.axvspan(tabled[0], tabled[-1], color="#f1f1ec", zorder=0,
                 label=f"levels of {panel.table.heading}")
    axes.axvline(tabled[1], color="#9a9a92", linewidth=1.2, linestyle=(0, (2, 2)), zorder=1.5)
    for curve, part in parts.items():
        # The formula keeps its open triangles, whatever else is drawn.
        marker = 0 if curve.fidelity == "instant" else 1 + [
            name for name in fidelities if name != "instant"].index(curve.fidelity)
        colour = readings.index(curve.reading) if len(readings) > 1 else marker
        label = "formula" if curve.fidelity == "instant" else f"\u201c{curve.fidelity}\u201d"
        if curve.reading:
            moment = part["fitted_torque_Nmm"].iloc[0]
            label += f", section \u201c{curve.reading}\u201d"
            label += f", {moment:.1f} N mm" if moment > 0.0 else ""
        rows = part[part["factor"] == factor]
        drawn = look(marker, colour)
        axes.plot(rows["value"], rows[panel.table.angle], label=label, zorder=3, **drawn)
        for row in rows[rows[panel.table.angle] > HIGHEST].to_dict("records"):
            axes.annotate(f"\u2191{row[panel.table.angle]:.0f}", (row["value"], HIGHEST),
                          (-9, -10 - 11 * len(axes.texts)), textcoords="offset points",
                          color=drawn["color"], fontsize=8.5)
    points = panel.points[panel.points["factor"] == factor]
    axes.plot(points["value"], points["printed_deg"], "s", markersize=13, color="#111",
              markerfacecolor="none", markeredgewidth=1.3, zorder=4,
              label=f"printed in {panel.table.heading}")
    axes.set_xlabel(panel.table.factors[factor], fontsize=12.5)
    axes.margins(x=0.06)
