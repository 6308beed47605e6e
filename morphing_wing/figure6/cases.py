"""The cases of Figure 6 in a file: what is solved stays solved, and a run goes on from there."""

from __future__ import annotations

import os
import pathlib
from typing import Any

import pandas as pd

from morphing_wing.errors import InputError, one_line
from morphing_wing.figure5_curves import Curve
from morphing_wing.root import on_root, write_whole

from .points import PANELS
from .result import Figure6

__all__ = ["CASES", "read_cases", "write_cases"]

CASES = "solved.csv"

_TEXT = ("scene", "fidelity", "reading", "refused", "stopped",
         *(factor for panel in PANELS.values() for factor in panel.levels))
_WHOLE = ("dofs", "newton_iterations")


def write_cases(study: Figure6, directory: str | os.PathLike) -> None:
    """Write the cases that a study has solved into ``solved.csv``. Collective."""
    on_root(study.comm, lambda: write_whole(
        pathlib.Path(directory) / CASES,
        lambda file: study.cases().to_csv(file, index=False)))


def read_cases(
    comm: Any, directory: str | os.PathLike
) -> dict[Curve, dict[tuple[str, ...], dict[str, Any]]]:
    """Read what `write_cases` has written, to the last digit. Collective.

    Raises
    ------
    InputError
        If there is no such file, or it is not one of this study.
    """
    return comm.bcast(on_root(comm, lambda: _read(pathlib.Path(directory))), root=0)


def _read(directory: pathlib.Path) -> dict[Curve, dict[tuple[str, ...], dict[str, Any]]]:
    file = directory / CASES
    if not file.is_file():
        raise InputError(f"--resume: {directory} must hold a {CASES} of a run to go on with")
    try:
        table = pd.read_csv(file, dtype=dict.fromkeys(_TEXT, str), float_precision="round_trip")
        table = table.astype({name: object for name in _TEXT if name in table})
        table[["reading", "refused", "stopped"]] = (
            table[["reading", "refused", "stopped"]].fillna(""))
        found: dict[Curve, dict[tuple[str, ...], dict[str, Any]]] = {}
        for row in table.to_dict("records"):
            curve = Curve(*(row.pop(name) for name in Curve._fields))
            panel = PANELS[curve.scene]
            key = tuple(row[name] for name in panel.levels)
            needed = {panel.table.angle, "refused", "stopped", "seconds"}
            known = {name: int(value) if name in _WHOLE else value
                     for name, value in row.items() if name in needed or not pd.isna(value)}
            if not needed <= set(known) or any(pd.isna(level) for level in key):
                raise KeyError(f"a row of {curve} lacks {', '.join(needed - set(known))}")
            found.setdefault(curve, {})[key] = known
    except (OSError, ValueError, KeyError) as problem:
        raise InputError(f"--resume: {file} must be a table of cases as this command writes it: "
                         f"{one_line(problem)}") from problem
    return found
