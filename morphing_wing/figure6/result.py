"""The series of Figure 6 as computed: points, sensitivities, claims, summary and files."""

from __future__ import annotations

import os
import pathlib
from dataclasses import dataclass, field
from typing import Any

import pandas as pd
from mpi4py import MPI

from morphing_wing.figure5 import ALL_RUNGS
from morphing_wing.figure5_curves import Curve
from morphing_wing.root import on_root
from morphing_wing.solved_case import OUTCOME
from morphing_wing.study_files import write_study
from morphing_wing.table2 import PRESSURE
from morphing_wing.table3 import N_CELLS, fitted

from .claims import claims
from .picture import draw
from .points import PANELS
from .sensitivities import sensitivities

__all__ = ["LINEAR_UP_TO", "MEASURES", "Figure6"]

LINEAR_UP_TO = 60.0
"""Degrees up to which a rib's angle was found linear in the moment, within 0.5 %."""

MEASURES = ("bulge_mm",)
"""Kept of a case beside its angle, where a scene has them."""


@dataclass
class Figure6:
    """The series of the study; each is a `Curve` of three factors.

    Attributes
    ----------
    comm
        Communicator; rank 0 writes.
    solved
        Of each series its cases as solved, by their levels: ribs under 1 N mm.
    finished
        The series that are whole.
    """

    comm: MPI.Comm
    solved: dict[Curve, dict[tuple[str, ...], dict[str, Any]]] = field(default_factory=dict)
    finished: list[Curve] = field(default_factory=list)

    def cases(self) -> pd.DataFrame:
        """Return all cases as solved, one row each: what a run can be resumed from."""
        return pd.DataFrame([curve._asdict() | row for curve, rows in self.solved.items()
                             for row in rows.values()])

    def part(self, curve: Curve) -> pd.DataFrame:
        """Return the 18 points of a series.

        The middle of all factors is a point of each of them: it was solved once, and its seconds
        stand at the first.
        """
        panel, rows = PANELS[curve.scene], []
        for point in panel.points.to_dict("records"):
            row = point | self.solved[curve][tuple(point[name] for name in panel.levels)]
            if any(all(row[name] == before[name] for name in panel.levels) for before in rows):
                row["seconds"] = 0.0
            rows.append(row)
        measured = [name for name in MEASURES if any(name in row for row in rows)]
        part = pd.DataFrame(rows).reindex(
            columns=[*panel.points, panel.table.angle, *measured, *OUTCOME])
        if curve.scene == "rib":
            return fitted(part)
        part.insert(part.columns.get_loc(panel.table.angle), "pressure_MPa", PRESSURE)
        return part

    def parts(self) -> dict[Curve, pd.DataFrame]:
        """Return the finished series, see `part`."""
        return {curve: self.part(curve) for curve in self.finished}

    @property
    def converged(self) -> bool:
        """Whether no finished series has a point that stopped before its load."""
        return all((part["stopped"] == "").all() for part in self.parts().values())

    def table(self) -> pd.DataFrame:
        """Return all points of all finished series; a column that only one half has is empty."""
        parts = []
        for curve, part in self.parts().items():
            for name in reversed(Curve._fields):
                part.insert(0, name, getattr(curve, name))
            parts.append(part)
        table = pd.concat(parts, ignore_index=True)
        last = [name for name in OUTCOME if name in table]
        return table[[*table.columns.difference(last, sort=False), *last]]

    def sensitivities(self) -> pd.DataFrame:
        """Return of each factor of each finished series how the angle answers to it."""
        return pd.DataFrame([
            curve._asdict() | fact for curve, part in self.parts().items()
            for fact in sensitivities(part, PANELS[curve.scene])])

    def claims(self) -> list[dict[str, Any]]:
        """Return what the paper says of its figure, and whether each finished series has it."""
        return [curve._asdict() | claim for curve, part in self.parts().items()
                for claim in claims(part, PANELS[curve.scene])]

    def sentences(self) -> list[str]:
        """Return what is to be told of the figure and of points that were not computed."""
        found = ["The paper's own Figure 6 is not at hand: there is nothing printed to compare "
                 "with but three rows each of Tables 2 and 3, which are among the points."]
        for curve, part in self.parts().items():
            panel = PANELS[curve.scene]
            known = part[part["printed_deg"].notna() & part[panel.table.angle].notna()]
            if len(known):
                off = (known[panel.table.angle] / known["printed_deg"] - 1.0).abs()
                found.append(f"{curve}: off the printed rows by {off.max():.1%} at most.")
            rows = [(panel.at(row["factor"], row[row["factor"]]), row)
                    for row in part.to_dict("records")]
            found += [f"{curve}, {point}, {word}: {row[word]}" for point, row in rows
                      for word in ("refused", "stopped") if row[word]]
            far = [point for point, row in rows
                   if curve.scene == "rib" and row[panel.table.angle] > LINEAR_UP_TO]
            if far:
                found.append(f"{curve}: scaled from 1 N mm to more than {LINEAR_UP_TO:g} degrees "
                             "(a frame solved at 120 degrees has 1 % less than that): "
                             f"{', '.join(far)}.")
        return found

    def summary(self) -> dict[str, Any]:
        """Return what ``summary.json`` tells.

        Arrays have one entry a row of the table; ``in_series`` says to which of ``series`` it
        belongs.
        """
        table, parts = self.table(), self.parts()
        asked = {curve.fidelity for curve in parts}
        rungs = [name for name in ALL_RUNGS if name in asked]
        stopped = table[table["stopped"] != ""]
        arrays = table.columns.difference([*Curve._fields, "dofs", "seconds"], sort=False)
        return {
            "study": "fig6", "fidelity": rungs[-1], "fidelities": rungs,
            "dofs": table["dofs"].max(), "seconds": table["seconds"].sum(),
            "converged": self.converged,
            "reason": "; ".join(stopped["stopped"]) or "every point that can be was solved",
            "series": [curve._asdict() for curve in parts],
            "in_series": [i for i, part in enumerate(parts.values()) for _ in part.index],
            **{name: list(table[name]) for name in arrays},
            "sensitivities": self.sensitivities().to_dict("records"),
            "claims": self.claims(), "sentences": self.sentences(),
            "parameters": {
                "pressure_MPa": PRESSURE, "other_dimensions_of_the_spar": "Section 3.3",
                "middle_levels": {name: panel.middle for name, panel in PANELS.items()},
                "n_cells": N_CELLS,
                "end_moment": "one a series, fitted by least squares to rows of Table 3"},
        }

    def save(self, directory: str | os.PathLike, picture: bool = True) -> None:
        """Write ``table.csv``, ``sensitivities.csv``, ``summary.json``, ``fig6.png``. Collective.

        Parameters
        ----------
        directory
            Folder; made if it is not there.
        picture
            Whether to draw.
        """
        on_root(self.comm, lambda: self._save(pathlib.Path(directory), picture))

    def _save(self, directory: pathlib.Path, picture: bool) -> None:
        write_study(directory, self.summary(),
                    {"table": self.table(), "sensitivities": self.sensitivities()})
        if picture:
            draw(self.parts(), directory / "fig6.png")
