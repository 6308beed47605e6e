"""An orthogonal experiment drawn: the mean of each level, a panel a factor, and all rows below."""

from __future__ import annotations

import os
import pathlib
from typing import TYPE_CHECKING, Any

import matplotlib
import numpy as np
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure

from morphing_wing.curves import COLOURS, STYLE, save_figure

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from morphing_wing.table_study import Series, TableStudy

__all__ = ["draw", "look"]

# Markers and lines by the order of fidelities: the cheapest first, as they are asked for.
LOOKS = (("^", (0, (4, 2))), ("o", "-"), ("D", "-."), ("v", ":"), ("P", (0, (1, 1))))
# Broad and light, below all others, so that what lies on it is seen.
_PRINTED = {"color": "#bdbdb6", "marker": "s", "markersize": 11, "linewidth": 6.0,
            "markerfacecolor": "white", "markeredgecolor": "#111", "markeredgewidth": 1.4}
_SYMBOLS = {"span_angle_deg": r"$\varphi_1$", "chord_angle_deg": r"$\varphi_2$"}


def look(marker: int, colour: int) -> dict[str, Any]:
    """Return how to draw a curve: the first marker is open and dashed, for the formula."""
    shape, line = LOOKS[marker % len(LOOKS)]
    paint = COLOURS[colour % len(COLOURS)]
    return {"color": paint, "marker": shape, "linestyle": line, "markersize": 6.5,
            "markerfacecolor": "white" if marker == 0 else paint, "markeredgewidth": 1.6}


def draw(study: TableStudy, file: str | os.PathLike) -> pathlib.Path:
    """Draw a study into a PNG, PDF or SVG file. Call on rank 0."""
    printed, levels = study.printed, study.levels()
    with matplotlib.rc_context(STYLE):
        figure = Figure(figsize=(11.0, 8.2), dpi=150, layout="constrained")  # no display
        FigureCanvasAgg(figure)
        figure.get_layout_engine().set(w_pad=0.08, h_pad=0.08)
        grid = figure.add_gridspec(2, len(printed.factors), height_ratios=[1.25, 1.0])
        first = None
        for number, (factor, text) in enumerate(printed.factors.items()):
            axes = first = figure.add_subplot(grid[0, number], sharey=first)
            _means(axes, study, levels[levels["factor"] == factor])
            axes.set_xlabel(text, fontsize=12.5)
            axes.tick_params(labelleft=number == 0)
            if number == 0:
                axes.set_ylabel(f"mean {_SYMBOLS[printed.angle]} of a level, degrees")
        axes = figure.add_subplot(grid[1, :])
        _rows(axes, study)
        axes.set_ylabel(f"{_SYMBOLS[printed.angle]} of a row, degrees")
        handles, labels = axes.get_legend_handles_labels()
        figure.suptitle(f"{printed.heading}: {printed.title}", x=0.01, ha="left",
                        fontweight="bold", fontsize=13)
        figure.legend(handles, labels, loc="outside lower center", ncols=min(3, len(labels)),
                      fontsize=10, handlelength=2.0, columnspacing=1.6)
        return save_figure(figure, file)


def _means(axes: Axes, study: TableStudy, levels: Any) -> None:
    """Draw one factor's means, and where the paper misprints one, that as a cross."""
    for key, rows in levels.groupby(study.keys, sort=False):
        known = [series for series in study.parts if series[: len(key)] == key]
        drawn = _look(study, known[0]) if known else _PRINTED
        axes.plot(np.arange(len(rows)), rows["mean_deg"], zorder=3.0 if known else 2.0, **drawn)
    names = list(dict.fromkeys(levels["level"]))
    axes.set_xticks(range(len(names)), names)
    axes.margins(x=0.12)
    misprints = study.printed.misprints
    for slip in misprints[misprints["factor"] == levels["factor"].iloc[0]].itertuples():
        place = names.index(slip.level), slip.stated_mean_deg
        axes.plot(*place, "x", color="#b00000", markersize=9, markeredgewidth=2.2, zorder=4)
        axes.annotate(f"misprint\n{slip.stated_mean_deg:.3f}", place, (0, 10), "data",
                      textcoords="offset points", ha="center", va="bottom", color="#b00000",
                      fontsize=9.5)


def _rows(axes: Axes, study: TableStudy) -> None:
    """Draw all rows side by side; what is printed as a bar."""
    printed = study.printed
    cases = printed.cases
    x = np.arange(len(cases))
    axes.bar(x, cases["printed_deg"], width=0.72, color="#e3e3df", edgecolor="#111", linewidth=1.2,
             label="printed in the paper", zorder=1.5)
    for number, (series, part) in enumerate(study.parts.items()):
        drawn = _look(study, series) | {"linestyle": "none"}  # rows have no order
        label = str(series)
        if "fitted_torque_Nmm" in part:
            label += f" (fitted: {part['fitted_torque_Nmm'].iloc[0]:.1f} N mm)"
        shift = 0.13 * (number - 0.5 * (len(study.parts) - 1))
        axes.plot(x + shift, part[printed.angle], label=label, zorder=3, **drawn)
    names = ["\n".join([f"row {case['row']}" if case["printed_deg"] > 0 else "untested",
                        *(case[factor] for factor in printed.factors)])
             for case in cases.to_dict("records")]
    symbols = "\n".join(["", *(text.split(",")[0] for text in printed.factors.values())])
    axes.grid(False, axis="x")
    axes.set_xticks([-0.8, *x], [symbols, *names], fontsize=9.5)
    axes.set_xlim(-0.8, len(x) - 0.4)
    axes.set_ylim(bottom=0.0)
    axes.tick_params(axis="x", length=0)


def _look(study: TableStudy, series: Series) -> dict[str, Any]:
    """Return colour by reading, or by fidelity where there is one reading; marker by fidelity."""
    fidelities = list(dict.fromkeys(s.fidelity for s in study.parts))
    readings = list(dict.fromkeys(s.reading for s in study.parts))
    place = fidelities.index(series.fidelity)
    return look(place, readings.index(series.reading) if len(readings) > 1 else place)
