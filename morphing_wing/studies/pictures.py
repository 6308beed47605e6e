"""The pictures of a study: what its design is made to show, one file each."""

from __future__ import annotations

import pathlib
import re
from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING, Any

import matplotlib
import numpy as np
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure

from morphing_wing.curves import COLOURS, STYLE, save_figure

from .designs import VARIED
from .variance_analysis import RESIDUAL

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from .result import StudyResult

__all__ = ["draw"]

_UNITS = {"deg": "deg", "mm": "mm", "mm3": "mm³", "MPa": "MPa", "N": "N", "Nmm": "N mm", "g": "g",
          "kg_m3": "kg/m³", "N_mm3": "N/mm³", "N_mm": "N/mm"}
_UNIT = re.compile(f"(.+?)_({'|'.join(sorted(_UNITS, key=len, reverse=True))})")
_SYMBOLS = {"span_angle_deg": r"$\varphi_1$, deg", "chord_angle_deg": r"$\varphi_2$, deg"}
_GREY = "#8a8a84"
_MOST_TICKS = 6
_FEW = 500  # points that a small panel can hold apart


def draw(result: StudyResult, folder: pathlib.Path) -> list[pathlib.Path]:
    """Draw what a study shows into PNG files of a folder; what nothing is known of is left out."""
    with matplotlib.rc_context(STYLE):
        return [drawn for picture in _PICTURES[result.study.design.kind]
                if (drawn := picture(result, folder)) is not None]


def label(column: str) -> str:
    """Return the name of a column in words, with its unit.

    Examples
    --------
    >>> label("top_thickness_mm"), label("n_cells")
    ('top thickness, mm', 'n cells')
    """
    if column in _SYMBOLS:
        return _SYMBOLS[column]
    found = _UNIT.fullmatch(column)
    words, unit = (found[1], _UNITS[found[2]]) if found else (column, "")
    words = re.sub(r"coefficients_(\d)$", lambda m: f"C{int(m[1]) + 1}0", words)  # Yeoh's
    return words.replace("_", " ") + (f", {unit}" if unit else "")


def main_effects(result: StudyResult, folder: pathlib.Path) -> pathlib.Path | None:
    """Draw the mean of each level of each factor, a row of panels an output."""
    if "levels" not in result.analyses:
        return None

    def panel(axes: Axes, output: str, factor: Any) -> None:
        levels = result.analysis_of("levels", output)
        means = levels.loc[levels["factor"] == factor.column, "mean"].to_numpy()
        names = list(dict.fromkeys(result.table[factor.column]))  # in the order of the means
        order = np.argsort(names) if factor.is_range else np.arange(len(names))
        means, names = means[order], [names[i] for i in order]
        axes.axhline(result.table[output].mean(), color=_GREY, linewidth=1.0, linestyle=":")
        axes.plot(np.arange(len(means)), means, "o-", color=COLOURS[0])
        axes.set_xticks(range(len(names)), [_short(name) for name in names])
        axes.margins(x=0.12, y=0.15)

    return _panels(result, folder / "main_effects.png", panel,
                   "mean of each level; dotted: of all cases")


def scatter(result: StudyResult, folder: pathlib.Path) -> pathlib.Path | None:
    """Draw each output against each factor, with Spearman's rank correlation."""
    good = result.table[~result.table.index.isin(result.bad.index)]
    if not len(good):
        return None

    def panel(axes: Axes, output: str, factor: Any) -> None:
        x, names = good[factor.column], None
        if not factor.is_range:
            names = list(factor.levels)
            x = x.map(names.index)
        size, alpha = (3.5, 0.6) if len(good) <= _FEW else (1.8, 0.3)
        axes.plot(x, good[output], "o", color=COLOURS[0], markersize=size, alpha=alpha,
                  markeredgewidth=0)
        if names is not None:
            axes.set_xticks(range(len(names)), [_short(name) for name in names])
        found = result.analysis_of("correlations", output)
        rank = next((row.spearman for row in found.itertuples()
                     if row.factor == factor.column), np.nan)
        if np.isfinite(rank):
            axes.set_title(f"rank correlation {rank:+.2f}", fontsize=9.5,
                           color="#111" if abs(rank) > 0.3 else _GREY)

    return _panels(result, folder / "scatter.png", panel, f"{len(good)} cases; grey: 0.3 or less")


def one_at_a_time(result: StudyResult, folder: pathlib.Path) -> pathlib.Path | None:
    """Draw each output while one factor is varied and the others are as they are."""
    table = result.table

    def panel(axes: Axes, output: str, factor: Any) -> None:
        base = table[table[VARIED] == "none"]
        rows = table[table[VARIED].isin(["none", factor.column])]
        names = None if factor.is_range else list(factor.levels)
        place = (lambda x: x) if names is None else (lambda x: x.map(names.index))
        rows = rows.assign(x=place(rows[factor.column])).sort_values("x")
        axes.axhline(float(base[output].iloc[0]), color=_GREY, linewidth=1.0, linestyle=":")
        axes.plot(rows["x"], rows[output], "o-", color=COLOURS[0], markersize=5)
        axes.plot(place(base[factor.column]), base[output], "s", color=COLOURS[1], markersize=8,
                  zorder=3)
        if names is not None:
            axes.set_xticks(range(len(names)), [_short(name) for name in names])
        axes.margins(x=0.08, y=0.15)

    return _panels(result, folder / "one_at_a_time.png", panel, "square: the scene as it is")


def variance_shares(result: StudyResult, folder: pathlib.Path) -> pathlib.Path | None:
    """Draw what of all squares is owed to which factor, with p where something is left over."""

    def panel(axes: Axes, output: str) -> None:
        found = result.analysis_of("variance", output)
        shares = 100.0 * found["share"].to_numpy()
        y = np.arange(len(found))[::-1]
        axes.barh(y, shares, 0.62, color=[
            _GREY if source == RESIDUAL else COLOURS[0] for source in found["source"]])
        for place, share, p in zip(y, shares, found["p"], strict=True):
            text = f" {share:.2g} %" if 0.0 < share < 1.0 else f" {share:.1f} %"
            axes.text(share, place, text + (f", {_chance(p)}" if np.isfinite(p) else ""),
                      va="center", fontsize=9.5)
        axes.set_yticks(y, [_source(source) for source in found["source"]])
        if shares.max() > 50.0:  # the room for texts beyond 100 % has no ticks
            axes.set_xticks(range(0, 101, 20))
        axes.set_xlim(0.0, max(1.75 * shares.max(), 1.0))
        axes.set_xlabel("share of all squares, %")

    return _bars(result, "variance", folder / "variance.png", panel)


def sobol_bars(result: StudyResult, folder: pathlib.Path) -> pathlib.Path | None:
    """Draw first-order and total Sobol' indices with their 95 % confidence intervals."""

    def panel(axes: Axes, output: str) -> None:
        found = result.analysis_of("indices", output)
        if "S2" in found:
            found = found[found["S1"].notna()]
        y = np.arange(len(found))[::-1].astype(float)
        error = {"ecolor": "#333", "elinewidth": 1.2, "capsize": 2.5}
        axes.barh(y + 0.19, found["S1"], 0.36, color=COLOURS[0], label="first order, alone",
                  xerr=found["S1_conf"], error_kw=error)
        axes.barh(y - 0.19, found["ST"], 0.36, color=COLOURS[4], label="total, with others",
                  xerr=found["ST_conf"], error_kw=error)
        axes.axvline(0.0, color="#333", linewidth=1.0)
        axes.set_yticks(y, [label(name) for name in found["factor"]])
        axes.set_xlabel("Sobol' index")

    return _bars(result, "indices", folder / "sobol.png", panel)


def _panels(
    result: StudyResult, file: pathlib.Path, panel: Callable[[Axes, str, Any], None], words: str
) -> pathlib.Path | None:
    """Draw a row of panels for each output that is known, a column for each factor."""
    study = result.study
    outputs = [name for name in study.outputs if result.table[name].notna().any()]
    if not outputs:
        return None
    shape = len(outputs), len(study.factors)
    figure = _figure(max(2.15 * shape[1] + 0.9, 5.5), 2.1 * shape[0] + 1.1)
    grid = figure.subplots(*shape, sharey="row", squeeze=False)
    for row, output in zip(grid, outputs, strict=True):
        for axes, factor in zip(row, study.factors, strict=True):
            panel(axes, output, factor)
            axes.tick_params(labelsize=9)
            if axes.get_xticks().size > _MOST_TICKS and factor.is_range:
                axes.locator_params(axis="x", nbins=4)
        row[0].set_ylabel(label(output))
    for axes, factor in zip(grid[-1], study.factors, strict=True):
        axes.set_xlabel(label(factor.column), fontsize=10)
    figure.suptitle(f"{study.name}: {words}", x=0.01, ha="left", fontsize=11.5)
    return save_figure(figure, file)


def _bars(
    result: StudyResult, name: str, file: pathlib.Path, panel: Callable[[Axes, str], None]
) -> pathlib.Path | None:
    """Draw a panel of bars for each output that the analysis tells of."""
    if name not in result.analyses:
        return None
    study = result.study
    outputs = [o for o in study.outputs if len(result.analysis_of(name, o))]
    rows = len(result.analysis_of(name, outputs[0]))
    figure = _figure(max(3.4 * len(outputs) + 1.4, 6.0), 0.42 * rows + 1.9)
    grid = figure.subplots(1, len(outputs), sharey=True, squeeze=False)[0]
    for axes, output in zip(grid, outputs, strict=True):
        panel(axes, output)
        axes.grid(False, axis="y")
        axes.set_title(label(output), fontsize=11)
        axes.tick_params(labelsize=9.5)
    handles, labels = grid[0].get_legend_handles_labels()
    if handles:
        figure.legend(handles, labels, loc="outside lower center", ncols=2, fontsize=10)
    figure.suptitle(f"{study.name}: {len(result.table) - len(result.bad)} cases", x=0.01,
                    ha="left", fontsize=11.5)
    return save_figure(figure, file)


def _figure(width: float, height: float) -> Figure:
    figure = Figure(figsize=(width, height), dpi=130, layout="constrained")  # no display
    FigureCanvasAgg(figure)
    figure.get_layout_engine().set(w_pad=0.05, h_pad=0.05)
    return figure


def _short(value: Any) -> str:
    return f"{value:.4g}" if isinstance(value, float) else str(value)


def _source(source: str) -> str:
    return " x ".join(label(part).split(",")[0] for part in source.split(" x "))


def _chance(p: float) -> str:
    return "p < 0.001" if p < 1e-3 else f"p = {p:.2g}"


_BALANCED = (main_effects, variance_shares)
_PICTURES: dict[str, Sequence[Callable[[StudyResult, pathlib.Path], pathlib.Path | None]]] = {
    "orthogonal": _BALANCED, "full_factorial": _BALANCED, "one_at_a_time": (one_at_a_time,),
    "latin_hypercube": (scatter,), "sobol": (sobol_bars, scatter),
}
