"""The paper's Figure 6 as a study: one factor at a time, phi_1 of the spar and phi_2 of the rib.

A is the spar of Table 2 under its 20 kPa, B the rib of Table 3 under an end moment: the paper plots
B for "an equivalent force loading to torque", of which it states no size, so that one moment is
fitted, anew for each fidelity and each reading of the bars' section, to those rows of Table 3 that
are points of B. As for Table 3 each rib is solved under 1 N mm and scaled. The figure itself is not
at hand; what the paper says about it is in `figure6_claims`.
"""

from __future__ import annotations

import os
import pathlib
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

import pandas as pd
from mpi4py import MPI

from .bulge import Bulge
from .errors import require
from .figure5 import ALL_RUNGS, FIDELITIES
from .figure5_curves import Curve
from .figure6_claims import claims
from .figure6_picture import draw
from .figure6_points import PANELS
from .figure6_sensitivities import sensitivities
from .ladder import LADDERS
from .path import Path
from .rib import Rib
from .root import on_root
from .solved_case import OUTCOME, solved_case
from .spar import Spar
from .study_files import write_study
from .table2 import PRESSURE, spar_of
from .table3 import N_CELLS, fitted, rib_of

__all__ = ["READINGS", "Figure6", "figure6"]

READINGS = ("flush", "square")
"""How the section of the rib's bars may be read, see `RibGeometry`."""

LINEAR_UP_TO = 60.0
"""Degrees up to which a rib's angle was found linear in the moment."""

Told = Callable[["Figure6", Curve, Mapping[str, Any]], None]


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
        measured = [name for name in ("bulge_mm",) if any(name in row for row in rows)]
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
            points = {key: panel.at(key[0], dict(zip(panel.levels, key[1:], strict=True))[key[0]])
                      for key in part[["factor", *panel.levels]].itertuples(index=False, name=None)}
            rows = dict(zip(points.values(), part.to_dict("records"), strict=True))
            found += [f"{curve}, {point}, {word}: {row[word]}" for point, row in rows.items()
                      for word in ("refused", "stopped") if row[word]]
            far = [point for point, row in rows.items()
                   if curve.scene == "rib" and row[panel.table.angle] > LINEAR_UP_TO]
            if far:
                found.append(f"{curve}: scaled from 1 N mm to more than {LINEAR_UP_TO:g} degrees, "
                             f"beyond where a rib was found linear: {', '.join(far)}.")
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


def figure6(
    fidelities: Sequence[str] | None = None,
    readings: Sequence[str] = READINGS,
    comm: MPI.Comm | None = None,
    told: Told | None = None,
    done: Callable[[Figure6], None] | None = None,
    before: Mapping[Curve, Mapping[tuple[str, ...], dict[str, Any]]] | None = None,
) -> Figure6:
    """Compute the 18 points of each half of Figure 6.

    Parameters
    ----------
    fidelities
        Rungs of either ladder, see `Spar` and `Rib`; those that a half does not have are left out
        of it. None: the formula, and the cheapest finite elements of each half.
    readings
        Some of `READINGS`, for the rib; each has a moment of its own.
    comm
        Communicator; all ranks of MPI by default.
    told
        Called with the study, the series and the row of each case as soon as it is solved.
    done
        Called after each series with the study so far.
    before
        `Figure6.solved` of a run that did not end: its cases are not solved again.
    """
    for name in fidelities or ():
        require(name in ALL_RUNGS, "fidelity", name, "", f"one of {', '.join(ALL_RUNGS)}")
    for name in readings:
        require(name in READINGS, "reading", name, "", f"one of {', '.join(READINGS)}")
    study = Figure6(comm or MPI.COMM_WORLD)
    for curve in _series(fidelities, readings):
        panel = PANELS[curve.scene]
        rows = study.solved[curve] = dict((before or {}).get(curve, {}))
        for levels in panel.points[list(panel.levels)].drop_duplicates().to_dict("records"):
            key = tuple(levels.values())
            if key in rows:
                continue
            rows[key] = solved_case(levels, panel.table.angle,
                                    lambda case, c=curve: _run(c, case, study.comm), ["bulge_mm"])
            if told is not None:
                told(study, curve, rows[key])
        study.finished.append(curve)
        if done is not None:
            done(study)
    return study


def _series(fidelities: Sequence[str] | None, readings: Sequence[str]) -> Iterator[Curve]:
    for scene, usual in FIDELITIES.items():
        for fidelity in dict.fromkeys(fidelities or usual):
            if fidelity in LADDERS[scene]:
                for reading in dict.fromkeys(readings) if scene == "rib" else ("",):
                    yield Curve(scene, fidelity, reading)


def _run(curve: Curve, levels: Mapping[str, str], comm: MPI.Comm) -> Path:
    if curve.scene == "rib":
        rib = Rib(rib_of(levels, curve.reading), fidelity=curve.fidelity, comm=comm)
        return rib.bend(torque=1.0)
    spar = Spar(spar_of(levels), fidelity=curve.fidelity, comm=comm)
    if curve.fidelity != "instant":
        spar.watch.append(Bulge(spar))
    return spar.inflate(upper=PRESSURE)
