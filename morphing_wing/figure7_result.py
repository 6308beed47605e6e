"""The curves of Figure 7 as computed: their table, summary, facts and picture."""

from __future__ import annotations

import json
import os
import pathlib
from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from typing import Any, NamedTuple

import pandas as pd
from mpi4py import MPI

from .figure7_facts import KEYS, PANELS, facts
from .figure7_picture import draw
from .geometry.wing import WingGeometry
from .ladder import LADDERS
from .path import Path
from .root import on_root, write_whole
from .summary import plain, versions

__all__ = ["Curve", "Figure7"]


class Curve(NamedTuple):
    """Which curve: of which panel ("pressure" or "cables"), of which wing, how computed."""

    panel: str
    skin: bool
    direction: str
    fidelity: str

    def __str__(self) -> str:
        """Return the curve in words."""
        skin = "with skin" if self.skin else "no skin"
        return f"{self.panel}, {skin}, {self.direction}, {self.fidelity}"

    @property
    def slug(self) -> str:
        """The curve as the name of a file or folder."""
        return str(self).replace(", ", "_").replace(" ", "_")

    def shape(self, geometry: WingGeometry) -> WingGeometry:
        """Return the wing to run: perhaps without skin, with cables up instead of down."""
        dx, dy, dz = geometry.cable_guide
        if self.direction == "up":
            geometry = replace(geometry, cable_guide=(dx, -dy, dz))
        return geometry if self.skin else geometry.without_skin()

    def loads(self, values: Sequence[float]) -> dict[str, Sequence[float]]:
        """Return the loads as `Wing.actuate` takes them."""
        pressure = "upper" if self.direction == "down" else "lower"
        return {pressure if self.panel == "pressure" else "cable": values}


@dataclass
class Figure7:
    """The curves of one study.

    Attributes
    ----------
    paths
        Of each curve (panel, skin, direction, fidelity) its path, without fields.
    comm
        Communicator; rank 0 writes.
    """

    comm: MPI.Comm
    paths: dict[Curve, Path] = field(default_factory=dict)

    @property
    def converged(self) -> bool:
        """Whether every curve reached its last load."""
        return all(path.converged for path in self.paths.values())

    @property
    def reason(self) -> str:
        """Which curves stopped before their last load, and why."""
        stopped = [f"{curve}: {p.reason}" for curve, p in self.paths.items() if not p.converged]
        return "; ".join(stopped) or "every curve reached its last load"

    def table(self) -> pd.DataFrame:
        """Return one row a converged step of all curves.

        The columns are `KEYS` (panel, skin, direction, fidelity), ``load`` (MPa or N), and those
        of `Path.table`; empty where a wing has no such measure.
        """
        parts = []
        for curve, path in self.paths.items():
            if len(path):
                part = path.table().reset_index()
                part.insert(0, "load", part[PANELS[curve.panel].load])
                for name in reversed(KEYS):
                    part.insert(0, name, getattr(curve, name))
                parts.append(part)
        if not parts:
            return pd.DataFrame(columns=[*KEYS, "load"])
        table = pd.concat(parts, ignore_index=True)
        if "contact" in table:  # a wing without skin has no such column
            table["contact"] = table["contact"].map(lambda flag: flag is True or flag == 1.0)
        return table

    def facts(self) -> dict[str, list[dict[str, Any]]]:
        """Return limits reached, differences of fidelities, skin, coupling: `figure7_facts`."""
        return facts(self.table())

    def summary(self) -> dict[str, Any]:
        """Return the content of ``summary.json``.

        Arrays have one entry a row of the table; ``curve`` says to which of ``curves`` it belongs.
        """
        table = self.table()
        names = list(self.paths)
        fidelities = [name for name in LADDERS["wing"] if any(c.fidelity == name for c in names)]
        number = {curve: i for i, curve in enumerate(names)}
        rows = [number[tuple(key)] for key in table[KEYS].itertuples(index=False)]
        first = next(iter(self.paths.values()), None)
        return plain({
            "scene": "wing", "study": "fig7",
            "fidelity": fidelities[-1] if fidelities else None, "fidelities": fidelities,
            "dofs": max((path.scene.dofs for path in self.paths.values()), default=0),
            "seconds": sum(path.seconds for path in self.paths.values()),
            "converged": self.converged, "reason": self.reason,
            "curves": [curve._asdict() | {
                "dofs": path.scene.dofs, "seconds": path.seconds, "steps": len(path),
                "converged": path.converged, "reason": path.reason,
            } for curve, path in self.paths.items()],
            "curve": rows,
            **{name: list(table[name]) for name in table.columns.difference(KEYS, sort=False)},
            "facts": self.facts(),
            "parameters": first.scene.description() if first else {},
            "versions": versions(),
        })

    def draw(self, file: str | os.PathLike) -> pathlib.Path:
        """Draw the figure. Collective."""
        stopped = {tuple(c): path.reason for c, path in self.paths.items() if not path.converged}
        on_root(self.comm, lambda: draw(self.table(), file, stopped))
        return pathlib.Path(file)

    def save(self, directory: str | os.PathLike) -> pathlib.Path:
        """Write ``summary.json``, ``table.csv`` and ``fig7.png`` into a folder. Collective."""
        directory = pathlib.Path(directory)
        on_root(self.comm, lambda: self._save_figures(directory))
        self.draw(directory / "fig7.png")
        return directory

    def _save_figures(self, directory: pathlib.Path) -> None:
        text = json.dumps(self.summary(), indent=2, allow_nan=False) + "\n"
        write_whole(directory / "summary.json", lambda file: file.write_text(text))
        write_whole(directory / "table.csv", lambda file: self.table().to_csv(file, index=False))
