"""A table of the paper as computed: its rows, level means, misfits, summary and files."""

from __future__ import annotations

import os
import pathlib
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from typing import Any, NamedTuple

import numpy as np
import pandas as pd
from mpi4py import MPI

from .ladder import LADDERS
from .level_picture import draw
from .path import Path
from .printed_tables import PrintedTable
from .range_analysis import range_analysis
from .root import on_root
from .solved_case import OUTCOME, solved_case
from .study_files import write_study

__all__ = ["Series", "TableStudy", "solved"]

Told = Callable[["Series", Mapping[str, Any]], None]


class Series(NamedTuple):
    """What all rows are computed with; how the section is read is told of ribs only."""

    fidelity: str
    reading: str = ""

    def __str__(self) -> str:
        """Return the series in words."""
        return ", ".join(filter(None, self))


def solved(
    printed: PrintedTable, series: Series, run: Callable[[Mapping[str, str]], Path],
    told: Told | None = None,
) -> pd.DataFrame:
    """Return the table's cases as one series computes them. Collective.

    Parameters
    ----------
    printed
        The table.
    series
        What ``run`` computes with.
    run
        Levels of the factors -> path to the table's load.
    told
        Called with each row as soon as it is known.

    Returns
    -------
    DataFrame
        One row a case, see `solved_case`.
    """
    found = []
    for case in printed.cases.to_dict("records"):
        found.append(solved_case(case, printed.angle, run))
        if told is not None:
            told(series, found[-1])
    return pd.DataFrame(found).reindex(columns=[*printed.cases, printed.angle, *OUTCOME])


@dataclass
class TableStudy:
    """The series of one table.

    Attributes
    ----------
    printed
        The table as printed.
    comm
        Communicator; rank 0 writes.
    parts
        Of each series its rows, see `solved`.
    parameters
        What all rows share, for ``summary.json``.
    remarks
        Function of the study that returns further sentences.
    """

    printed: PrintedTable
    comm: MPI.Comm
    parameters: dict[str, Any] = field(default_factory=dict)
    remarks: Callable[[TableStudy], list[str]] = lambda _: []
    parts: dict[Series, pd.DataFrame] = field(default_factory=dict)

    @property
    def converged(self) -> bool:
        """Whether no row's path stopped before its load."""
        return all((part["stopped"] == "").all() for part in self.parts.values())

    @property
    def keys(self) -> list[str]:
        """Columns that name a series."""
        return list(Series._fields) if any(s.reading for s in self.parts) else ["fidelity"]

    def table(self) -> pd.DataFrame:
        """Return all rows of all series, with ``deviation`` relative to the printed angle."""
        table = pd.concat(self.parts.values(), ignore_index=True)
        for number, key in enumerate(self.keys):
            table.insert(number, key, [
                getattr(series, key) for series, part in self.parts.items() for _ in part.index])
        after = table.columns.get_loc(self.printed.angle) + 1
        table.insert(after, "deviation", table[self.printed.angle] / table["printed_deg"] - 1.0)
        return table

    def levels(self) -> pd.DataFrame:
        """Return level means, R and sums of squares: of the printed rows, then of each series.

        A series that lacks a row is left out: its tests are not orthogonal.
        """
        tested = {series: part[part["printed_deg"].notna()] for series, part in self.parts.items()}
        found = {Series("printed"): self.printed.levels} | {
            series: range_analysis(part, list(self.printed.factors), self.printed.angle)
            for series, part in tested.items() if part[self.printed.angle].notna().all()}
        parts = []
        for series, part in found.items():
            part = part.rename(columns={"mean": "mean_deg", "range": "range_deg",
                                        "sum_of_squares": "sum_of_squares_deg2"})
            for name in reversed(self.keys):
                part.insert(0, name, getattr(series, name))
            parts.append(part.merge(self.printed.stated, on=["factor", "level"]))
        return pd.concat(parts, ignore_index=True)

    def misfits(self) -> list[dict[str, Any]]:
        """Return of each series how far its rows are from the printed ones, relatively."""
        found = []
        for series, rows in self.table().groupby(self.keys, sort=False):
            known = rows[rows["deviation"].notna()]
            off = known["deviation"].abs()
            fact = {**dict(zip(self.keys, series, strict=True)), "rows": len(known)}
            if "fitted_torque_Nmm" in known and len(known):
                fact["fitted_torque_Nmm"] = known["fitted_torque_Nmm"].iloc[0]
            if len(known):
                fact |= {"rms": float(np.sqrt(np.mean(off**2))), "mean": off.mean(),
                         "largest": off.max(), "largest_in_row": known.loc[off.idxmax(), "row"]}
            found.append(fact)
        return found

    def sentences(self) -> list[str]:
        """Return what is to be told of the paper's table and of rows that were not computed."""
        table = self.table()
        found = [f"{', '.join(row[key] for key in self.keys)}, row {row['row']}, {word}: "
                 f"{row[word]}" for word in ("refused", "stopped")
                 for row in table[table[word] != ""].to_dict("records")]
        return self.printed.slips() + self.remarks(self) + found

    def summary(self) -> dict[str, Any]:
        """Return what ``summary.json`` tells.

        Arrays have one entry a row of the table; ``in_series`` says to which of ``series``, where
        the misfits stand, it belongs.
        """
        table = self.table()
        asked = {series.fidelity for series in self.parts}
        rungs = [name for name in LADDERS[self.printed.scene] if name in asked]
        stopped = table[table["stopped"] != ""]
        arrays = table.columns.difference([*self.keys, "dofs", "seconds"], sort=False)
        return {
            "study": self.printed.name, "scene": self.printed.scene,
            "fidelity": rungs[-1], "fidelities": rungs,
            "dofs": table["dofs"].max(), "seconds": table["seconds"].sum(),
            "converged": self.converged,
            "reason": "; ".join(stopped["stopped"]) or "every row that can be modelled was solved",
            "series": self.misfits(),
            "in_series": [i for i, part in enumerate(self.parts.values()) for _ in part.index],
            **{name: list(table[name]) for name in arrays},
            "levels": self.levels().to_dict("records"),
            "sentences": self.sentences(),
            "parameters": self.parameters,
        }

    def save(self, directory: str | os.PathLike) -> None:
        """Write ``table.csv``, ``levels.csv``, ``summary.json`` and the picture. Collective."""
        on_root(self.comm, lambda: self._save(pathlib.Path(directory)))

    def _save(self, directory: pathlib.Path) -> None:
        write_study(directory, self.summary(), {"table": self.table(), "levels": self.levels()})
        draw(self, directory / f"{self.printed.name}.png")
