"""Pictures of deformed structures: the whole beside a cut along the span, and a path as a strip."""

from __future__ import annotations

import os
import pathlib
from typing import TYPE_CHECKING, Any

import matplotlib
import numpy as np

from morphing_wing.curves import STYLE
from morphing_wing.fields import scene_grids
from morphing_wing.renderer import NoRenderer
from morphing_wing.root import on_root, write_whole
from morphing_wing.views import Drawing, View, default_drawing

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from morphing_wing.path import Path, State

__all__ = ["NoRenderer", "caption", "render", "render_strip"]

WIDTH, HEIGHT = 1600, 1000  # pixels
_TOP, _BOTTOM, _MARGIN = 90, 110, 24  # pixels for title, colour bar, and around each view
COLOUR_MAP = "viridis"
_LOADS = {
    "upper_MPa": (1000.0, "kPa in the upper chambers"), "torque_Nmm": (1.0, "N mm end moment"),
    "lower_MPa": (1000.0, "kPa in the lower chambers"), "cable_N": (1.0, "N in each cable"),
}
_ANGLES = (("span", r"$\varphi_1$"), ("chord", r"$\varphi_2$"))


def render(scene: Any, state: State, file: str | os.PathLike) -> pathlib.Path:
    """Draw one state: whole with the undeformed outline, and cut along the span. Collective.

    Parameters
    ----------
    scene
        With ``functions`` and ``show``; its ``drawing(state)``, if it has one, says how to draw.
    state
        One of its states.
    file
        PNG, 1600 x 1000 pixels; rank 0 draws and writes.

    Raises
    ------
    NoRenderer
        On all ranks, where this machine cannot draw in 3D.
    """
    grids = scene_grids(scene, state)
    drawing = _drawing(scene, state)
    on_root(scene.comm, lambda: _draw_state(grids, drawing, scene, state, file))
    return pathlib.Path(file)


def render_strip(path: Path, file: str | os.PathLike, most: int = 4) -> pathlib.Path:
    """Draw some states of a path, first to last, all on one scale of size and colour. Collective.

    Parameters
    ----------
    path
        What a scene returned.
    file
        PNG; rank 0 draws and writes.
    most
        At most this number of states, spread evenly.
    """
    chosen = np.unique(np.linspace(0, len(path) - 1, min(most, len(path))).round().astype(int))
    states = [path[int(i)] for i in chosen]
    drawn = [(scene_grids(path.scene, s), _drawing(path.scene, s), s) for s in states]
    on_root(path.scene.comm, lambda: _draw_strip(drawn, path.scene, file))
    return pathlib.Path(file)


def caption(state: State) -> str:
    """Return a state's loads and angles in one line, for titles."""
    loads = [
        f"{state.load[name] * factor:.4g} {text}"
        for name, (factor, text) in _LOADS.items() if state.load.get(name, 0.0) != 0.0
    ]
    angles = []
    for name, symbol in _ANGLES:
        face, line = (state.measures.get(f"{name}_{kind}_deg") for kind in ("angle", "line"))
        if face is not None:
            text = f"{symbol} = {face:.1f}°"
            angles.append(text + (f" (deflection line {line:.1f}°)" if line is not None else ""))
    return ":  ".join(part for part in (", ".join(loads) or "no load", ",  ".join(angles)) if part)


def _drawing(scene: Any, state: State) -> Drawing:
    return scene.drawing(state) if hasattr(scene, "drawing") else default_drawing(scene)


def _draw_state(
    grids: dict, drawing: Drawing, scene: Any, state: State, file: str | os.PathLike
) -> None:
    view = View(grids, drawing)
    low, high = view.extent()
    cuts = [False, True] if view.solids else [False]
    boxes, scale = _boxes(high - low, len(cuts))
    colours = _colours([view])
    with matplotlib.rc_context(STYLE):
        figure = _figure(f"{scene.name.capitalize()}:  {caption(state)}")
        if state.contact:
            _text(figure, 0.5, HEIGHT - 74, "the skin passes through itself or a rib: without "
                  "contact forces this is fiction", color="#b00000", fontsize=13)
        for cut, (x, y, width, height) in zip(cuts, boxes, strict=True):
            image = view.image((width, height), scale, colours, cut)
            axes = figure.add_axes((x / WIDTH, y / HEIGHT, width / WIDTH, height / HEIGHT))
            axes.imshow(image)
            axes.axis("off")
            note = f"cut along the span at x = {view.section_x():.1f} mm" if cut else "whole"
            note += "" if cut else ", undeformed in grey"
            axes.text(0.01, 0.99, note, transform=axes.transAxes, va="top", color="#555",
                      fontsize=13)
        _colour_bar(figure, view, colours)
        write_whole(file, lambda name: figure.savefig(name, format="png"))


def _draw_strip(drawn: list, scene: Any, file: str | os.PathLike) -> None:
    views = [View(grids, drawing) for grids, drawing, _ in drawn]
    corners = [view.extent() for view in views]
    low = np.min([c[0] for c in corners], axis=0)
    high = np.max([c[1] for c in corners], axis=0)
    boxes, scale = _boxes(high - low, len(views))
    colours = _colours(views)
    with matplotlib.rc_context(STYLE):
        figure = _figure(f"{scene.name.capitalize()}:  from load to load, one scale")
        for view, (x, y, width, height), (*_, state) in zip(views, boxes, drawn, strict=True):
            image = view.image((width, height), scale, colours, centre=0.5 * (low + high),
                               outline=False)
            axes = figure.add_axes((x / WIDTH, y / HEIGHT, width / WIDTH, height / HEIGHT))
            axes.imshow(image)
            axes.axis("off")
            axes.text(0.01, 0.99, caption(state), transform=axes.transAxes, va="top",
                      color="#b00000" if state.contact else "#555", fontsize=11)
        _colour_bar(figure, views[-1], colours)
        write_whole(file, lambda name: figure.savefig(name, format="png"))


def _boxes(
    extent: np.ndarray, count: int
) -> tuple[list[tuple[int, int, int, int]], float]:
    """Return x, y, width, height of ``count`` views in pixels, and mm per pixel.

    Of all arrangements in rows and columns the one that shows the structure largest.
    """
    best = None
    for columns in range(1, count + 1):
        rows = -(-count // columns)
        width, height = WIDTH // columns, (HEIGHT - _TOP - _BOTTOM) // rows
        scale = max(extent[0] / (width - 2 * _MARGIN), extent[1] / (height - 2 * _MARGIN - 20))
        if best is None or scale < best[0]:
            best = (scale, columns, rows, width, height)
    scale, columns, rows, width, height = best
    boxes = [
        ((i % columns) * width, _BOTTOM + (rows - 1 - i // columns) * height, width, height)
        for i in range(count)
    ]
    return boxes, scale


def _colours(views: list[View]) -> dict[str, Any]:
    """Return colour map and range: the few peaks at re-entrant corners do not set the scale."""
    values = np.concatenate([view.values() for view in views])
    low = 1.0 if views[0].shows_stretch else 0.0
    high = max(float(np.quantile(values, 0.995)), low + 1e-3)
    return {"cmap": COLOUR_MAP, "clim": (low, high)}


def _figure(title: str) -> Figure:
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.figure import Figure

    figure = Figure(figsize=(WIDTH / 100, HEIGHT / 100), dpi=100, facecolor="white")
    FigureCanvasAgg(figure)
    _text(figure, 0.5, HEIGHT - 36, title, fontsize=19)
    return figure


def _text(figure: Figure, x: float, y: float, text: str, **look: Any) -> None:
    figure.text(x, y / HEIGHT, text, ha="center", va="center", **look)


def _colour_bar(figure: Figure, view: View, colours: dict[str, Any]) -> None:
    from matplotlib.cm import ScalarMappable
    from matplotlib.colors import Normalize

    axes = figure.add_axes((0.3, 62 / HEIGHT, 0.4, 16 / HEIGHT))
    mappable = ScalarMappable(Normalize(*colours["clim"]), colours["cmap"])
    bar = figure.colorbar(mappable, cax=axes, orientation="horizontal", extend="max")
    bar.outline.set_visible(False)
    bar.set_label("largest principal stretch" if view.shows_stretch else "displacement, mm",
                  fontsize=13)
