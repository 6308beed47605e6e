"""Pictures of deformed structures: the whole beside a cut along the span, and a path as a strip."""

from __future__ import annotations

import os
import pathlib
from dataclasses import replace
from typing import TYPE_CHECKING, Any

import matplotlib
import numpy as np
from matplotlib.colors import LinearSegmentedColormap, Normalize

from morphing_wing.curves import STYLE
from morphing_wing.drawing import Cut, Drawing, default_drawing
from morphing_wing.fields import mode_grids, scene_grids, shown
from morphing_wing.renderer import NoRenderer
from morphing_wing.root import on_root, write_whole
from morphing_wing.views import View

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from morphing_wing.modes import Modes
    from morphing_wing.path import Path, State

__all__ = ["NoRenderer", "caption", "render", "render_mode", "render_strip"]

Box = tuple[int, int, int, int]  # x, y from below, width, height in pixels

WIDTH, HEIGHT = 1600, 1000  # pixels
_TOP, _BOTTOM, _MARGIN, _NOTE = 100, 100, 14, 46  # title, colour bar, around and above a view
# From silicone at rest to warm and dark; lightness falls all the way, shading stays visible.
COLOUR_MAP = LinearSegmentedColormap.from_list(
    "silicone", ["#f2efe9", "#f8d58a", "#f2a04e", "#dc6040", "#a92c55", "#681d61"])
_LOADS = {
    "upper_MPa": (1000.0, "kPa in the upper chambers"), "torque_Nmm": (1.0, "N mm end moment"),
    "lower_MPa": (1000.0, "kPa in the lower chambers"),
    "upper_mm3": (1e-3, "ml filled into the upper chambers"),
    "lower_mm3": (1e-3, "ml filled into the lower chambers"), "cable_N": (1.0, "N in each cable"),
    "gravity_g": (1.0, "times standard gravity"),
}
MODE_PART = 0.04
"""Largest displacement of a drawn mode over the structure's largest extent."""

_RED = "#b00000"
_CONTACT = "the skin passes through itself or a rib: without contact forces this is fiction"
_LABELS = {"stretch": "largest principal stretch", "displacement": "displacement, mm",
           "mode": "mode's displacement, over that of its largest component"}
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
    grids, drawing = _seen(scene, state)
    title = f"{scene.name.capitalize()}:  {caption(state)}"
    on_root(scene.comm, lambda: _draw_state(grids, drawing, title, state.contact, file))
    return pathlib.Path(file)


def render_mode(modes: Modes, i: int, file: str | os.PathLike) -> pathlib.Path:
    """Draw mode ``i`` on the deformed structure, largest at `MODE_PART` of its size. Collective."""
    scene, state = modes.scene, modes.state
    _, drawing = _seen(scene, state)
    grids = mode_grids(modes, i)
    title = f"{scene.name.capitalize()}, mode {i + 1}: {modes[i].words()}, at {_loads(state)}"

    def draw() -> None:
        size = np.ptp(np.concatenate([grid.points for grid in grids.values()]), axis=0).max()
        for grid in grids.values():
            grid.point_data["displacement"] += MODE_PART * size * grid.point_data["mode"]
            if "rotation" in grid.point_data:
                grid.point_data["rotation"] += MODE_PART * size * grid.point_data["mode_rotation"]
        _draw_state(grids, replace(drawing, colour_by="mode"), title, state.contact, file)

    on_root(scene.comm, draw)
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
    drawable = [state for state in path if state.fields]  # before a restart they have none
    chosen = np.linspace(0, len(drawable) - 1, min(most, len(drawable))).round().astype(int)
    states = [drawable[i] for i in np.unique(chosen)]
    drawn = [(*_seen(path.scene, state), state) for state in states]
    on_root(path.scene.comm, lambda: _draw_strip(drawn, path.scene, file))
    return pathlib.Path(file)


def caption(state: State, line_break: str = ":  ") -> str:
    """Return a state's loads and angles, with ``line_break`` between them."""
    angles = []
    for name, symbol in _ANGLES:
        face, line = (state.measures.get(f"{name}_{kind}_deg") for kind in ("angle", "line"))
        if face is not None:
            text = f"{symbol} = {_degrees(face)}"
            also = "" if line is None else f" (deflection line {_degrees(line)})"
            angles.append(text + also)
    parts = (_loads(state), ",  ".join(angles))
    return line_break.join(part for part in parts if part)


def _loads(state: State) -> str:
    loads = [
        f"{state.load[name] * factor:.4g} {text}"
        for name, (factor, text) in _LOADS.items() if state.load.get(name, 0.0) != 0.0
    ]
    return ", ".join(loads) or "no load"


def _degrees(angle: float) -> str:
    return f"{round(angle, 1) + 0.0:.1f}°"  # adding zero turns -0.0 into 0.0


def _seen(scene: Any, state: State) -> tuple[dict, Drawing]:
    """Return grids and drawing of a state; the scene is in that state when it is asked."""
    with shown(scene, state):
        drawing = scene.drawing(state) if hasattr(scene, "drawing") else default_drawing(scene)
        return scene_grids(scene, state), drawing


def _draw_state(
    grids: dict, drawing: Drawing, title: str, contact: bool, file: str | os.PathLike
) -> None:
    view = View(grids, drawing)
    colours = _colours([view])
    cuts = [None, *view.cuts()]
    with matplotlib.rc_context(STYLE):
        figure = _figure(title, contact)
        for cut, box in zip(cuts, _page(view, cuts), strict=True):
            low, high = view.extent(cut)
            image = view.image(_inside(box), _scale(high - low, box), colours, cut)
            _place(figure, image, box, _note(cut, drawing.what), "#555")
        _colour_bar(figure, view, colours)
        write_whole(file, lambda name: figure.savefig(name, format="png"))


def _draw_strip(drawn: list, scene: Any, file: str | os.PathLike) -> None:
    views = [View(grids, drawing) for grids, drawing, _ in drawn]
    corners = [view.extent() for view in views]
    low = np.min([c[0] for c in corners], axis=0)
    high = np.max([c[1] for c in corners], axis=0)
    boxes = _grid(high - low, len(views))
    colours = _colours(views)
    with matplotlib.rc_context(STYLE):
        figure = _figure(f"{scene.name.capitalize()}:  from load to load, on one scale", False)
        for view, box, (*_, state) in zip(views, boxes, drawn, strict=True):
            image = view.image(_inside(box), _scale(high - low, box), colours,
                               centre=0.5 * (low + high), outline=False)
            _place(figure, image, box, caption(state, "\n"), _RED if state.contact else "#555")
        _colour_bar(figure, views[-1], colours)
        write_whole(file, lambda name: figure.savefig(name, format="png"))


def _note(cut: Cut | None, what: str) -> str:
    if cut is None:
        return f"{what}, undeformed in grey"
    along = "along" if cut.axis == "x" else "across"
    return f"cut {along} the span at {cut.axis} = {cut.level:.4g} mm"


def _page(view: View, cuts: list[Cut | None]) -> list[Box]:
    """Return where the whole and its cuts stand: alone, two alike, or one large and two small."""
    height = HEIGHT - _TOP - _BOTTOM
    if len(cuts) <= 2:
        sizes = [np.subtract(*view.extent(cut)[::-1]) for cut in cuts]
        return _grid(np.max(sizes, axis=0), len(cuts))
    left = 0.58
    width = int(WIDTH * left)
    half = height // 2
    return [(0, _BOTTOM, width, height), (width, _BOTTOM + half, WIDTH - width, half),
            (width, _BOTTOM, WIDTH - width, half)]


def _grid(extent: np.ndarray, count: int) -> list[Box]:
    """Return ``count`` boxes of one size in rows and columns.

    Of all arrangements the one that shows the structure largest; of nearly equal ones that with the
    fewest columns, which leaves room for the captions.
    """
    best: tuple[float, list[Box]] | None = None
    for columns in range(1, count + 1):
        rows = -(-count // columns)
        width, height = WIDTH // columns, (HEIGHT - _TOP - _BOTTOM) // rows
        boxes = [
            ((i % columns) * width, _BOTTOM + (rows - 1 - i // columns) * height, width, height)
            for i in range(count)
        ]
        scale = _scale(extent, boxes[0])
        if best is None or scale < 0.87 * best[0]:
            best = (scale, boxes)
    return best[1] if best else []


def _scale(extent: np.ndarray, box: Box) -> float:
    """Return mm per pixel that let a box hold an extent, with a margin all round."""
    width, height = _inside(box)
    return max(extent[0] / (width - 2 * _MARGIN), extent[1] / (height - 2 * _MARGIN))


def _inside(box: Box) -> tuple[int, int]:
    return box[2], box[3] - _NOTE


def _place(figure: Figure, image: np.ndarray, box: Box, note: str, colour: str) -> None:
    x, y, (width, height) = *box[:2], _inside(box)
    axes = figure.add_axes((x / WIDTH, y / HEIGHT, width / WIDTH, height / HEIGHT))
    axes.imshow(image)
    axes.axis("off")
    figure.text((x + 16) / WIDTH, (y + height + _NOTE - 4) / HEIGHT, note, va="top", color=colour,
                fontsize=13, linespacing=1.15)


def _colours(views: list[View]) -> dict[str, Any]:
    """Return colour map and range: the few peaks at re-entrant corners do not set the scale."""
    values = np.concatenate([view.values() for view in views])
    low = 1.0 if views[0].quantity == "stretch" else 0.0
    high = max(float(np.quantile(values, 0.995)), low + 1e-3)
    return {"cmap": COLOUR_MAP, "clim": (low, high)}


def _figure(title: str, contact: bool) -> Figure:
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.figure import Figure

    figure = Figure(figsize=(WIDTH / 100, HEIGHT / 100), dpi=100, facecolor="white")
    FigureCanvasAgg(figure)
    long = len(title.replace("$", "")) > 90
    figure.text(0.5, 1 - 38 / HEIGHT, title, ha="center", va="center", fontsize=15 if long else 19)
    if contact:
        figure.text(0.5, 1 - 80 / HEIGHT, _CONTACT, ha="center", va="center", color=_RED,
                    fontsize=13)
    return figure


def _colour_bar(figure: Figure, view: View, colours: dict[str, Any]) -> None:
    from matplotlib.cm import ScalarMappable

    axes = figure.add_axes((0.3, 62 / HEIGHT, 0.4, 16 / HEIGHT))
    mappable = ScalarMappable(Normalize(*colours["clim"]), colours["cmap"])
    bar = figure.colorbar(mappable, cax=axes, orientation="horizontal", extend="max")
    bar.outline.set_visible(False)
    bar.set_label(_LABELS[view.quantity], fontsize=13)
