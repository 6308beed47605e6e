"""The paper's Figure 5 as a study: the formulas against finite elements, spar and rib alone.

B-1 is phi_1 of the spar of Section 3.3 against pressure, B-2 phi_2 of its rib against an end
moment, in both readings of the bars' section. The paper's own curves are not at hand; its text
says that formula and finite elements "agree well", better at small deformation, and that the rib
is linear.
"""

from __future__ import annotations

import gc
import os
import pathlib
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np
import pandas as pd
from mpi4py import MPI

from .errors import require
from .figure5_curves import Curve, points_of
from .figure5_picture import draw
from .geometry.rib import RibGeometry
from .geometry.spar import SparGeometry
from .ladder import LADDERS
from .path import Path
from .progress import Progress
from .record import without_fields
from .rib import Rib
from .root import on_root
from .spar import Spar
from .study_files import write_study

__all__ = ["FIDELITIES", "Figure5", "figure5"]

FIDELITIES = {"spar": ("instant", "cell"), "rib": ("instant", "draft")}
"""Of each half if none are asked for: the formula and the cheapest finite elements."""

ALL_RUNGS = tuple(dict.fromkeys((*LADDERS["spar"], *LADDERS["rib"])))

PRESSURE = 0.030  # MPa
TORQUES = {"flush": 40.0, "square": 24.0}
"""Largest end moments in N mm, by how the bars' section is read: about 45 degrees."""

@dataclass
class Figure5:
    """The curves of the study.

    Attributes
    ----------
    comm
        Communicator; rank 0 writes.
    paths
        Of each curve its path, without fields.
    """

    comm: MPI.Comm
    paths: dict[Curve, Path] = field(default_factory=dict)

    @property
    def converged(self) -> bool:
        """Whether every curve reached its last load."""
        return all(path.converged for path in self.paths.values())

    def table(self) -> pd.DataFrame:
        """Return one row a converged step of all curves: which one, and `Path.table`."""
        parts = []
        for curve, path in self.paths.items():
            if not len(path):  # nothing converged: it has no columns
                continue
            part = path.table().reset_index()
            for name in reversed(Curve._fields):
                part.insert(0, name, getattr(curve, name))
            parts.append(part)
        return pd.concat(parts, ignore_index=True)

    def facts(self) -> list[dict[str, Any]]:
        """Return of each curve its slope at first, its end, and what the formula has there.

        ``off_line`` is the last angle over load against the first one; ``formula_first`` and
        ``formula_last`` are the formula's angles relative to the curve's.
        """
        found = []
        table = self.table()
        for curve in self.paths:
            load, angle = points_of(table, curve)
            if len(load) == 0:
                continue
            fact = curve._asdict() | {
                "first_load": load[0], "slope": angle[0] / load[0], "last_load": load[-1],
                "last_angle_deg": angle[-1],
                "off_line": angle[-1] / load[-1] / (angle[0] / load[0]) - 1.0}
            formula = curve._replace(fidelity="instant")
            if curve != formula and formula in self.paths:
                theirs = np.interp(load, *points_of(table, formula)) / angle - 1.0
                fact |= {"formula_first": theirs[0], "formula_last": theirs[-1]}
            found.append(fact)
        return found

    def summary(self) -> dict[str, Any]:
        """Return what ``summary.json`` tells.

        Arrays have one entry a row of the table; ``curve`` says to which of ``curves`` it belongs.
        """
        table = self.table()
        asked = {curve.fidelity for curve in self.paths}
        rungs = [name for name in ALL_RUNGS if name in asked]
        stopped = [f"{curve}: {p.reason}" for curve, p in self.paths.items() if not p.converged]
        return {
            "study": "fig5", "fidelity": rungs[-1], "fidelities": rungs,
            "dofs": max(path.scene.dofs for path in self.paths.values()),
            "seconds": sum(path.seconds for path in self.paths.values()),
            "converged": self.converged,
            "reason": "; ".join(stopped) or "every curve reached its last load",
            "curves": [curve._asdict() | {
                "dofs": path.scene.dofs, "seconds": path.seconds, "converged": path.converged,
                "reason": path.reason, "parameters": path.scene.description(),
            } for curve, path in self.paths.items()],
            "curve": [i for i, path in enumerate(self.paths.values()) for _ in path],
            **{name: list(table[name]) for name in table.columns.difference(Curve._fields)},
            "facts": self.facts(),
        }

    def save(self, directory: str | os.PathLike) -> None:
        """Write ``table.csv``, ``summary.json`` and ``fig5.png`` into a folder. Collective."""
        on_root(self.comm, lambda: self._save(pathlib.Path(directory)))

    def _save(self, directory: pathlib.Path) -> None:
        write_study(directory, self.summary(), {"table": self.table()})
        draw(self.table(), directory / "fig5.png")


def figure5(
    fidelities: Sequence[str] | None = None,
    points: int = 6,
    comm: MPI.Comm | None = None,
    begin: Callable[[Curve, Any], Progress] | None = None,
    done: Callable[[Figure5], None] | None = None,
) -> Figure5:
    """Run the curves of Figure 5.

    Parameters
    ----------
    fidelities
        Rungs of either ladder, see `Spar` and `Rib`; those that a half does not have are left out
        of it. None: `FIDELITIES`.
    points
        Loads of a curve beside zero, up to 30 kPa and about 45 degrees.
    comm
        Communicator; all ranks of MPI by default.
    begin
        Called before each curve; returns what is told of its steps, a `Progress`.
    done
        Called after each curve with the study so far.
    """
    for name in fidelities or ():
        require(name in ALL_RUNGS, "fidelity", name, "", f"one of {', '.join(ALL_RUNGS)}")
    study = Figure5(comm or MPI.COMM_WORLD)
    for curve in _curves(fidelities):
        study.paths[curve] = _run(curve, points, study.comm, begin)
        gc.collect()  # at one point on all ranks: a scene's matrices and factors go together
        if done is not None:
            done(study)
    return study


def _curves(fidelities: Sequence[str] | None) -> Iterator[Curve]:
    for scene, usual in FIDELITIES.items():
        for fidelity in dict.fromkeys(fidelities or usual):
            if fidelity in LADDERS[scene]:
                for reading in TORQUES if scene == "rib" else ("",):
                    yield Curve(scene, fidelity, reading)


def _run(
    curve: Curve, points: int, comm: MPI.Comm, begin: Callable[[Curve, Any], Progress] | None
) -> Path:
    largest = TORQUES.get(curve.reading, PRESSURE)
    loads = np.linspace(0.0, largest, points + 1)
    scene: Any
    if curve.scene == "spar":
        scene = Spar(SparGeometry.validation(), fidelity=curve.fidelity, comm=comm)
        act = scene.inflate
    else:
        geometry = RibGeometry.validation(curve.reading)
        scene = Rib(geometry, fidelity=curve.fidelity, comm=comm)
        act = scene.bend
    told = begin and begin(curve, scene)
    path = act(loads, on_step=told, **({"on_cut": told.cut} if told else {}))
    if told:
        told.end(path.converged, path.reason)
    return without_fields(path)
