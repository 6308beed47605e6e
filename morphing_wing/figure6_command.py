"""``morphing-wing paper fig6``: the paper's parametric studies, drawn and told in tables."""

from __future__ import annotations

import pathlib
from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

import typer
from mpi4py import MPI

from morphing_wing.errors import require
from morphing_wing.tables_command import ended

if TYPE_CHECKING:
    from morphing_wing.figure5_curves import Curve
    from morphing_wing.figure6.result import Figure6

__all__ = ["run_figure6"]

READINGS = {"flush": ("flush",), "square": ("square",), "both": ("flush", "square")}


def run_figure6(
    fidelities: tuple[str, ...], reading: str, resume: bool, folder: pathlib.Path
) -> int:
    """Compute, print and save Figure 6; what is done is written after each case and series."""
    require(reading in READINGS, "--reading", reading, "", "flush, square or both")

    from morphing_wing.figure6.cases import read_cases, write_cases
    from morphing_wing.figure6.report import report
    from morphing_wing.figure6.study import figure6
    from morphing_wing.terminal_tables import show

    comm = MPI.COMM_WORLD
    before = read_cases(comm, folder) if resume else {}
    if resume:
        typer.echo(f"{sum(map(len, before.values()))} case(s) were solved before")

    def told(study: Figure6, curve: Curve, row: Mapping[str, Any]) -> None:
        typer.echo(words(study, curve, row))
        if curve.fidelity != "instant":  # what takes no time need not be kept
            write_cases(study, folder)

    study = figure6(fidelities or None, READINGS[reading], comm, told,
                    lambda study: study.save(folder, picture=False), before)
    study.save(folder)
    if comm.rank == 0:
        show(report(study))
    return ended(study.converged, folder)


def words(study: Figure6, curve: Curve, row: Mapping[str, Any]) -> str:
    """Return a case in words: a rib's as under 1 N mm, before the moment is fitted."""
    from morphing_wing.figure6.points import PANELS

    panel, rows = PANELS[curve.scene], study.solved[curve]
    cases = len(panel.points[list(panel.levels)].drop_duplicates())
    where = ", ".join(panel.at(name, row[name]) for name in panel.levels)
    found = row["refused"] or row["stopped"] or f"{row[panel.table.angle]:.4f} deg" + (
        "" if curve.scene == "spar" else " under 1 N mm")
    left = (cases - len(rows)) * sum(each["seconds"] for each in rows.values()) / len(rows)
    return (f"{curve}, {len(rows)} of {cases}: {where}: {found} ({row['seconds']:.1f} s"
            + (f", about {left:.0f} s of this series left)" if left >= 10.0 else ")"))
