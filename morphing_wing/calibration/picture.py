"""A calibration drawn: data and laws in all three modes, residuals, and how far laws are stable."""

from __future__ import annotations

import math
import os
import pathlib
from typing import TYPE_CHECKING, Any

import matplotlib
import numpy as np
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure

from morphing_wing.curves import COLOURS, STYLE, save_figure

from .deformation import MODES
from .stability import FARTHEST, stable_to

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from .result import Calibration

__all__ = ["draw"]

GIVEN_LOOK = {"color": "#111", "linestyle": (0, (5, 2)), "linewidth": 1.8}
LINES = ("-.", ":", (0, (3, 1, 1, 1)), (0, (6, 2, 1, 2)), (0, (1, 1)), (0, (2, 2)))
MARKERS = {"uniaxial": "o", "planar": "s", "equibiaxial": "D"}


def draw(found: Calibration, file: str | os.PathLike) -> pathlib.Path:
    """Draw a calibration into a PNG, PDF or SVG file. Call on rank 0."""
    looks = {}
    for number, (name, fit) in enumerate(found.fits.items()):
        looks[name] = {"color": COLOURS[number % 6], "linestyle": LINES[number % 6],
                       "linewidth": 1.5, "zorder": 2.0}
        if fit is found.chosen:
            looks[name] |= {"linestyle": "-", "linewidth": 2.6, "zorder": 3.0}
    looks |= {name: GIVEN_LOOK for name, fit in found.fits.items() if not fit.fitted}
    with matplotlib.rc_context(STYLE):
        figure = Figure(figsize=(13.0, 8.6), dpi=150, layout="constrained")  # no display
        FigureCanvasAgg(figure)
        figure.get_layout_engine().set(w_pad=0.08, h_pad=0.08)
        above, below = figure.subfigures(2, 1, height_ratios=[1.25, 1.0])
        panels = above.subplots(1, 3)
        for axes, mode in zip(panels, MODES, strict=True):
            _mode(axes, found, mode, looks)
        residuals, stability = below.subplots(1, 2, width_ratios=[1.5, 1.0])
        _residuals(residuals, found, looks)
        _stability(stability, found, looks)
        handles, labels = panels[0].get_legend_handles_labels()
        names = ", ".join(dict.fromkeys(test.name for test in found.tests))
        figure.suptitle(f"Calibration: {names}", x=0.01, ha="left", fontweight="bold", fontsize=13)
        figure.legend(handles, labels, loc="outside lower center", ncols=5, fontsize=10,
                      handlelength=3.0, columnspacing=1.8)
        return save_figure(figure, file)


def _mode(axes: Axes, found: Calibration, mode: str, looks: dict[str, Any]) -> None:
    """Draw data and laws in one mode, the latter up to where their force gives way."""
    tests = [test for test in found.tests if test.mode == mode]
    used = np.concatenate([test.points[0] for test in tests or found.tests])
    low, high = min(used.min(), 1.0), max(used.max(), 1.0)
    stretch = np.linspace(0.98 * low if low < 1.0 else 1.0, high + 0.15 * (high - low), 300)
    heights = []
    for name, fit in found.fits.items():
        stress = fit.law.stress(fit.values, mode, stretch)
        if fit is found.chosen or not fit.fitted:
            heights.append(stress)
        end = stable_to(fit.stability)[mode]
        axes.plot(stretch, np.where(stretch <= end, stress, np.nan), label=name, **looks[name])
        axes.plot(stretch, np.where(stretch > end, stress, np.nan), **looks[name] | {
            "linewidth": 1.0, "alpha": 0.6})
        if stretch[0] < end <= stretch[-1]:
            axes.plot(end, fit.law.stress(fit.values, mode, end), "x", markersize=9,
                      markeredgewidth=2.2, color=looks[name]["color"], zorder=4)
    for number, test in enumerate(tests):
        marker = "osD^v"[number % 5]
        axes.plot(test.stretch[~test.used], test.stress[~test.used], marker, color="#c9c9c4",
                  markersize=3.0, zorder=1.4)
        axes.plot(*test.points, marker, color="#6b6b66", markersize=4.5, markerfacecolor="none",
                  markevery=max(1, int(test.used.sum()) // 50), zorder=3.5)
        heights.append(test.points[1])
    axes.plot([], [], "o", color="#6b6b66", markersize=4.5, markerfacecolor="none",
              label="measured, used")
    if not all(test.used.all() for test in found.tests):
        axes.plot([], [], "o", color="#c9c9c4", markersize=3.0, label="measured, not used")
    axes.plot([], [], "x", color="#555", markersize=9, markeredgewidth=2.2, label="unstable beyond")
    lowest, largest = (float(f(np.concatenate(heights))) for f in (np.min, np.max))
    axes.set_ylim(min(lowest, 0.0) * 1.1, largest * 1.2)
    axes.set_xlim(stretch[0], stretch[-1])
    axes.set_title(f"{mode.capitalize()}: " + ("measured" if tests else "predicted, not measured"),
                   loc="left", fontsize=11.5)
    axes.set_xlabel(r"stretch $\lambda$")
    axes.set_ylabel("nominal stress, MPa")


def _residuals(axes: Axes, found: Calibration, looks: dict[str, Any]) -> None:
    """Draw law minus measured of the used points."""
    size = 0.0
    for name, fit in found.fits.items():
        for test in found.tests:
            stretch, stress = test.points
            off = 1000.0 * (fit.law.stress(fit.values, test.mode, stretch) - stress)
            axes.plot(stretch, off, **looks[name] | (
                {} if len(found.tests) == 1 else {
                    "marker": MARKERS[test.mode], "markersize": 5.0,
                    "markevery": max(1, stretch.size // 12)}
                if fit is found.chosen or not fit.fitted else {"alpha": 0.4, "linewidth": 1.0}))
            if fit.fitted:
                size = max(size, np.abs(off).max())
    axes.axhline(0.0, color="#999", linewidth=0.8, zorder=0.5)
    axes.set_ylim(-1.1 * size or -1.0, 1.1 * size or 1.0)  # the paper's pair may leave the picture
    axes.set_title("Residuals, law minus measured"
                   + (": ○ uniaxial, □ planar, ◇ equibiaxial" if len(found.tests) > 1 else ""),
                   loc="left", fontsize=11.5)
    axes.set_xlabel(r"stretch $\lambda$")
    axes.set_ylabel("residual, kPa")


def _stability(axes: Axes, found: Calibration, looks: dict[str, Any]) -> None:
    """Draw up to which stretch each law is stable in each mode."""
    names = list(found.fits)
    for row, name in enumerate(names):
        for shift, (mode, end) in zip((-0.2, 0.0, 0.2), stable_to(
                found.fits[name].stability).items(), strict=True):
            far = math.isinf(end)
            axes.plot([1.0, FARTHEST if far else end], [row + shift] * 2, linewidth=1.4,
                      color=looks[name]["color"])
            axes.plot(FARTHEST if far else end, row + shift, ">" if far else MARKERS[mode],
                      markersize=5.0, color=looks[name]["color"],
                      markerfacecolor=looks[name]["color"] if far else "white")
    axes.set_yticks(range(len(names)), names, fontsize=9.5)
    axes.set_ylim(len(names) - 0.5, -0.5)
    axes.set_xlim(1.0, 1.04 * FARTHEST)
    axes.grid(False, axis="y")
    axes.set_title("Stable up to: ○ uniaxial, □ planar, ◇ equibiaxial", loc="left", fontsize=11.5)
    axes.set_xlabel(r"stretch $\lambda$ (▶: beyond " + f"{FARTHEST:g})")
