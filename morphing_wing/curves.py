"""Curves of a path: angle against load in the paper's symbols, energy and iterations below."""

from __future__ import annotations

import os
import pathlib
import textwrap
from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

import matplotlib
import numpy as np
import pandas as pd

from morphing_wing.errors import InputError
from morphing_wing.root import write_whole

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

    from morphing_wing.path import Path

__all__ = ["AXES", "STYLE", "plot_path", "plot_paths", "save_figure"]

# Column of the table -> (factor to the drawn unit, text of the axis).
AXES = {
    "pressure_MPa": (1000.0, r"pressure $P$, kPa"),
    "upper_MPa": (1000.0, r"pressure of the upper chambers $P$, kPa"),
    "lower_MPa": (1000.0, r"pressure of the lower chambers $P$, kPa"),
    "upper_mm3": (1e-3, "volume filled into the upper chambers, ml"),
    "lower_mm3": (1e-3, "volume filled into the lower chambers, ml"),
    "cable_N": (1.0, r"tension of each cable $T$, N"),
    "torque_Nmm": (1.0, r"end moment $M$, N mm"),
    "gravity_g": (1.0, r"weight, multiples of standard gravity"),
}
# Angle by definition of the face's rotation -> (its deflection line, symbol, what it is).
ANGLES = {
    "span_angle_deg": ("span_line_deg", r"\varphi_1", "spanwise"),
    "chord_angle_deg": ("chord_line_deg", r"\varphi_2", "chordwise"),
}
# Okabe and Ito's colours: told apart with any kind of colour vision.
COLOURS = ("#0072B2", "#D55E00", "#009E73", "#CC79A7", "#E69F00", "#56B4E9", "#000000")
STYLE = {
    "font.family": "DejaVu Sans", "font.size": 11, "axes.spines.top": False,
    "axes.spines.right": False, "axes.grid": True, "grid.color": "#e4e4e4",
    "axes.edgecolor": "#555", "lines.linewidth": 1.8, "legend.frameon": False,
    "axes.axisbelow": True,
}


def plot_path(path: Path, file: str | os.PathLike) -> pathlib.Path:
    """Draw the angles of one path against its primary load, and below them how it was reached.

    Full lines are rotations of the tip face, thin ones with open markers the deflection line;
    markers stand at the loads asked for; from where the skin passes through itself or a rib the
    curve is dashed. Where volumes are given, the pressure found stands between.

    Parameters
    ----------
    path
        What a scene returned.
    file
        PNG, PDF or SVG by its suffix. Written by whoever calls: call on rank 0.
    """
    table = path.table()
    load = _load_column(table, path.scene.primary_load)
    filled = load.endswith("_mm3")
    why = [] if path.converged else textwrap.wrap(path.reason, 88)
    with matplotlib.rc_context(STYLE):
        figure, (above, *pressure, energy) = (
            _figure((7.6, 9.4), rows=3) if filled else _figure((7.6, 7.2), rows=2))
        angles = _present(table, ANGLES)
        for number, angle in enumerate(angles):
            line, symbol, what = ANGLES[angle]
            colour = COLOURS[number]
            _curve(above, table, load, angle, colour,
                   f"${symbol}$ {what}, rotation of the end face")
            if line in table:
                _curve(above, table, load, line, colour,
                       f"${symbol}$ {what}, deflection line", light=True)
        _finish(above, table, [ANGLES[angle][1] for angle in angles])
        above.set_title(f"{path.scene.name.capitalize()}, {path.scene.fidelity}, "
                        f"{path.scene.dofs:,} unknowns",
                        loc="left", pad=6 + 15 * len(why))
        if why:
            above.annotate("\n".join(why), (0.0, 1.0), (0, 6), "axes fraction",
                           textcoords="offset points", color="#a00000", fontsize=9)
        if filled:
            _pressure(pressure[0], table, load)
        _cost(energy, table, load)
        return save_figure(figure, file)


def plot_paths(
    paths: Mapping[str, Path | pd.DataFrame],
    file: str | os.PathLike,
    angle: str | None = None,
    load: str | None = None,
) -> pathlib.Path:
    """Draw one angle of several paths against their load in one figure.

    Parameters
    ----------
    paths
        Label -> path, or a table with its columns (from `load_table`, or measured).
    file
        PNG, PDF or SVG by its suffix. Written by whoever calls: call on rank 0.
    angle, load
        Columns to draw; the first angle of the first path, and its primary load, by default.

    Examples
    --------
    >>> plot_paths({"spar alone": bare, "with skin": skinned}, "skin.png")   # doctest: +SKIP
    """
    if not paths:
        raise InputError("paths = {}: must hold at least one path")
    tables = {label: p if isinstance(p, pd.DataFrame) else p.table() for label, p in paths.items()}
    first = next(iter(tables.values()))
    primary = getattr(getattr(next(iter(paths.values())), "scene", None), "primary_load", None)
    load = load or _load_column(first, primary)
    angle = angle or next(iter(_present(first, ANGLES)), None)
    for label, table in tables.items():
        for column in (load, angle):
            if column not in table:
                raise InputError(f"paths[{label!r}]: must have a column {column!r} to be compared")
    with matplotlib.rc_context(STYLE):
        figure, (axes,) = _figure((7.6, 5.0), rows=1)
        for number, (label, table) in enumerate(tables.items()):
            _curve(axes, table, load, angle, COLOURS[number % len(COLOURS)], label)
        _finish(axes, first, [ANGLES[angle][1]] if angle in ANGLES else [])
        axes.set_xlabel(AXES.get(load, (1.0, load))[1])
        if angle not in ANGLES:
            axes.set_ylabel(angle)
        return save_figure(figure, file)


def _figure(size: tuple[float, float], rows: int) -> tuple[Figure, list[Axes]]:
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.figure import Figure

    figure = Figure(figsize=size, dpi=150, layout="constrained")  # no pyplot, no display
    FigureCanvasAgg(figure)
    ratios = [2.2, *[1.0] * (rows - 1)]
    axes = figure.subplots(rows, 1, sharex=True, squeeze=False, height_ratios=ratios)
    return figure, list(axes[:, 0])


def _load_column(table: pd.DataFrame, primary: str | None) -> str:
    """Return the primary load if it changes along the path, else the first load that does."""
    loads = [c for c in dict.fromkeys([primary, *AXES]) if c in table]
    changing = [c for c in loads if table[c].nunique() > 1]
    if not loads:
        raise InputError("path: must have at least one load column to be drawn against")
    return (changing or loads)[0]


def _present(table: pd.DataFrame, columns: Mapping[str, Any]) -> list[str]:
    return [c for c in columns if c in table and table[c].notna().any()]


def _curve(
    axes: Axes, table: pd.DataFrame, load: str, column: str, colour: str, label: str,
    light: bool = False,
) -> None:
    """Draw one curve: dashed where flagged as contact, markers at the loads asked for."""
    x = table[load].to_numpy(float) * AXES.get(load, (1.0, ""))[0]
    y = table[column].to_numpy(float)
    look = {"color": colour, "linewidth": 1.0 if light else 1.8}
    no = np.zeros(len(table), dtype=bool)
    contact = table["contact"].to_numpy(bool) if "contact" in table else no
    # The segment that leads into a flagged step is dashed already.
    solid = np.where(contact, np.nan, y)
    dashed = np.where(contact | np.append(contact[1:], False), y, np.nan)
    marker = {"marker": "o", "markersize": 5.5, "markerfacecolor": "white" if light else colour}
    axes.plot(x, solid, **look)
    axes.plot(x, dashed, linestyle=(0, (4, 2)), **look)
    asked = table["requested"].to_numpy(bool) if "requested" in table else ~no
    axes.plot(x[asked], y[asked], linestyle="none", color=colour, **marker)
    axes.plot([], [], label=label, **look, **marker)


def _finish(axes: Axes, table: pd.DataFrame, symbols: list[str]) -> None:
    axes.set_ylabel("angle " + ", ".join(f"${symbol}$" for symbol in symbols) + ", degrees")
    axes.axhline(0.0, color="#999", linewidth=0.8, zorder=0.5)
    if "contact" in table and table["contact"].any():
        axes.plot([], [], color="#666", linestyle=(0, (4, 2)),
                  label="skin passes through itself or a rib: no contact forces")
    if axes.get_legend_handles_labels()[1]:
        axes.legend(loc="best", fontsize=9.5)


def _pressure(axes: Axes, table: pd.DataFrame, load: str) -> None:
    """Draw the pressure against the volume: dashed where it falls, which no supply would hold."""
    x = table[load].to_numpy(float) * AXES[load][0]
    y = 1000.0 * table["pressure_MPa"].to_numpy(float)
    falling = np.append(False, np.diff(y) * np.diff(x) < 0.0)
    axes.plot(x, np.where(falling, np.nan, y), color="#222", marker="o", markersize=3.5)
    axes.plot(x, np.where(falling | np.append(falling[1:], False), y, np.nan), color="#222",
              linestyle=(0, (4, 2)), marker="o", markersize=3.5,
              label="unstable under given pressure" if falling.any() else None)
    unstable = table["negative_pivots"].to_numpy() > 0
    axes.plot(x[unstable], y[unstable], "x", color="#a00000",
              label="unstable under given volume" if unstable.any() else None)
    axes.set_ylabel("pressure, kPa")
    if falling.any() or unstable.any():
        axes.legend(loc="best", fontsize=9.5)


def _cost(axes: Axes, table: pd.DataFrame, load: str) -> None:
    """Draw stored energy and external work, and Newton iterations as bars behind."""
    factor, text = AXES[load]
    x = table[load].to_numpy(float) * factor
    bars = axes.twinx()
    bars.spines["right"].set_visible(True)
    steps = np.diff(np.unique(x))
    # Seen where steps were cut, and no wall where there are few.
    width = np.clip(0.5 * steps.min(), 0.008 * np.ptp(x), 0.05 * np.ptp(x)) if len(steps) else 0.5
    bars.bar(x, table["newton_iterations"], width=width, color="#d5dde5", zorder=0)
    bars.set_ylabel("Newton iterations", color="#7a8896")
    bars.yaxis.get_major_locator().set_params(integer=True)
    bars.grid(False)
    axes.set_zorder(bars.get_zorder() + 1)
    axes.patch.set_visible(False)
    axes.plot(x, table["energy_Nmm"], color="#333", marker="o", markersize=3,
              label="stored energy")
    axes.plot(x, table["external_work_Nmm"], color="#b8860b", linestyle=":",
              label="work of the loads")
    axes.set_ylabel("energy, N mm")
    axes.set_xlabel(text)
    axes.legend(loc="upper left", fontsize=9.5)


def save_figure(figure: Figure, file: str | os.PathLike) -> pathlib.Path:
    """Write a figure whole or not at all, in the kind that the file's suffix says."""
    kind = pathlib.Path(file).suffix.lstrip(".").lower()
    if kind not in figure.canvas.get_supported_filetypes():
        raise InputError(f"file = {str(file)!r}: must end in .png, .pdf or .svg")
    return write_whole(file, lambda name: figure.savefig(name, format=kind))
