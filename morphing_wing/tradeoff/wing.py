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
    "10 kPa": ({"upper": 0.01}, "span_angle_deg"),
    "0.05 N": ({"cable": 0.05}, "rib_2_rotation_deg"),
}
CASES = {
    "no skin": ({"skin_thickness": None}, ("20 kPa", "0.05 N")),
    # Beyond, the skin folds and touches: minutes on the finest mesh, and more than one way to fold.
    "skin": ({}, ("10 kPa", "0.05 N")),
}


def rows(comm: MPI.Comm, everything: bool) -> Iterator[dict[str, Any]]:
    """Measure all rungs; all of the cases, or without skin under pressure only. Collective."""
    for name, (changes, loads) in CASES.items():
        if not everything and name != "no skin":
            break
        geometry = WingGeometry.prototype(**changes)
        for fidelity in LADDERS["wing"]:  # compiles
            small = WingGeometry.prototype(n_cells=2, rib_positions=(0.5,), **changes)
            Wing(small, fidelity=fidelity, comm=comm).actuate(upper=1e-5, cable=1e-5)
        for load in loads if everything else loads[:1]:
            given, angle = LOADS[load]
            finest = Wing(geometry, fidelity="standard", meshing=WingMeshing.graded(),
                          comm=comm).actuate(**given)
            exact = finest[-1].measures[angle] if finest.converged else float("nan")
            del finest
            case = {"scene": "wing", "case": name, "n_cells": geometry.n_cells, "load": load}
            for fidelity in LADDERS["wing"]:
                found = row(comm, case, partial(Wing, geometry, fidelity=fidelity, comm=comm),
                            lambda scene, given=given: scene.actuate(**given), angle)[0]
                yield found | {"error": found["angle_deg"] / exact - 1.0}
