"""``morphing-wing paper``: a table or a figure of the paper, computed, drawn and told in tables."""

from __future__ import annotations

import pathlib
from typing import Annotated

import typer
from mpi4py import MPI

from morphing_wing.errors import InputError, require
from morphing_wing.figure6_command import run_figure6
from morphing_wing.figure7_command import run_figure7
from morphing_wing.ladder import LADDERS
from morphing_wing.out_folder import check_folder
from morphing_wing.root import on_root
from morphing_wing.tables_command import run_figure5, run_table

__all__ = ["paper"]

SCENES = {"table2": ("spar",), "table3": ("rib",), "fig5": ("spar", "rib"),
          "fig6": ("spar", "rib"), "fig7": ("wing",)}
POINTS = {"fig5": 6, "fig7": 8}
OF = {"name": SCENES, "fidelity": SCENES, "out": SCENES, "points": POINTS,
      "reading": ("fig6",), "resume": ("fig6",)}
"""Where an option belongs that is not of fig7 alone."""


def paper(
    context: typer.Context,
    name: Annotated[
        str, typer.Argument(metavar="table2|table3|fig5|fig6|fig7", help="Which one of the paper.")
    ],
    fidelity: Annotated[
        list[str] | None,
        typer.Option(metavar="F", help="How it is computed, from cheap to exact: instant (the "
                     "formula), cell, draft, standard, reference (fig7: from draft on); may be "
                     "given several times. The formula and the cheapest finite elements if not "
                     "given, in fig7 draft."),
    ] = None,
    points: Annotated[
        int | None,
        typer.Option(metavar="N", help="Points a curve beside zero: fig5 6, fig7 8 if not given."),
    ] = None,
    reading: Annotated[
        str, typer.Option(metavar="R", help="fig6: the section of the rib's bars, of which the "
                          "paper shows a figure only: flush (as wide as the cylinders), square or "
                          "both.")
    ] = "both",
    resume: Annotated[
        bool, typer.Option("--resume", help="fig6: go on with a run that was killed: what "
                             "DIR/solved.csv holds is not solved again.")
    ] = False,
    panel: Annotated[
        str,
        typer.Option(metavar="P", help="fig7: pressure, cables or both: which half of the figure."),
    ] = "both",
    both_directions: Annotated[
        bool, typer.Option("--both-directions/--one-direction",
                           help="fig7: up as well, or only down.")
    ] = False,
    skin: Annotated[str, typer.Option(metavar="S", help="fig7: on, off or both.")] = "both",
    skin_root: Annotated[
        str, typer.Option(metavar="R", help="fig7: the skin's edge at the root: clamped or free.")
    ] = "clamped",
    contact: Annotated[
        bool, typer.Option("--contact/--no-contact",
                           help="fig7: contact forces in the pocket, or none.")
    ] = True,
    reachable: Annotated[
        bool, typer.Option("--map", help="fig7: pressure and cables together too: costs much.")
    ] = False,
    map_points: Annotated[
        str, typer.Option(metavar="NxM", help="fig7: pressures times tensions of --map.")
    ] = "4x4",
    out: Annotated[
        pathlib.Path | None,
        typer.Option(metavar="DIR", help="Folder of the results; output/NAME if not given."),
    ] = None,
) -> int:
    """Compute a table or figure of the paper beside what the paper prints or states.

    table2: nine spars at 20 kPa.

    table3: nine ribs under one end moment, which is fitted.

    fig5: formulas against finite elements, spar and rib alone.

    fig6: three dimensions each of spar and rib, one at a time; slopes, and what the paper says.

    fig7: the wing, to 40 kPa and 0.5 N in each cable.

    What is done is written as it goes: table.csv, summary.json, NAME.png; levels.csv of a table,
    sensitivities.csv and solved.csv of fig6, fields/ of fig7.

    Example: mpirun -n 2 morphing-wing paper fig6 --fidelity instant --fidelity standard
    """
    require(name in SCENES, "table or figure", name, "", f"one of {', '.join(SCENES)}")
    check_options(context, name)
    fidelities = tuple(dict.fromkeys(fidelity or ()))
    check_fidelities(name, fidelities)
    points = POINTS.get(name, 1) if points is None else points
    require(points >= 1, "--points", points, "", "at least 1")
    folder = pathlib.Path("output") / name if out is None else out
    if name == "fig7":
        return run_figure7(fidelities or ("draft",), points, panel, both_directions, skin,
                           skin_root, contact, reachable, map_points, folder)
    on_root(MPI.COMM_WORLD, lambda: check_folder(folder))
    if name == "fig5":
        return run_figure5(fidelities, points, folder)
    if name == "fig6":
        return run_figure6(fidelities, reading, resume, folder)
    return run_table(name, fidelities, folder)


def check_options(context: typer.Context, name: str) -> None:
    """Refuse options that were given and belong to another figure, or to a map not asked for."""
    for option in context.command.params:
        belongs = OF.get(option.name, ("fig7",))
        source = context.get_parameter_source(option.name)
        if source is None or source.name != "COMMANDLINE":
            continue
        if option.name == "map_points" and name == "fig7" and not context.params["reachable"]:
            raise InputError("--map-points: must be left out without --map")
        if name not in belongs:
            raise InputError(f"{option.opts[0]}: must be left out of {name}, it is an option of "
                             f"{' and '.join(belongs)}")


def check_fidelities(name: str, fidelities: tuple[str, ...]) -> None:
    """Refuse rungs that no ladder has, and those of which a half of the figure has none."""
    ladders = [LADDERS[scene] for scene in SCENES[name]]
    rungs = tuple(dict.fromkeys(rung for ladder in ladders for rung in ladder))
    for each in fidelities:
        require(each in rungs, "--fidelity", each, "", f"one of {', '.join(rungs)}")
    for scene, ladder in zip(SCENES[name], ladders, strict=True):
        if fidelities and not set(fidelities) & set(ladder):
            raise InputError(f"--fidelity = {', '.join(fidelities)}: must have one of "
                             f"{', '.join(ladder)} beside it, the {scene} has no such rung")
