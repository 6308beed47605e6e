"""The command line, ``morphing-wing``; also under ``mpirun``.

Exit status: 0 done, 1 unexpected failure, 2 bad input, 3 stopped before the last load step (what
was reached is written), 4 a problem with a known answer was not verified. Whatever goes wrong is
told in one sentence on stderr. DOLFINx is not loaded before something is solved.
"""

from __future__ import annotations

import json
import os
import pathlib
import sys
import warnings
from collections.abc import Sequence
from typing import Annotated, Any

import typer
from mpi4py import MPI

from morphing_wing.built_in import built_in_scenes, or_hint, shown
from morphing_wing.calibrate_command import calibrate
from morphing_wing.errors import InputError, one_line, require
from morphing_wing.optimize_command import optimize
from morphing_wing.out_folder import check_folder
from morphing_wing.paper_command import paper
from morphing_wing.study_command import studies, study, under_mpi_futures
from morphing_wing.together import (
    BAD_INPUT,
    DONE,
    INTERRUPTED,
    STOPPED,
    UNEXPECTED,
    run_together,
)
from morphing_wing.tradeoff_command import tradeoff
from morphing_wing.verify_command import verify

__all__ = ["app", "main"]

SAVING = ".saving"
"""File that stands in a folder of results while they are written."""

app = typer.Typer(
    name="morphing-wing",
    help="Pneumatic morphing wings with pantographic ribs, by coupled finite elements.",
    add_completion=False,
)


@app.command()
def solve(
    scene: Annotated[
        pathlib.Path,
        typer.Argument(metavar="SCENE.toml", help="Scene file; 'scenes NAME' prints one."),
    ],
    fidelity: Annotated[
        str | None, typer.Option(metavar="F", help="Takes the place of the file's own fidelity.")
    ] = None,
    out: Annotated[
        pathlib.Path | None,
        typer.Option(metavar="DIR", help="Folder of the results; output/SCENE if not given."),
    ] = None,
    resume: Annotated[
        bool, typer.Option("--resume", help="Go on after the last step that DIR/restart.npz holds.")
    ] = False,
    modes: Annotated[
        int, typer.Option(metavar="N", help="Draw N modes of vibration about the last state.")
    ] = 0,
) -> int:
    """Solve a scene and write summary.json, table.csv, pictures and fields.

    A run that was stopped or killed goes on with --resume, on any number of ranks.
    """
    from morphing_wing.root import on_root
    from morphing_wing.scene_file import located, read_scene

    comm = MPI.COMM_WORLD
    folder = pathlib.Path("output") / scene.stem if out is None else out
    require(modes >= 0, "--modes", modes, "", "0 or more")

    def read() -> Any:
        checked = read_scene(or_hint(scene, built_in_scenes(), "scenes"), fidelity)
        check_folder(folder)
        if resume and not (folder / "restart.npz").is_file():
            raise InputError(f"--resume: {folder} must hold a restart.npz of a run to go on with")
        return checked

    file = comm.bcast(on_root(comm, read), root=0)

    from morphing_wing.passed import passed
    from morphing_wing.progress import Progress

    progress = Progress(comm)
    with located(str(scene)):
        built = file.build(comm)
        typer.echo(f"{file.scene}, {built.fidelity}: {built.dofs} unknowns on {comm.size} rank(s)"
                   + off_by(built))
        path = file.run(built, on_step=progress, on_cut=progress.cut, restart=folder,
                        resume=folder if resume else None)
    progress.end(path.converged, path.reason)
    for sentence in passed(path):
        typer.echo(sentence)
    before = len(path) - progress.steps
    if resume:
        typer.echo(f"{before} step(s) were done before, {progress.steps or 'none'} now")
    # To save again what is there would drop the fields of all states but the last.
    nothing_new = resume and progress.steps == 0
    if not (nothing_new and comm.bcast(on_root(comm, lambda: saved_already(folder, path)))):
        on_root(comm, lambda: begin_saving(folder))
        path.save(folder)
        on_root(comm, (folder / SAVING).unlink)
    if modes and len(path):
        draw_modes(built, modes, folder / "modes")
    typer.echo(f"results are in {folder}")
    return DONE if path.converged else STOPPED


def off_by(scene: Any) -> str:
    """Return in words what was measured of a scene's rung, if anything was."""
    error = getattr(scene, "error_estimate", None)
    return "" if error is None else f"; measured error up to {100 * error:.2g} %"


def draw_modes(scene: Any, n: int, folder: pathlib.Path) -> None:
    """Write and print the modes about a scene's present state."""
    from morphing_wing.modes import modes

    try:
        found = modes(scene, n)
    except InputError as problem:  # the path is saved, and no input was bad
        typer.echo(f"no modes: {problem}")
        return
    found.save(folder)
    frequencies = ", ".join(mode.words() for mode in found)
    typer.echo(f"{len(found)} mode(s) about the last state: {frequencies}")


@app.command()
def scenes(
    name: Annotated[str | None, typer.Argument(help="Print this scene's TOML.")] = None,
) -> int:
    """List the built-in scenes, or print one as TOML to start from."""
    typer.echo(shown(built_in_scenes(), "scene", name), nl=False)
    return DONE


app.command()(paper)
app.command()(calibrate)
app.command()(verify)
app.command()(tradeoff)
app.command()(study)
app.command()(studies)
app.command()(optimize)


def main(argv: Sequence[str] | None = None) -> int:
    """Run a command on all ranks and return its exit status; no exception leaves it.

    Parameters
    ----------
    argv
        Arguments without the program's name; None: those of the process.
    """
    arguments = sys.argv[1:] if argv is None else list(argv)

    # Its other ranks wait for cases, and take no part in anything collective.
    alone = under_mpi_futures()
    comm = MPI.COMM_SELF if alone else MPI.COMM_WORLD

    def command() -> int:
        if alone and arguments[:1] not in (["study"], ["studies"]):
            raise InputError("python -m mpi4py.futures: must run study, other commands take mpirun "
                             "alone")
        with warnings.catch_warnings():
            warnings.showwarning = warn_in_one_line
            status = app(arguments or ["--help"], prog_name="morphing-wing", standalone_mode=False)
        if status == INTERRUPTED:  # typer's own answer to Ctrl-C, which says nothing
            raise KeyboardInterrupt
        return status if isinstance(status, int) else DONE

    return run_together(comm, command, explain)


def explain(problem: BaseException) -> tuple[int, str]:
    """Return exit status and sentence of what a command raised."""
    if isinstance(problem, InputError):
        return BAD_INPUT, f"morphing-wing: {one_line(problem)}"
    if hasattr(problem, "format_message"):  # the command line's own refusals, of typer or click
        return BAD_INPUT, f"morphing-wing: {' '.join(problem.format_message().split())}"
    if isinstance(problem, (KeyboardInterrupt, typer.Abort)):
        return INTERRUPTED, "morphing-wing: interrupted"
    if os.environ.get("MORPHING_WING_DEBUG"):
        import traceback

        return UNEXPECTED, "".join(traceback.format_exception(problem))
    said = f"unexpected {type(problem).__name__}: {one_line(problem)}"
    return UNEXPECTED, f"morphing-wing: {said} (MORPHING_WING_DEBUG=1 shows where)"


def begin_saving(folder: pathlib.Path) -> None:
    """Leave a mark in the folder; it stays there if the program is killed before all is saved."""
    folder.mkdir(parents=True, exist_ok=True)
    (folder / SAVING).touch()


def saved_already(folder: pathlib.Path, path: Any) -> bool:
    """Whether all of a path of as many steps that ended alike is saved in the folder."""
    if (folder / SAVING).exists():
        return False
    try:
        summary = json.loads((folder / "summary.json").read_text(encoding="utf-8"))
        return (summary["steps"], summary["converged"]) == (len(path), path.converged)
    except (OSError, ValueError, KeyError, TypeError):
        return False


def warn_in_one_line(message: Warning | str, *_: Any, **__: Any) -> None:
    """Show a warning to the user without the line of code it comes from."""
    if MPI.COMM_WORLD.rank == 0:
        print(f"morphing-wing: {one_line(message)}", file=sys.stderr)
