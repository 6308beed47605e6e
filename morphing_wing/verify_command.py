"""``morphing-wing verify``: problems with known answers, solved now; what differs, and whether."""

from __future__ import annotations

import gc
import time
from typing import TYPE_CHECKING, Annotated

import typer
from mpi4py import MPI

from morphing_wing.errors import InputError
from morphing_wing.together import DONE, NOT_VERIFIED

if TYPE_CHECKING:
    from morphing_wing.verification import Check, Problem

__all__ = ["verify"]


def verify(
    names: Annotated[
        list[str] | None,
        typer.Argument(metavar="[PROBLEM]...", help="Only these; all if none is named."),
    ] = None,
    quick: Annotated[bool, typer.Option("--quick", help="Only those that take seconds.")] = False,
) -> int:
    """Solve problems with known answers; exit 0 only if all of them hold.

    Quick ones: patch, homogeneous, elastica, balance, land. Others: rotation, convergence, walls,
    membranes, cook.

    Example: morphing-wing verify patch walls
    """
    from morphing_wing.verification import PROBLEMS

    for name in names or ():
        if name not in PROBLEMS:
            raise InputError(f"problem {name!r}: must be one of {', '.join(PROBLEMS)}")
    chosen = [p for p in PROBLEMS.values() if p.name in names] if names else list(PROBLEMS.values())
    chosen = [problem for problem in chosen if problem.quick or not quick]
    if not chosen:
        raise InputError("--quick: none of the problems named is quick")
    verdicts = [holds for problem in chosen for holds in _verdicts(problem)]
    held = sum(verdicts)
    typer.echo(f"{held} of {len(verdicts)} hold" if held < len(verdicts) else
               f"all {len(verdicts)} hold")
    return DONE if held == len(verdicts) else NOT_VERIFIED


def _verdicts(problem: Problem) -> list[bool]:
    """Solve and print a problem; return of each of its checks whether it holds."""
    from morphing_wing.verification import NoEquilibriumError

    typer.echo(f"\n{problem.title} ({problem.name}; {problem.source})")
    typer.echo(f"  {'':72} {'value':>12} {'reference':>12} {'error':>9} {'allowed':>8}")
    clock, verdicts = time.perf_counter(), []
    try:
        for check in problem.run(MPI.COMM_WORLD):
            verdicts.append(check.holds)
            typer.echo(_row(check))
    except NoEquilibriumError as failure:  # on all ranks alike
        verdicts.append(False)
        typer.echo(f"  not solved: {failure}")
    gc.collect()  # PETSc's objects are freed at one point on all ranks
    typer.echo(f"  {time.perf_counter() - clock:.0f} s")
    return verdicts


def _row(check: Check) -> str:
    name = check.name + (f" in {check.unit}" if check.unit else "")
    return (f"  {name:72} {check.value:12.6g} {check.reference:12.6g} {check.error:9.1e} "
            f"{check.tolerance:8.1e} {'holds' if check.holds else 'DOES NOT HOLD'}")
