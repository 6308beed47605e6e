"""The map of what a wing can reach: phi_1 and phi_2 under pressure and cables together.

One wing is led through a grid of loads in snake order, so that each point is one small step from
the one before: along the tensions at one pressure, then back along them at the next. A skin that
buckles may have more than one equilibrium; the map has those that this way leads to.
"""

from __future__ import annotations

import json
import os
import pathlib
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
import pandas as pd
from mpi4py import MPI

from .errors import require
from .geometry.wing import WingGeometry
from .limits import actuated
from .path import Path
from .progress import Progress
from .reach_picture import draw
from .record import without_fields
from .root import on_root, write_whole
from .wing import Wing

__all__ = ["Reach", "reach", "snake"]


@dataclass
class Reach:
    """The points of one map.

    Attributes
    ----------
    path
        All converged steps in the order in which they were run, without fields.
    """

    path: Path

    def table(self) -> pd.DataFrame:
        """Return one row a point of the grid, by pressure, then tension; columns of `Path.table`.

        Points that were not reached are not in it.
        """
        table = self.path.table()
        table = table[table["requested"]] if len(table) else table
        order = [name for name in ("upper_MPa", "cable_N") if name in table]
        return table.sort_values(order).reset_index(drop=True) if order else table

    def save(self, directory: str | os.PathLike) -> pathlib.Path:
        """Write ``summary.json``, ``table.csv`` and ``map.png`` into a folder. Collective."""
        directory = pathlib.Path(directory)
        on_root(self.path.scene.comm, lambda: self._save(directory))
        return directory

    def _save(self, directory: pathlib.Path) -> None:
        text = json.dumps(self.path.summary(), indent=2, allow_nan=False) + "\n"
        write_whole(directory / "summary.json", lambda file: file.write_text(text))
        table = self.table()
        write_whole(directory / "table.csv", lambda file: table.to_csv(file, index=False))
        if len(table):
            draw(table, directory / "map.png")


def reach(
    pressures: Sequence[float],
    tensions: Sequence[float],
    fidelity: str = "draft",
    geometry: WingGeometry | None = None,
    comm: MPI.Comm | None = None,
    begin: Callable[[Wing], Progress] | None = None,
    **wing: Any,
) -> Reach:
    """Lead a wing through all pairs of a pressure and a tension.

    Parameters
    ----------
    pressures, tensions
        Pressures in the upper chambers in MPa, tensions in each cable in N; each rising.
    fidelity
        Rung of the wing's ladder.
    geometry
        The paper's prototype by default.
    comm
        Communicator; all ranks of MPI by default.
    begin
        Called with the wing; returns what is told of its steps, a `Progress`.
    wing
        Further keyword arguments of `Wing`.
    """
    for name, values in (("pressures", pressures), ("tensions", tensions)):
        rising = len(values) > 0 and bool(np.all(np.diff(values) > 0.0))
        require(rising, name, list(map(float, values)), "", "one or more rising numbers")
    geometry = WingGeometry.prototype() if geometry is None else geometry
    scene = Wing(geometry, fidelity=fidelity, comm=comm, **wing)
    upper, cable = snake(pressures, tensions)
    # A map has many states, and draws none of them.
    path = actuated(scene, begin and begin(scene), keep_fields=False, upper=upper, cable=cable)
    return Reach(without_fields(path))


def snake(pressures: Sequence[float], tensions: Sequence[float]) -> tuple[list, list]:
    """Return pressures and tensions of all pairs, tensions to and fro."""
    tensions = list(tensions)
    upper = [pressure for pressure in pressures for _ in tensions]
    cable = [t for row in range(len(pressures)) for t in tensions[:: -1 if row % 2 else 1]]
    return upper, cable
