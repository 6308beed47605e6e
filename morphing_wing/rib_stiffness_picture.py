"""Stiffnesses of ribs drawn: around the chord in a polar picture, and what couples with what."""

from __future__ import annotations

import os
import pathlib
from collections.abc import Mapping
from typing import TYPE_CHECKING

import matplotlib
import numpy as np
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure

from .curves import COLOURS, STYLE, save_figure
from .rib_stiffness import RibStiffness

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.projections.polar import PolarAxes

__all__ = ["draw", "figure"]

_LOADS = ("$F_x$", "$F_y$", "$F_z$", "$M_x$", "$M_y$", "$M_z$")
_MOTIONS = ("$u_x$", "$u_y$", "$u_z$", r"$\theta_x$", r"$\theta_y$", r"$\theta_z$")
_PLANE_FIRST = [0, 1, 5, 2, 3, 4]  # what stays in the plane of the rib, then what leaves it
_NOTHING = 1e-6  # couplings below are rounding


def draw(
    ribs: Mapping[str, RibStiffness], coupled: Mapping[str, RibStiffness], file: str | os.PathLike
) -> pathlib.Path:
    """Draw stiffness against a force's direction, and couplings. Call on rank 0.

    Parameters
    ----------
    ribs
        Label -> what goes into the polar picture.
    coupled
        Title -> what is shown as a matrix of `RibStiffness.coupling`.
    file
        PNG, PDF or SVG by its suffix.
    """
    with matplotlib.rc_context(STYLE):
        return save_figure(figure(ribs, coupled), file)


def figure(ribs: Mapping[str, RibStiffness], coupled: Mapping[str, RibStiffness]) -> Figure:
    """Return the figure: the polar picture at the left, matrices beside it."""
    widths = [5.6, 4.0 * len(coupled)]
    made = Figure(figsize=(sum(widths), 5.9), dpi=110, layout="constrained")
    FigureCanvasAgg(made)
    left, right = made.subfigures(1, 2, width_ratios=widths)
    left.suptitle("Stiffness against a force across the tail", fontweight="bold", fontsize=12)
    _around(left.add_subplot(projection="polar"), ribs)
    right.suptitle("Which load moves which way", fontweight="bold", fontsize=12)
    for axes, (title, rib) in zip(
            right.subplots(1, len(coupled), squeeze=False)[0], coupled.items(), strict=True):
        _matrix(axes, title, rib.coupling)
    right.supxlabel(
        r"$C_{ij}\,/\,\sqrt{C_{ii}\,C_{jj}}$  of the tail's motions and loads; lines part what "
        "stays in the rib's plane from what leaves it", fontsize=9.5, color="#555")
    return made


def _around(axes: PolarAxes, ribs: Mapping[str, RibStiffness]) -> None:
    """Draw F L^3/(3 u), u along the force: span to the right, height upwards, log radius.

    The factor L^3/3 makes ribs of several lengths comparable: a slender bar has its EI there.
    """
    degrees = np.linspace(0.0, 360.0, 361)
    values = {label: rib.against_force(degrees) * rib.geometry.length**3 / 3.0
              for label, rib in ribs.items()}
    everything = np.array(list(values.values()))
    low, high = np.log10(0.7 * everything.min()), np.log10(1.2 * everything.max())
    for number, (label, stiffness) in enumerate(values.items()):
        axes.plot(np.radians(degrees), np.log10(stiffness), color=COLOURS[number], label=label,
                  linewidth=2.6 if number == 0 else 1.6)
    marks = np.array([d * 10.0**e for e in range(-3, 8) for d in (1, 2, 5)])
    marks = marks[(np.log10(marks) > low) & (np.log10(marks) < high)]
    axes.set_ylim(low, high)
    axes.set_yticks(np.log10(marks), [f"{mark:,g}" for mark in marks], fontsize=9, color="#555")
    axes.set_rlabel_position(58.0)
    axes.set_xticks(np.radians(np.arange(0, 360, 45)),
                    ["    along\n    the span", "", "along the height, as a cable", *[""] * 5])
    axes.tick_params(axis="x", pad=4)
    axes.spines["polar"].set_visible(False)
    axes.set_title(r"$F L^3 / (3 u)$ in N mm$^2$, $u$ along the force; log radius", fontsize=9.5,
                   color="#555", pad=8)
    axes.legend(loc="upper center", bbox_to_anchor=(0.5, 0.0), ncols=2, fontsize=9.5)


def _matrix(axes: Axes, title: str, coupling: np.ndarray) -> None:
    """Draw how much each load (column) moves each way (row), over the most that is possible."""
    ordered = coupling[np.ix_(_PLANE_FIRST, _PLANE_FIRST)]
    axes.imshow(ordered, cmap="RdBu_r", vmin=-1.0, vmax=1.0)
    for (i, j), value in np.ndenumerate(ordered):
        if abs(value) < _NOTHING:
            axes.plot(j, i, marker=".", color="#c8c8c8", markersize=4)
            continue
        text = f"{value:.1g}" if abs(value) < 0.005 else f"{value:.2f}"
        axes.text(j, i, text.replace("-", "\N{MINUS SIGN}"), ha="center", va="center",
                  fontsize=9.5, color="w" if abs(value) > 0.6 else "k")
    axes.set_xticks(range(6), [_LOADS[i] for i in _PLANE_FIRST], fontsize=12)
    axes.set_yticks(range(6), [_MOTIONS[i] for i in _PLANE_FIRST], fontsize=12)
    axes.tick_params(length=0, top=True, labeltop=True, bottom=False, labelbottom=False)
    axes.grid(False)
    axes.spines[:].set_visible(False)
    for line in (axes.axhline, axes.axvline):
        line(2.5, color="#333", linewidth=1.4)
    axes.set_title(title, fontsize=11.5, pad=10)
