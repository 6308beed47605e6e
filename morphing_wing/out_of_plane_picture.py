"""Ribs that leave their plane, drawn: shapes coloured by it, and the tail's twist and drift."""

from __future__ import annotations

import os
import pathlib
from collections.abc import Mapping
from dataclasses import replace
from typing import TYPE_CHECKING, Any

import matplotlib
import numpy as np
import pandas as pd
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.cm import ScalarMappable
from matplotlib.colors import Normalize
from matplotlib.figure import Figure

from .curves import COLOURS, STYLE, save_figure
from .fields import scene_grids, shown
from .out_of_plane import out_of_plane
from .pictures import COLOUR_MAP, caption
from .root import on_root
from .views import View

if TYPE_CHECKING:
    from .path import Path

__all__ = ["draw"]

_EYE = (0.35, 0.5, 1.0)  # from behind the tail, above
_SIZE = (560, 430)  # pixels of one shape
_COLUMNS = {"twist_deg": r"twist of the tail $\theta_x$, degrees",
            "sideways_mm": "tail out of the plane $u_z$, mm"}


def draw(
    pulled: Mapping[str, Path], bent: Mapping[str, Path], file: str | os.PathLike
) -> pathlib.Path:
    """Draw the last shapes under a cable, and curves under cable and moment. Collective.

    Parameters
    ----------
    pulled, bent
        Label -> path of `Rib.pull` and of `Rib.bend`; the same labels.
    file
        PNG, PDF or SVG by its suffix; rank 0 draws and writes.

    Raises
    ------
    NoRenderer
        On all ranks, where this machine cannot draw in 3D.
    """
    tables = {(label, load): out_of_plane(path) for load, paths in
              (("cable", pulled), ("moment", bent)) for label, path in paths.items()}
    seen = {f"{label}:  {caption(path[-1])}": _seen(path) for label, path in pulled.items()}
    comm = next(iter(pulled.values())).scene.comm

    def whole() -> None:
        with matplotlib.rc_context(STYLE):
            save_figure(_figure(seen, tables), file)

    on_root(comm, whole)
    return pathlib.Path(file)


def _seen(path: Path) -> tuple[dict, Any]:
    """Return grids and drawing of the last state, to be coloured by the motion along z."""
    scene, state = path.scene, path[-1]
    with shown(scene, state):
        drawing = scene.drawing(state)
    grids = scene_grids(scene, state)
    for grid in grids.values():
        if grid is not None:  # off rank 0 it is
            grid.point_data["mode"] = grid.point_data["displacement"] * [0.0, 0.0, 1.0]
    return grids, replace(drawing, eye=_EYE, colour_by="mode")


def _figure(seen: dict[str, tuple[dict, Any]], tables: dict[tuple, pd.DataFrame]) -> Figure:
    made = Figure(figsize=(12.0, 8.0), dpi=100, layout="constrained")
    FigureCanvasAgg(made)
    above, below = made.subfigures(2, 1, height_ratios=[1.15, 1.0])
    shapes = above.subplots(1, len(seen))
    views = {title: View(*what) for title, what in seen.items()}
    colours = {"cmap": COLOUR_MAP, "clim": (0.0, max(v.values().max() for v in views.values()))}
    extents = [np.subtract(*view.extent()[::-1]) for view in views.values()]
    scale = np.max(np.max(extents, axis=0) / (np.array(_SIZE) - 20))
    for axes, (title, view) in zip(shapes, views.items(), strict=True):
        axes.imshow(view.image(_SIZE, scale, colours))
        axes.set_title(title, fontsize=10.5, loc="left")
        axes.axis("off")
    above.colorbar(ScalarMappable(Normalize(*colours["clim"]), COLOUR_MAP), ax=shapes,
                   label=r"out of the plane $|u_z|$, mm", shrink=0.8)
    for axes, (column, text) in zip(below.subplots(1, 2), _COLUMNS.items(), strict=True):
        for label, load in tables:
            table, number = tables[label, load], list(seen).index(
                next(title for title in seen if title.startswith(label)))
            axes.plot(table["chord_angle_deg"], table[column], color=COLOURS[number], marker="o",
                      markersize=3.5, linestyle="-" if load == "cable" else (0, (4, 2)),
                      label=f"{label}, {load}")
        axes.set(xlabel=r"chordwise rotation of the tail $\varphi_2$, degrees", ylabel=text)
    below.axes[0].legend(fontsize=9.5)
    return made
