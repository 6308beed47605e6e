"""The wing's trade: the paper's prototype without its skin, under pressure and cables.

Errors are relative to "reference" with ribs of `FINEST` elements around a pivot in place of 6,
times what the angle of a wing with frames grows by from its mesh of the elastomer to `FINE`.
With its skin, which folds and touches, the finest mesh takes more than ten minutes a load; README
compares the rungs there.
"""

from __future__ import annotations

import gc
from collections.abc import Iterator
from functools import partial
from typing import Any

from mpi4py import MPI

from ..burial import bury
from ..geometry.hexmesh import two_sided
from ..geometry.wing import WingGeometry
from ..geometry.wing_mesh import WingMeshing
from ..ladder import LADDERS
from ..wing import Wing
from .trial import row

FINEST = 8
FINE = WingMeshing.of(
    cavity_width=two_sided(8, 2.0), pocket=9, cavity_length=two_sided(5, 2.5), cavity_height=2,
    wall_length=2, top_thickness=2, middle_thickness=2, side_thickness=2)
LOADS = {
    "20 kPa": ({"upper": 0.02}, "span_angle_deg"),
    "0.05 N": ({"cable": 0.05}, "rib_2_rotation_deg"),
}


def rows(comm: MPI.Comm, everything: bool) -> Iterator[dict[str, Any]]:
    """Measure all rungs; under pressure and cables, or under pressure only. Collective."""
    for fidelity in LADDERS["wing"]:  # compiles
        small = WingGeometry.prototype(n_cells=2, skin_thickness=None, rib_positions=(0.5,))
        Wing(small, fidelity=fidelity, comm=comm).actuate(upper=1e-5, cable=1e-5)
    geometry = WingGeometry.prototype(skin_thickness=None)
    for load, (given, angle) in list(LOADS.items())[: None if everything else 1]:
        finest, fine, graded = (_angle(angle, given, geometry, comm, **options) for options in (
            {"fidelity": "reference", "around": FINEST},
            {"fidelity": "standard", "meshing": FINE},
            {"fidelity": "standard", "meshing": WingMeshing.graded()}))
        exact = finest * fine / graded
        case = {"scene": "wing", "case": "no skin", "n_cells": geometry.n_cells, "load": load}
        for fidelity in LADDERS["wing"]:
            found = row(comm, case, partial(Wing, geometry, fidelity=fidelity, comm=comm),
                        lambda scene, given=given: scene.actuate(**given), angle)[0]
            yield found | {"error": found["angle_deg"] / exact - 1.0}


def _angle(
    angle: str, given: dict[str, float], geometry: WingGeometry, comm: MPI.Comm, **options: Any
) -> float:
    path = Wing(geometry, comm=comm, **options).actuate(**given)
    found = path[-1].measures[angle] if path.converged else float("nan")
    del path
    gc.collect()  # and with it the wing, on all ranks at once
    bury(comm)
    return found
