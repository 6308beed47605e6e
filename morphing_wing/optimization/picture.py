"""An optimisation drawn: the goal over evaluations and rungs, bounds, limits, and the design."""

from __future__ import annotations

import os
import pathlib
from typing import TYPE_CHECKING, Any

import matplotlib
import numpy as np
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
from matplotlib.patches import Rectangle

from morphing_wing.curves import COLOURS, STYLE, save_figure

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from .optimum import Optimum

__all__ = ["draw"]

_OLD, _NEW, _PASSED = "#8a8a84", COLOURS[0], COLOURS[1]
_WORDS = {
    "span_angle_deg": r"$\varphi_1$, deg", "chord_angle_deg": r"$\varphi_2$, deg",
    "mass_g": "mass, g", "largest_stretch": "largest stretch", "length_mm": "length, mm",
    "height_mm": "height, mm", "width_mm": "width, mm", "depth_mm": "depth, mm",
    "ballooning_margin": "margin to ballooning", "rib_stress_MPa": "stress in the resin, MPa",
    "energy_Nmm": "stored energy, N mm", "material_stability": "stability of the law",
}
CELLS = 6


def draw(optimum: Optimum, file: str | os.PathLike) -> pathlib.Path:
    """Draw what an optimisation has found so far into a PNG, PDF or SVG file. Call on one rank."""
    spar = optimum.problem.start.scene == "spar" and optimum.best() is not None
    with matplotlib.rc_context(STYLE):
        figure = Figure(figsize=(12.5, 9.0), dpi=140, layout="constrained")  # no display
        FigureCanvasAgg(figure)
        figure.get_layout_engine().set(w_pad=0.1, h_pad=0.1, wspace=0.03, hspace=0.04)
        grid = figure.add_gridspec(3 if spar else 2, 2, width_ratios=[1.7, 1.0],
                                   height_ratios=[1.15, 1.0, 0.75][: 3 if spar else 2])
        _history(figure.add_subplot(grid[0, 0]), optimum)
        _rungs(figure.add_subplot(grid[0, 1]), optimum)
        _bounds(figure.add_subplot(grid[1, 0]), optimum)
        _limits(figure.add_subplot(grid[1, 1]), optimum)
        if spar:
            _sections(figure.add_subplot(grid[2, :]), optimum)
        goal = optimum.problem.goal
        target = "" if goal.target is None else f" = {goal.target:.5g}"
        figure.suptitle(f"{goal.kind} {_word(goal.output)}{target}: {len(optimum.rows)} designs "
                        "computed", x=0.01, ha="left", fontweight="bold", fontsize=13)
        return save_figure(figure, file)


def _word(output: str) -> str:
    return _WORDS.get(output, output.replace("_", " "))


def _history(axes: Axes, optimum: Optimum) -> None:
    goal, rows = optimum.problem.goal, optimum.rows
    for number, rung in enumerate(dict.fromkeys(row["rung"] for row in rows)):
        places = [i for i, row in enumerate(rows) if row["rung"] == rung]
        if number % 2:
            axes.axvspan(places[0] + 0.5, places[-1] + 1.5, color="#f3f3ef", zorder=0)
        axes.annotate(rung, ((places[0] + places[-1]) / 2 + 1, 1.0), (0, 4),
                      xycoords=("data", "axes fraction"), textcoords="offset points",
                      ha="center", fontsize=10.5, color="#444")
        best: list[float] = []
        for i in places:
            values = [rows[j][goal.output] for j in places
                      if j <= i and rows[j]["feasible"]]
            costs = [goal.cost(value, 1.0) for value in values]
            best.append(values[int(np.argmin(costs))] if values else np.nan)
        axes.step([i + 1 for i in places], best, where="post", color=_NEW, linewidth=2.2,
                  label="best that holds all limits" if number == 0 else None, zorder=2)
    looks = (
        ("start", lambda r: r["role"] == "start", dict(marker="s", color=_OLD, s=60)),
        ("support of the model", lambda r: r["role"] == "support",
         dict(marker=".", color="#b5b5ae", s=70)),
        ("promised, holds all limits", lambda r: r["role"] not in ("start", "support")
         and r["feasible"], dict(marker="o", color=_NEW, s=42)),
        ("promised, passes a limit", lambda r: r["role"] not in ("start", "support")
         and not r["feasible"], dict(marker="x", color=_PASSED, s=42)),
    )
    for label, chosen, drawn in looks:
        points = [(i + 1, row[goal.output]) for i, row in enumerate(rows) if chosen(row)]
        if points:
            axes.scatter(*zip(*points, strict=True), label=label, zorder=3, **drawn)
    promised = [(i + 1, row["predicted"]) for i, row in enumerate(rows)
                if row["predicted"] is not None]
    if promised:
        axes.scatter(*zip(*promised, strict=True), marker="_", s=130, color="#111", zorder=4,
                     label="what the model promised")
    if goal.target is not None:
        axes.axhline(goal.target, color="#111", linewidth=1.0, linestyle="--", label="target")
    axes.set(xlabel="evaluation", ylabel=_word(goal.output), xlim=(0.5, len(rows) + 0.5))
    axes.xaxis.get_major_locator().set_params(integer=True)
    unknown = [f"{rung} does not know {_quantities(optimum, rung)}"
               for rung in dict.fromkeys(row["rung"] for row in rows) if _quantities(optimum, rung)]
    axes.legend(fontsize=9, loc="upper center", bbox_to_anchor=(0.5, -0.16), ncols=3,
                columnspacing=1.4, handletextpad=0.5, title_fontsize=9,
                title=f"limits: {'; '.join(unknown)}" if unknown else None)


def _quantities(optimum: Optimum, rung: str) -> str:
    """Return what a rung tells nothing of though it is limited, in words."""
    if rung not in optimum.limits:  # not even its start was solved
        return ""
    known = {c.output for c in optimum.limits[rung]}
    names = dict.fromkeys(c.output for c in optimum.problem.constraints if c.output not in known)
    return ", ".join(_word(name).split(", ")[0] for name in names)


def _rungs(axes: Axes, optimum: Optimum) -> None:
    """Draw start and best of each rung as that rung has them."""
    output, table = optimum.problem.goal.output, optimum.rungs()
    x = np.arange(len(table))
    for shift, column, colour, label in (
        (-0.2, f"start_{output}", _OLD, "start"), (0.2, f"best_{output}", _NEW, "best there")):
        bars = axes.bar(x + shift, table[column], width=0.38, color=colour, label=label)
        axes.bar_label(bars, fmt="%.2f", fontsize=9.5, padding=2)
    axes.set_xticks(x, table["rung"])
    axes.grid(False, axis="x")
    axes.set_ylabel(_word(output))
    axes.margins(y=0.14)
    axes.legend(fontsize=9, ncols=2, loc="upper center", bbox_to_anchor=(0.5, 1.14))


def _bounds(axes: Axes, optimum: Optimum) -> None:
    """Draw the variables of start and best between their bounds."""
    variables, best = optimum.problem.variables, optimum.best()
    y = np.arange(len(variables))[::-1]
    axes.barh(y, 1.0, height=0.34, color="#ecece7")
    for place, v, first in zip(y, variables, optimum.problem.first, strict=True):
        span = v.highest - v.lowest
        axes.plot((first - v.lowest) / span, place, "s", color=_OLD, markersize=8)
        text = f"{first:.4g}"
        if best is not None:
            axes.plot((best[v.column] - v.lowest) / span, place, "o", color=_NEW, markersize=8)
            text += f"  to  {best[v.column]:.4g} {v.unit}"
        for end, side, value in ((-0.015, "right", v.lowest), (1.015, "left", v.highest)):
            axes.text(end, place, f"{value:.4g}", ha=side, va="center", fontsize=9, color="#666")
        axes.text(1.1, place, text, va="center", fontsize=9.5)
    axes.set_yticks(y, [v.name.replace("_", " ") for v in variables])
    axes.set_xlim(-0.09, 1.42)
    axes.set_ylim(-0.7, len(y) - 0.3)
    axes.set_xticks([])
    axes.grid(False)
    axes.spines[["left", "bottom"]].set_visible(False)
    axes.tick_params(length=0)
    axes.set_title("variables between their bounds: start (grey), best (blue)", fontsize=10.5,
                   loc="left")


def _limits(axes: Axes, optimum: Optimum) -> None:
    """Draw how much of each limit start and best use, and what those that hold it cost."""
    best = optimum.best()
    limits = optimum.limits[(best or optimum.rows[-1])["rung"]]
    prices = optimum.found[-1].prices if optimum.found else {}
    axes.set_title("limits: part that is used", fontsize=10.5, loc="left")
    if not limits:
        axes.text(0.5, 0.5, "no constraints", ha="center", transform=axes.transAxes)
        axes.set_axis_off()
        return
    y = np.arange(len(limits))[::-1]
    start = optimum.start((best or optimum.rows[-1])["rung"])
    for place, (c, limit) in zip(y, limits.items(), strict=True):
        for shift, row, colour in ((0.02, start, _OLD), (-0.22, best, _NEW)):
            if row is not None:
                axes.barh(place + shift, _used(c, row[c.output], limit), height=0.2, color=colour)
        price = prices.get(f"{c.output} {c.side}", 0.0)
        words = [f"{_word(c.output)} {'at most' if c.side == 'max' else 'at least'} {limit:.4g}"]
        if price:
            one = f"1 {_unit(c.output)}" if _unit(c.output) else "0.01"
            worth = price if _unit(c.output) else 0.01 * price
            words.append(f"{one} is worth {worth:.2g} {_unit(optimum.problem.goal.output)}")
        axes.text(0.0, place + 0.16, ", ".join(words), fontsize=8.5, va="bottom", color="#222",
                  zorder=3, bbox={"facecolor": "white", "edgecolor": "none", "pad": 0.8})
    axes.axvline(1.0, color="#111", linewidth=1.2)
    axes.set(yticks=[], xlim=(0.0, 1.25), ylim=(-0.5, len(y) - 0.4))
    axes.grid(False)


def _unit(output: str) -> str:
    return next((unit for unit in ("deg", "mm", "MPa", "Nmm", "N", "g")
                 if output.endswith(f"_{unit}")), "")


def _used(c: Any, value: float, limit: float) -> float:
    part = value / limit if c.side == "max" else limit / value
    return float(np.clip(part, 0.0, 1.2)) if np.isfinite(part) else 1.2


def _sections(axes: Axes, optimum: Optimum) -> None:
    """Draw cells of start and best along the span, and their cross-sections, to one scale."""
    best = optimum.best()
    first = optimum.problem.case(optimum.problem.first, best["rung"]).file.geometry
    left = 0.0
    for geometry, colour, label in ((first, _OLD, "start"),
                                    (optimum.design().file.geometry, _NEW, "best")):
        g = geometry
        length = min(CELLS, g.n_cells) * g.pitch + g.wall_length
        axes.add_patch(Rectangle((left, -g.height / 2), length, g.height, color=colour))
        for cell in range(min(CELLS, g.n_cells)):
            corner = left + g.wall_length + cell * g.pitch
            for low in _floors(g):
                axes.add_patch(Rectangle((corner, low), g.cavity_length, g.cavity_height,
                                         color="white"))
        shown = min(CELLS, g.n_cells)
        axes.text(left, first.height / 2 + 1.5, f"{label}: {shown} of {g.n_cells} cells, and "
                  "across", fontsize=9.5)
        left += length + 3.0
        axes.add_patch(Rectangle((left, -g.height / 2), g.width, g.height, color=colour))
        for low in _floors(g):
            axes.add_patch(Rectangle((left + g.side_thickness, low), g.cavity_width,
                                     g.cavity_height, color="white"))
        left += g.width + 9.0
    axes.set_xlim(-1.0, left - 8.0)
    axes.set_ylim(-first.height / 2 - 2.0, first.height / 2 + 5.0)
    axes.set_aspect("equal")
    axes.set_axis_off()


def _floors(geometry: Any) -> tuple[float, float]:
    """Return where the lower and the upper chambers begin."""
    half = geometry.middle_thickness / 2
    return -half - geometry.cavity_height, half
