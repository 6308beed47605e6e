"""The rib's trade, against solids of second-order tetrahedra."""

from __future__ import annotations

from collections.abc import Iterator
from functools import partial
from typing import Any

from mpi4py import MPI

from ..geometry.rib import RibGeometry
from ..ladder import LADDERS
from ..rib import Rib
from .trial import row

SOLIDS = {
    "3.3, square": (RibGeometry.validation("square"), 1.86),
    "3.3, flush": (RibGeometry.validation("flush"), 1.067),
    "5.1, square": (RibGeometry.prototype(6, "square", bosses=True), 2.397),
    "5.1, flush": (RibGeometry.prototype(6, "flush"), 1.300),
}
"""Degrees per N mm of solid ribs of 412,000 unknowns with RESIN, computed once outside of this
package (E = 2500 MPa, nu = 0.35; the first is where refinement leads, within 0.5 %)."""


def rows(comm: MPI.Comm, everything: bool) -> Iterator[dict[str, Any]]:
    """Measure all rungs on the paper's ribs under 1 N mm, always all of them. Collective."""
    for fidelity in LADDERS["rib"]:
        Rib(RibGeometry.validation(), fidelity=fidelity, comm=comm).bend(torque=1e-3)
    for name, (geometry, solid) in SOLIDS.items():
        case = {"scene": "rib", "case": name, "n_cells": geometry.n_cells, "load": "1 N mm"}
        for fidelity in LADDERS["rib"]:
            found = row(comm, case, partial(Rib, geometry, fidelity=fidelity, comm=comm),
                        lambda scene: scene.bend(torque=1.0), "chord_angle_deg")[0]
            yield found | {"error": found["angle_deg"] / solid - 1.0}
