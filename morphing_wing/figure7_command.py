"""``morphing-wing paper fig7``: the wing's curves, drawn and told in a table."""

from __future__ import annotations

import gc
import pathlib
import re
from typing import TYPE_CHECKING

import numpy as np
import typer
from mpi4py import MPI

from morphing_wing.errors import require
from morphing_wing.geometry.wing import WingGeometry
from morphing_wing.out_folder import check_folder
from morphing_wing.root import on_root
from morphing_wing.together import DONE, STOPPED

if TYPE_CHECKING:
    from morphing_wing.figure7_result import Curve, Figure7
    from morphing_wing.path import Path

__all__ = ["run_figure7"]

PANELS = {"pressure": ("pressure",), "cables": ("cables",), "both": ("pressure", "cables")}
SKINS = {"on": (True,), "off": (False,), "both": (True, False)}


def run_figure7(
    fidelities: tuple[str, ...], points: int, panel: str, both_directions: bool, skin: str,
    skin_root: str, contact: bool, reachable: bool, map_points: str, folder: pathlib.Path,
) -> int:
    """Compute, print and save Figure 7; see `paper_command.paper` for what is asked for."""
    require(skin in SKINS, "--skin", skin, "", "on, off or both")
    require(panel in PANELS, "--panel", panel, "", "pressure, cables or both")
    comm = MPI.COMM_WORLD
    geometry = WingGeometry.prototype(skin_root=skin_root)
    grid = grid_of(map_points) if reachable else None
    on_root(comm, lambda: check_folder(folder))

    from morphing_wing.figure7 import figure7
    from morphing_wing.progress import announced

    study = figure7(
        fidelities, *loads(points + 1, points + 1),
        SKINS[skin], ("down", "up") if both_directions else ("down",), geometry, PANELS[panel],
        comm=comm, begin=announced, done=lambda *found: saved(folder, *found), contact=contact,
    )
    say(study)
    reached = grid is None or mapped(grid, fidelities, skin, geometry, folder, contact)
    typer.echo(f"results are in {folder}")
    return DONE if study.converged and reached else STOPPED


def grid_of(text: str) -> tuple[int, int]:
    """Return the map's numbers of pressures and tensions, each with zero among them."""
    found = re.fullmatch(r"(\d{1,3})x(\d{1,3})", text)
    sizes = tuple(map(int, found.groups())) if found else (0, 0)
    require(min(sizes) >= 2, "--map-points", text, "", "two numbers of at least 2, such as 4x4")
    return sizes


def loads(n_pressures: int, n_tensions: int) -> tuple[np.ndarray, np.ndarray]:
    """Return so many pressures and tensions, from zero to the largest of Figure 7."""
    from morphing_wing.figure7 import PRESSURES, TENSIONS

    return (np.linspace(0.0, PRESSURES[-1], n_pressures),
            np.linspace(0.0, TENSIONS[-1], n_tensions))


def saved(folder: pathlib.Path, study: Figure7, curve: Curve, path: Path) -> None:
    """Write the study so far and the fields of its last curve: a killed run has left them."""
    from morphing_wing.fields import save_path

    study.save(folder)
    if len(path):
        save_path(path, folder / "fields" / curve.slug)


def say(study: Figure7) -> None:
    """Print the facts as tables; on rank 0, as everything that a command prints."""
    from morphing_wing.figure7_report import report
    from morphing_wing.terminal_tables import show

    if study.comm.rank == 0:
        show(report(study.facts()))


def mapped(
    grid: tuple[int, int], fidelities: tuple[str, ...], skin: str, geometry: WingGeometry,
    folder: pathlib.Path, contact: bool,
) -> bool:
    """Run and save the map of each wing asked for; return whether all its points were reached."""
    from morphing_wing.figure7_result import Curve
    from morphing_wing.progress import announced
    from morphing_wing.reach import reach

    whole = True
    for fidelity in fidelities:
        for with_skin in SKINS[skin]:
            curve = Curve("map", with_skin, "down", fidelity)
            found = reach(
                *loads(*grid), fidelity, curve.shape(geometry),
                begin=lambda wing, c=curve: announced(c, wing), contact=contact,
            )
            found.save(folder / curve.slug)
            whole = whole and found.path.converged
            del found
            gc.collect()  # at one point on all ranks, as in `figure7`
    return whole
