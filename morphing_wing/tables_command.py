"""``morphing-wing paper table2``, ``table3`` and ``fig5``: computed beside what is printed."""

from __future__ import annotations

import pathlib
from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

import typer
from mpi4py import MPI

from morphing_wing.together import DONE, STOPPED

if TYPE_CHECKING:
    from morphing_wing.table_study import Series

__all__ = ["run_figure5", "run_table"]


def run_table(name: str, fidelities: tuple[str, ...], folder: pathlib.Path) -> int:
    """Compute, print and save Table 2 or 3; what is done is written after each series."""
    from morphing_wing.table2 import table2
    from morphing_wing.table3 import table3
    from morphing_wing.table_report import report
    from morphing_wing.terminal_tables import show

    study = {"table2": table2, "table3": table3}[name](
        **({"fidelities": fidelities} if fidelities else {}), comm=MPI.COMM_WORLD,
        told=told, done=lambda study: study.save(folder))
    if study.comm.rank == 0:
        show(report(study))
    return ended(study.converged, folder)


def run_figure5(fidelities: tuple[str, ...], points: int, folder: pathlib.Path) -> int:
    """Compute, print and save Figure 5; what is done is written after each curve."""
    from morphing_wing.figure5 import figure5
    from morphing_wing.figure5_report import report
    from morphing_wing.progress import announced
    from morphing_wing.terminal_tables import show

    study = figure5(fidelities or None, points, MPI.COMM_WORLD, announced,
                    lambda study: study.save(folder))
    if study.comm.rank == 0:
        show([report(study.facts())])
    return ended(study.converged, folder)


def told(series: Series, row: Mapping[str, Any]) -> None:
    """Print a row as soon as it is known: a rib's as under 1 N mm, before the moment is fitted."""
    spar = "span_angle_deg" in row
    angle = row["span_angle_deg" if spar else "chord_angle_deg"]
    found = row["refused"] or row["stopped"] or (
        f"{angle:.4f} deg" + ("" if spar else " under 1 N mm"))
    typer.echo(f"{series}, row {row['row']}: {found} ({row['seconds']:.1f} s)")


def ended(converged: bool, folder: pathlib.Path) -> int:
    """Say where the results are and return the exit status."""
    typer.echo(f"results are in {folder}")
    return DONE if converged else STOPPED
