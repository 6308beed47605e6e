"""The wing's trade: the paper's prototype with and without its skin, pressure and cables.

Errors are relative to the element of "standard" on a mesh graded at the chambers' corners.
"""

from __future__ import annotations

from collections.abc import Iterator
from functools import partial
from typing import Any

from mpi4py import MPI

from ..geometry.wing import WingGeometry
from ..geometry.wing_mesh import WingMeshing
from ..ladder import LADDERS
from ..wing import Wing
from .trial import row

LOADS = {
    "20 kPa": ({"upper": 0.02}, "span_angle_deg"),
    "0.05 N": ({"cable": 0.05}, "rib_2_rotation_deg"),
}
SKINS = {"no skin": {"skin_thickness": None}, "skin": {}}


def rows(comm: MPI.Comm, everything: bool) -> Iterator[dict[str, Any]]:
    """Measure all rungs; all of the cases, or without skin under pressure only. Collective."""
    skins = SKINS if everything else {"no skin": SKINS["no skin"]}
    loads = LOADS if everything else {"20 kPa": LOADS["20 kPa"]}
    for name, changes in skins.items():
        geometry = WingGeometry.prototype(**changes)
        for fidelity in LADDERS["wing"]:  # compiles
            small = WingGeometry.prototype(n_cells=2, rib_positions=(0.5,), **changes)
            Wing(small, fidelity=fidelity, comm=comm).actuate(upper=1e-5, cable=1e-5)
        for load, (given, angle) in loads.items():
            finest = Wing(geometry, fidelity="standard", meshing=WingMeshing.graded(),
                          comm=comm).actuate(**given)
            exact = finest[-1].measures[angle] if finest.converged else float("nan")
            del finest
            case = {"scene": "wing", "case": name, "n_cells": geometry.n_cells, "load": load}
            for fidelity in LADDERS["wing"]:
                found = row(comm, case, partial(Wing, geometry, fidelity=fidelity, comm=comm),
                            lambda scene, given=given: scene.actuate(**given), angle)[0]
                yield found | {"error": found["angle_deg"] / exact - 1.0}
