"""The rib's trade, against the limit of refined solids."""

from __future__ import annotations

import gc
from collections.abc import Iterator
from dataclasses import replace
from functools import partial
from typing import Any

from mpi4py import MPI

from ..burial import bury
from ..geometry.rib import RibGeometry
from ..ladder import LADDERS, kept_exact
from ..rib import Rib
from ..solid_rib import AROUND
from .limit import limit
from .trial import row

CASES = {
    "3.3, square": RibGeometry.validation("square", bosses=True),
    "3.3, flush": RibGeometry.validation("flush"),
    "5.1, square": RibGeometry.prototype(6, "square", bosses=True),
    "5.1, flush": RibGeometry.prototype(6, "flush"),
}
MESHES = (8, 15)
"""Elements around a cylinder of solids beside "standard" and "reference": the limit of all four is
taken for exact."""


def rows(comm: MPI.Comm, everything: bool) -> Iterator[dict[str, Any]]:
    """Measure all rungs on the paper's ribs, square ones with bosses, under 1 N mm. Collective.

    The limit is found anew where ``everything`` is measured; else it is that of the kept figures.
    """
    for fidelity in LADDERS["rib"]:  # compiles, and keeps no condensed cell of the cases
        short = replace(RibGeometry.validation(), n_cells=1, shaft_length=7.0)
        solid = {"around": 6} if fidelity in AROUND else {}
        Rib(short, fidelity=fidelity, comm=comm, **solid).bend(torque=1e-3)
    for name, geometry in CASES.items():
        case = {"scene": "rib", "case": name, "n_cells": geometry.n_cells, "load": "1 N mm"}
        found = [row(comm, case, partial(Rib, geometry, fidelity=fidelity, comm=comm),
                     lambda scene: scene.bend(torque=1.0), "chord_angle_deg")[0]
                 for fidelity in LADDERS["rib"]]
        solids = {AROUND[rung["fidelity"]]: rung["angle_deg"] for rung in found
                  if rung["fidelity"] in AROUND}
        exact = _limit(comm, geometry, solids) if everything else kept_exact("rib", name)
        for rung in found:
            yield rung | {"error": rung["angle_deg"] / exact - 1.0}


def _limit(comm: MPI.Comm, geometry: RibGeometry, angles: dict[int, float]) -> float:
    """Return the angle in degrees that solids lead to, some of which are known."""
    for around in MESHES:
        path = Rib(geometry, fidelity="reference", comm=comm, around=around).bend(torque=1.0)
        angles[around] = path[-1].measures["chord_angle_deg"]
        del path
        gc.collect()  # and with it the rib, on all ranks at once
        bury(comm)
    return limit(*zip(*sorted(angles.items()), strict=True))[0]
