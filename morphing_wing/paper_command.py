"""``morphing-wing paper fig7``: a figure of the paper, computed, drawn and told in a table."""

from __future__ import annotations

import gc
import pathlib
import re
from typing import TYPE_CHECKING, Annotated, Any

import numpy as np
import typer
from mpi4py import MPI

from morphing_wing.errors import InputError, require
from morphing_wing.geometry.wing import WingGeometry
from morphing_wing.ladder import LADDERS
from morphing_wing.out_folder import check_folder
from morphing_wing.root import on_root
from morphing_wing.together import DONE, STOPPED

if TYPE_CHECKING:
    from morphing_wing.figure7_result import Curve, Figure7
    from morphing_wing.path import Path
    from morphing_wing.progress import Progress

__all__ = ["paper"]

COMING = ("table2", "table3", "fig5", "fig6")
PANELS = {"pressure": ("pressure",), "cables": ("cables",), "both": ("pressure", "cables")}
SKINS = {"on": (True,), "off": (False,), "both": (True, False)}


def paper(
    name: Annotated[str, typer.Argument(metavar="fig7", help="Figure 7: angle against load.")],
    fidelity: Annotated[
        list[str] | None,
        typer.Option(metavar="F", help="draft or standard; once each for several. [draft]"),
    ] = None,
    points: Annotated[int, typer.Option(metavar="N", help="Points a curve beside zero.")] = 8,
    panel: Annotated[
        str, typer.Option(metavar="P", help="pressure, cables or both: which half of the figure.")
    ] = "both",
    both_directions: Annotated[
        bool, typer.Option("--both-directions/--one-direction", help="Up as well, or only down.")
    ] = False,
    skin: Annotated[str, typer.Option(metavar="S", help="on, off or both.")] = "both",
    skin_root: Annotated[
        str, typer.Option(metavar="R", help="The skin's edge at the root: clamped or free.")
    ] = "clamped",
    contact: Annotated[
        bool, typer.Option("--contact/--no-contact", help="Contact forces in the pocket, or none.")
    ] = True,
    reachable: Annotated[
        bool, typer.Option("--map", help="Pressure and cables together as well: costs much.")
    ] = False,
    map_points: Annotated[
        str, typer.Option(metavar="NxM", help="Pressures times tensions of the map.")
    ] = "4x4",
    out: Annotated[
        pathlib.Path | None,
        typer.Option(metavar="DIR", help="Folder of the results; output/fig7 if not given."),
    ] = None,
) -> int:
    """Compute a figure of the paper and set it beside what the paper's text states.

    Pressures go to 40 kPa, tensions to 0.5 N in each cable. What is done is written after each
    curve: fig7.png, table.csv, summary.json, fields/.
    """
    folder = pathlib.Path("output") / "fig7" if out is None else out
    fidelities = tuple(dict.fromkeys(fidelity or ["draft"]))
    comm = MPI.COMM_WORLD
    check(name, fidelities, points, skin, panel)
    geometry = WingGeometry.prototype(skin_root=skin_root)
    grid = grid_of(map_points) if reachable else None
    on_root(comm, lambda: check_folder(folder))

    from morphing_wing.figure7 import figure7

    study = figure7(
        fidelities, *loads(points + 1, points + 1),
        SKINS[skin], ("down", "up") if both_directions else ("down",), geometry, PANELS[panel],
        comm=comm, begin=announced, done=lambda *found: saved(folder, *found), contact=contact,
    )
    say(study)
    reached = grid is None or mapped(grid, fidelities, skin, geometry, folder, contact)
    typer.echo(f"results are in {folder}")
    return DONE if study.converged and reached else STOPPED


def check(
    name: str, fidelities: tuple[str, ...], points: int, skin: str, panel: str
) -> None:
    """Refuse what cannot be computed, before DOLFINx is loaded."""
    if name in COMING:
        raise InputError(f"{name}: is not there yet, must be fig7")
    require(name == "fig7", "figure", name, "", "fig7")
    for each in fidelities:
        require(each in LADDERS["wing"], "--fidelity", each, "",
                f"one of {', '.join(LADDERS['wing'])}")
    require(points >= 1, "--points", points, "", "at least 1")
    require(skin in SKINS, "--skin", skin, "", "on, off or both")
    require(panel in PANELS, "--panel", panel, "", "pressure, cables or both")


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


def announced(curve: Curve, wing: Any) -> Progress:
    """Print which curve begins, and return what prints its steps."""
    from morphing_wing.progress import Progress

    typer.echo(f"\n{curve}: {wing.dofs:,} unknowns on {wing.comm.size} rank(s)")
    return Progress(wing.comm)


def saved(folder: pathlib.Path, study: Figure7, curve: Curve, path: Path) -> None:
    """Write the study so far and the fields of its last curve: a killed run has left them."""
    from morphing_wing.fields import save_path

    study.save(folder)
    if len(path):
        save_path(path, folder / "fields" / curve.slug)


def say(study: Figure7) -> None:
    """Print the facts as tables; on rank 0, as everything that a command prints."""
    from morphing_wing.figure7_report import console, report

    if study.comm.rank == 0:
        for table in report(study.facts()):
            console().print("", table)


def mapped(
    grid: tuple[int, int], fidelities: tuple[str, ...], skin: str, geometry: WingGeometry,
    folder: pathlib.Path, contact: bool,
) -> bool:
    """Run and save the map of each wing asked for; return whether all its points were reached."""
    from morphing_wing.figure7_result import Curve
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
