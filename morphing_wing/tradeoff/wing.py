"""The wing's trade: the paper's prototype without its skin, under pressure and cables.

Errors are relative to "reference" times what the angle of a wing of `SHORT` cells grows by when its
mesh is refined further: once along the chord, once along the span, once through the walls.
With its skin, which folds and touches, the finest mesh takes more than ten minutes a load; README
compares the rungs there.
"""

from __future__ import annotations

import gc
import math
from collections.abc import Iterator
from dataclasses import replace
from functools import partial
from typing import Any

from mpi4py import MPI

from ..burial import bury
from ..geometry.hexmesh import two_sided, uniform
from ..geometry.wing import WingGeometry
from ..ladder import LADDERS
from ..wing import Wing
from ..wing_rungs import FIDELITIES
from .trial import row

SHORT = 3
FURTHER = (
    {"cavity_width": two_sided(12, 2.0)},
    {"cavity_length": two_sided(7, 2.5)},
    dict.fromkeys(("wall_length", "top_thickness", "middle_thickness", "side_thickness"),
                  uniform(3)),
)
"""Breakpoints in place of those of `WingMeshing.resolved`."""

LOADS = {
    "20 kPa": ({"upper": 0.02}, "span_angle_deg", "span_angle_deg"),
    "0.05 N": ({"cable": 0.05}, "rib_2_rotation_deg", "rib_1_rotation_deg"),
}


def rows(comm: MPI.Comm, everything: bool) -> Iterator[dict[str, Any]]:
    """Measure all rungs; under pressure and cables, or under pressure only. Collective."""
    for fidelity in LADDERS["wing"]:  # compiles
        small = WingGeometry.prototype(n_cells=2, skin_thickness=None, rib_positions=(0.5,))
        Wing(small, fidelity=fidelity, comm=comm).actuate(upper=1e-5, cable=1e-5)
    geometry = WingGeometry.prototype(skin_thickness=None)
    for load, (given, angle, short_angle) in list(LOADS.items())[: None if everything else 1]:
        case = {"scene": "wing", "case": "no skin", "n_cells": geometry.n_cells, "load": load}
        found = [row(comm, case, partial(Wing, geometry, fidelity=fidelity, comm=comm),
                     lambda scene, given=given: scene.actuate(**given), angle)[0]
                 for fidelity in LADDERS["wing"]]
        exact = found[-1]["angle_deg"] * _growth(comm, given, short_angle)
        for rung in found:
            yield rung | {"error": rung["angle_deg"] / exact - 1.0}


def _growth(comm: MPI.Comm, given: dict[str, float], angle: str) -> float:
    """Return what further refinements of a short wing's "reference" multiply its angle by."""
    short = WingGeometry.prototype(n_cells=SHORT, skin_thickness=None, rib_positions=(0.5,))
    angles = []
    for further in ({}, *FURTHER):
        meshing = replace(FIDELITIES["reference"].meshing, **further)
        path = Wing(short, fidelity="reference", comm=comm, meshing=meshing).actuate(**given)
        angles.append(path[-1].measures[angle] if path.converged else math.nan)
        del path
        gc.collect()  # and with it the wing, on all ranks at once
        bury(comm)
    return math.prod(angle / angles[0] for angle in angles[1:])
