"""The paper's Figure 6 as a study: one factor at a time, phi_1 of the spar and phi_2 of the rib.

A is the spar of Table 2 under its 20 kPa, B the rib of Table 3 under an end moment: the paper plots
B for "an equivalent force loading to torque", of which it states no size, so that one moment is
fitted, anew for each fidelity and each reading of the bars' section, to those rows of Table 3 that
are points of B. As for Table 3 each rib is solved under 1 N mm and scaled. The figure itself is not
at hand; what the paper says about it is in `claims`.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from typing import Any

from mpi4py import MPI

from morphing_wing.bulge import Bulge
from morphing_wing.errors import require
from morphing_wing.figure5 import ALL_RUNGS, FIDELITIES
from morphing_wing.figure5_curves import Curve
from morphing_wing.ladder import LADDERS
from morphing_wing.path import Path
from morphing_wing.rib import Rib
from morphing_wing.solved_case import solved_case
from morphing_wing.spar import Spar
from morphing_wing.table2 import PRESSURE, spar_of
from morphing_wing.table3 import rib_of

from .points import PANELS
from .result import MEASURES, Figure6

__all__ = ["READINGS", "figure6"]

READINGS = ("flush", "square")
"""How the section of the rib's bars may be read, see `RibGeometry`."""

Told = Callable[["Figure6", Curve, Mapping[str, Any]], None]


def figure6(
    fidelities: Sequence[str] | None = None,
    readings: Sequence[str] = READINGS,
    comm: MPI.Comm | None = None,
    told: Told | None = None,
    done: Callable[[Figure6], None] | None = None,
    before: Mapping[Curve, Mapping[tuple[str, ...], dict[str, Any]]] | None = None,
) -> Figure6:
    """Compute the 18 points of each half of Figure 6.

    Parameters
    ----------
    fidelities
        Rungs of either ladder, see `Spar` and `Rib`; those that a half does not have are left out
        of it. None: the formula, and the cheapest finite elements of each half.
    readings
        Some of `READINGS`, for the rib; each has a moment of its own.
    comm
        Communicator; all ranks of MPI by default.
    told
        Called with the study, the series and the row of each case as soon as it is solved.
    done
        Called after each series with the study so far.
    before
        `Figure6.solved` of a run that did not end: its cases are not solved again.
    """
    for name in fidelities or ():
        require(name in ALL_RUNGS, "fidelity", name, "", f"one of {', '.join(ALL_RUNGS)}")
    for name in readings:
        require(name in READINGS, "reading", name, "", f"one of {', '.join(READINGS)}")
    study = Figure6(comm or MPI.COMM_WORLD)
    for curve in _series(fidelities, readings):
        panel = PANELS[curve.scene]
        rows = study.solved[curve] = dict((before or {}).get(curve, {}))
        for levels in panel.points[list(panel.levels)].drop_duplicates().to_dict("records"):
            key = tuple(levels.values())
            if key in rows:
                continue
            rows[key] = solved_case(levels, panel.table.angle,
                                    lambda case, c=curve: _run(c, case, study.comm), MEASURES)
            if told is not None:
                told(study, curve, rows[key])
        study.finished.append(curve)
        if done is not None:
            done(study)
    return study


def _series(fidelities: Sequence[str] | None, readings: Sequence[str]) -> Iterator[Curve]:
    for scene, usual in FIDELITIES.items():
        for fidelity in dict.fromkeys(fidelities or usual):
            if fidelity in LADDERS[scene]:
                for reading in dict.fromkeys(readings) if scene == "rib" else ("",):
                    yield Curve(scene, fidelity, reading)


def _run(curve: Curve, levels: Mapping[str, str], comm: MPI.Comm) -> Path:
    if curve.scene == "rib":
        rib = Rib(rib_of(levels, curve.reading), fidelity=curve.fidelity, comm=comm)
        return rib.bend(torque=1.0)
    spar = Spar(spar_of(levels), fidelity=curve.fidelity, comm=comm)
    if curve.fidelity != "instant":
        spar.watch.append(Bulge(spar))
    return spar.inflate(upper=PRESSURE)
