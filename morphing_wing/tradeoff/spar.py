"""The spar's trade: the paper's validation set, and sets around it for what "auto" relies on."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import replace
from functools import partial
from typing import Any

from mpi4py import MPI

from ..geometry.spar import SparGeometry, SparMeshing
from ..ladder import LADDERS
from ..path import Path
from ..spar import Spar
from .trial import row

ANGLE = "span_angle_deg"
PRESSURES = (0.02, 0.04)
"""In MPa; seconds are those to the first."""

_VALIDATION = SparGeometry.validation()
GEOMETRIES = {
    "3.3": _VALIDATION,
    "Table 2, row 3": replace(
        _VALIDATION, wall_length=2.0, cavity_length=2.8, top_thickness=1.4),
    "Table 2, row 7": replace(
        _VALIDATION, wall_length=2.4, cavity_length=2.0, top_thickness=1.4),
    "Table 2, row 8": replace(
        _VALIDATION, wall_length=2.4, cavity_length=2.4, top_thickness=1.0),
    "5.1": SparGeometry(
        cavity_length=5.0, wall_length=2.0, top_thickness=2.0, cavity_height=6.0,
        middle_thickness=1.5, side_thickness=2.0, cavity_width=40.0, n_cells=20),
}
"""The paper's sets, the last as a cuboid."""

COUNTS = (20, 1, 2, 4)
WHOLE = 4
"""Chambers from which on a spar is one of as many and more of the cell that repeats itself."""

FINER = 2
"""Of the mesh of the angle that errors are relative to; its own error is a quarter of the one's."""


def rows(comm: MPI.Comm, everything: bool) -> Iterator[dict[str, Any]]:
    """Measure all rungs; all of the cases, or Section 3.3's at 20 kPa only. Collective."""
    for fidelity in LADDERS["spar"]:
        Spar(SparGeometry.validation(1), fidelity=fidelity, comm=comm).inflate(upper=1e-3)
    for name, shape in GEOMETRIES.items() if everything else [("3.3", _VALIDATION)]:
        pressures = PRESSURES if everything else PRESSURES[:1]
        long_ones = _Finest(comm, shape, pressures)
        for n in COUNTS if everything else COUNTS[:1]:
            geometry = replace(shape, n_cells=n)
            case = {"scene": "spar", "case": name, "n_cells": n}
            finest = long_ones.angles(n)
            for fidelity in LADDERS["spar"]:
                if fidelity == "reference" and n > WHOLE and name != "3.3":
                    continue  # minutes, and as far off as elsewhere
                found, path = row(
                    comm, case | {"load": f"{1000 * pressures[0]:g} kPa"},
                    partial(Spar, geometry, fidelity=fidelity, comm=comm),
                    partial(_inflated, pressures[0]), ANGLE)
                yield found | {"error": found["angle_deg"] / finest[0] - 1.0}
                if fidelity != "reference" or n <= WHOLE:
                    yield from _led_on(path.scene, found, pressures[1:], finest[1:])
                del path  # its scene would count in the memory of the next


def _inflated(pressure: float, scene: Spar) -> Path:
    return scene.inflate(upper=pressure)


def _angles(scene: Spar, pressures: Sequence[float]) -> list[float]:
    path = scene.inflate(upper=pressures)
    assert path.converged, path.reason
    return [state.measures[ANGLE] for state in path if state.requested]


def _led_on(
    scene: Spar, found: dict[str, Any], pressures: Sequence[float], finest: Sequence[float]
) -> Iterator[dict[str, Any]]:
    """Lead a scene on to more pressures, of which only the angles count."""
    for pressure, exact in zip(pressures, finest, strict=True):
        path = scene.inflate(upper=pressure)
        angle = path[-1].measures[ANGLE] if path.converged else float("nan")
        costs = dict.fromkeys(("iterations", "assembly_s", "factor_s", "seconds", "peak_MB"))
        yield found | costs | {"load": f"{1000 * pressure:g} kPa", "angle_deg": angle,
                               "error": angle / exact - 1.0}


class _Finest:
    """Angles of spars of any length on the finest mesh: a whole spar, then more of its cells."""

    def __init__(self, comm: MPI.Comm, shape: SparGeometry, pressures: Sequence[float]) -> None:
        self._comm, self._shape, self._pressures = comm, shape, pressures
        self._fine, self._coarse = (
            [angle / shape.n_cells for angle in _angles(
                Spar(shape, fidelity="cell", meshing=SparMeshing.cornered(level), comm=comm),
                pressures)]
            for level in (FINER, 1))
        self._whole = self._few(WHOLE)

    def _few(self, n: int) -> list[float]:
        geometry = replace(self._shape, n_cells=n)
        return _angles(Spar(geometry, fidelity="reference", comm=self._comm), self._pressures)

    def angles(self, n: int) -> list[float]:
        """Return the angle in degrees of n chambers at each pressure."""
        few = self._whole if n >= WHOLE else self._few(n)
        return [angle + n * fine - min(n, WHOLE) * coarse for angle, fine, coarse
                in zip(few, self._fine, self._coarse, strict=True)]
