"""``morphing-wing optimize``: the best design of a problem file, checked on finer rungs."""

from __future__ import annotations

import json
import pathlib
from typing import TYPE_CHECKING, Annotated, Any

import typer
from mpi4py import MPI

from morphing_wing.built_in import built_in_problems, shown
from morphing_wing.errors import InputError
from morphing_wing.out_folder import check_folder
from morphing_wing.root import on_root
from morphing_wing.together import DONE, STOPPED

if TYPE_CHECKING:
    from morphing_wing.optimization.problem import Problem

__all__ = ["optimize"]


def optimize(
    problem: Annotated[
        str | None,
        typer.Argument(metavar="[PROBLEM.toml]", help="Problem file, or a built-in problem's name. "
                       "Without it the built-in ones are listed."),
    ] = None,
    out: Annotated[
        pathlib.Path | None,
        typer.Option(metavar="DIR", help="Folder of the results; output/PROBLEM if not given."),
    ] = None,
    resume: Annotated[
        bool, typer.Option("--resume", help="Do not compute again what DIR/table.csv holds.")
    ] = False,
    show: Annotated[
        bool, typer.Option("--print", help="Print a built-in problem's TOML to start from.")
    ] = False,
) -> int:
    """Find the best design between bounds, cheaply, and check it on finer rungs.

    morphing-wing optimize                              lists the built-in problems

    morphing-wing optimize spar --print > mine.toml     one of them, to start from

    morphing-wing optimize mine.toml --out mine         table.csv, summary.json, optimum.png, design.toml

    morphing-wing solve mine/design.toml                the design found is a scene

    A run that was stopped or killed goes on with --resume; what it has found is in the folder.
    """  # noqa: E501
    if problem is None or show:
        typer.echo(shown(built_in_problems(), "problem", problem), nl=False)
        return DONE
    from morphing_wing.optimization.problem_file import read_problem

    comm = MPI.COMM_WORLD
    folder = out or pathlib.Path("output") / pathlib.Path(problem).stem

    def read() -> tuple[Problem, list[dict[str, Any]]]:
        checked = read_problem(problem)
        check_folder(folder)
        return checked, earlier(folder, checked) if resume else []

    return searched(*comm.bcast(on_root(comm, read), root=0), folder, comm)


def searched(
    problem: Problem, known: list[dict[str, Any]], folder: pathlib.Path, comm: MPI.Comm
) -> int:
    """Search, print and save; what is done is written after each design."""
    from morphing_wing.optimization import optimum as study
    from morphing_wing.optimization.report import in_a_line, report
    from morphing_wing.terminal_tables import show

    numbers: dict[str, int] = {}
    latest: list[study.Optimum] = []

    def told(row: dict[str, Any]) -> None:
        numbers[row["rung"]] = numbers.get(row["rung"], 0) + 1
        typer.echo(in_a_line(problem, numbers[row["rung"]], row))

    def done(optimum: study.Optimum) -> None:
        latest[:] = [optimum]
        optimum.save(folder, picture=False)

    typer.echo(f"{problem.goal}: {len(problem.variables)} variables, {len(problem.constraints)} "
               f"constraints, rungs {', '.join(problem.rungs)}")
    try:
        optimum = study.optimize(problem, comm, told, done, known)
    except KeyboardInterrupt:
        if latest:  # on rank 0
            latest[0].save(folder)
            typer.echo(f"what was found is in {folder}, --resume goes on")
        raise
    on_root(comm, lambda: optimum.save(folder))
    if comm.rank == 0:
        show(report(optimum))
    typer.echo(f"results are in {folder}; {folder / 'design.toml'} is a scene"
               if optimum.best() else f"results are in {folder}")
    return DONE if optimum.converged else STOPPED


def earlier(folder: pathlib.Path, problem: Problem) -> list[dict[str, Any]]:
    """Return the designs that an earlier run of the same problem has left.

    Raises
    ------
    InputError
        If there are none, or the problem was another one.
    """
    import pandas as pd

    from morphing_wing.optimization.optimum import described

    try:
        was = json.loads((folder / "summary.json").read_text(encoding="utf-8"))["problem"]
        table = pd.read_csv(folder / "table.csv", float_precision="round_trip")
    except (OSError, ValueError, KeyError, TypeError):
        raise InputError(f"--resume: {folder} must hold the summary.json and table.csv of a run "
                         "to go on with") from None
    now = described(problem)
    for name in now.keys() - {"rungs", "evaluations", "tolerance", "own_slopes"}:
        if was.get(name) != now[name]:
            raise InputError(f"--resume: {folder} holds another problem, its {name} must be the "
                             "same")
    texts = ["refused", "stopped", "warned"]
    table[texts] = table[texts].fillna("").astype(str)
    return table.to_dict("records")
