"""``morphing-wing study`` and ``studies``: designs of experiments from a file."""

from __future__ import annotations

import os
import pathlib
import sys
from typing import TYPE_CHECKING, Annotated, Any

import typer
from mpi4py import MPI

from morphing_wing.built_in import built_in_studies, or_hint, shown
from morphing_wing.errors import InputError, require
from morphing_wing.out_folder import check_folder
from morphing_wing.root import on_root
from morphing_wing.together import DONE, STOPPED

if TYPE_CHECKING:
    from morphing_wing.studies.result import StudyResult
    from morphing_wing.studies.study import Study

__all__ = ["studies", "study", "under_mpi_futures"]

EXECUTORS = ("processes", "mpi")


def study(
    file: Annotated[
        pathlib.Path,
        typer.Argument(metavar="STUDY.toml", help="Study file; 'studies NAME' prints one."),
    ],
    workers: Annotated[
        int | None,
        typer.Option(metavar="N", help="Processes on this machine, one case each at a time; as "
                     "many as cores if not given, fewer for formulas."),
    ] = None,
    out: Annotated[
        pathlib.Path | None,
        typer.Option(metavar="DIR", help="Folder of the results; output/STUDY if not given."),
    ] = None,
    resume: Annotated[
        bool, typer.Option("--resume", help="Go on with the cases that DIR/cases.jsonl holds.")
    ] = False,
    executor: Annotated[
        str | None,
        typer.Option(metavar="E", help="processes, or mpi: rank 0 deals, the others compute. mpi "
                     "where there are several ranks, else processes, if not given."),
    ] = None,
) -> int:
    """Vary any keys of any scene by a design of experiments; table, analysis and pictures.

    Designs: orthogonal arrays, full factorial, one factor at a time, Latin hypercube, Sobol'
    indices.

    Each case is recorded as soon as it is done, a bad one with what was wrong with it. A study that
    was stopped or killed goes on with --resume.

    morphing-wing studies spar-lhs > mine.toml

    morphing-wing study mine.toml --workers 2 --out output/mine

    mpirun -n 5 morphing-wing study mine.toml

    mpirun -n 5 python -m mpi4py.futures -m morphing_wing study mine.toml
    """
    from morphing_wing.studies.study_file import read_study

    alone = under_mpi_futures()
    comm = MPI.COMM_SELF if alone else MPI.COMM_WORLD
    folder = pathlib.Path("output") / file.stem if out is None else out

    def read() -> Study:
        found = read_study(or_hint(file, built_in_studies(), "studies"))
        check_folder(folder)
        return found

    ranks = MPI.COMM_WORLD.size
    executor = executor or ("mpi" if ranks > 1 else "processes")
    require(executor in EXECUTORS, "--executor", executor, "", f"one of {', '.join(EXECUTORS)}")
    if executor == "mpi":
        if ranks == 1:
            raise InputError("--executor mpi: must be run by mpirun on 2 or more ranks")
        if workers is not None:
            raise InputError("--workers: must be left out of --executor mpi, which has one worker "
                             "a rank")
    elif ranks > 1:
        raise InputError(f"--executor processes: must be run on one rank, not {ranks}")
    require(workers is None or workers >= 1, "--workers", workers, "", "1 or more")
    checked = on_root(comm, read)
    if executor == "processes":
        result = computed(checked, folder, resume, workers or usual_workers(checked), None)
        return ended(result, folder)
    return by_ranks(comm, checked, folder, resume)


def studies(
    name: Annotated[str | None, typer.Argument(help="Print this study's TOML.")] = None,
) -> int:
    """List the built-in studies, or print one as TOML to start from."""
    typer.echo(shown(built_in_studies(), "study", name), nl=False)
    return DONE


def under_mpi_futures() -> bool:
    """Whether ``python -m mpi4py.futures`` runs this program, on rank 0 alone."""
    return "mpi4py.futures" in sys.orig_argv


def usual_workers(checked: Study) -> int:
    """Return as many workers as cores; for a formula one a thousand cases, which take seconds."""
    cores = len(os.sched_getaffinity(0))
    varied = any(factor.key == "fidelity" for factor in checked.factors)
    if checked.case.file.fidelity == "instant" and not varied:
        return min(cores, 1 + len(checked.inputs()) // 1000)
    return cores


def by_ranks(comm: Any, checked: Study | None, folder: pathlib.Path, resume: bool) -> int:
    """Compute on all other ranks what rank 0 deals out."""
    from mpi4py.futures import MPICommExecutor

    from morphing_wing.studies.case_pool import petsc_alone

    petsc_alone()
    status, problem = DONE, None
    with MPICommExecutor(MPI.COMM_WORLD, root=0) as pool:
        if pool is not None and checked is not None:
            try:
                result = computed(checked, folder, resume, MPI.COMM_WORLD.size - 1, pool)
                status = ended(result, folder)
            except BaseException as raised:
                # The ranks are let go first: they wait for more work.
                problem = raised
                pool.shutdown(wait=False, cancel_futures=True)
    if problem is not None:
        raise problem
    return status


def computed(
    checked: Study, folder: pathlib.Path, resume: bool, workers: int, pool: Any
) -> StudyResult:
    """Compute a study, save and print what it found."""
    from morphing_wing.studies.progress import StudyProgress
    from morphing_wing.terminal_tables import console

    size = len(checked.inputs())
    typer.echo(f"{checked.name}: {size} cases, {len(checked.factors)} factors, "
               f"{checked.design.kind.replace('_', ' ')}, {workers} worker(s)")
    try:
        with StudyProgress(console(), size, checked.outputs, bar=pool is None) as progress:
            return checked.run(workers, folder, resume, told=progress, pool=pool)
    except KeyboardInterrupt:
        typer.echo(f"what was computed is in {folder}, --resume goes on with it")
        raise


def ended(result: StudyResult, folder: pathlib.Path) -> int:
    """Save and print what was found, and return the exit status."""
    from morphing_wing.studies.report import report
    from morphing_wing.terminal_tables import show

    result.save(folder)
    show(report(result))
    typer.echo(f"results are in {folder}")
    return STOPPED if len(result.bad) == len(result.table) else DONE
