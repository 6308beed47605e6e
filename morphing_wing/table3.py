"""The paper's Table 3 as a study: phi_2 of nine ribs under an end moment, which is fitted.

The paper does not state the moment. One for all nine rows is fitted to the printed angles by least
squares, anew for each fidelity and each reading of the bars' section; it scales the angles and
cannot change their ratios. A rib's angle is linear in the moment, within 0.5 % up to 45 degrees
(frame and solid), so each row is solved once, under 1 N mm, and scaled.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from typing import Any

import numpy as np
import pandas as pd
from mpi4py import MPI

from .errors import require
from .geometry.rib import RibGeometry
from .ladder import LADDERS
from .path import Path
from .printed_tables import TABLE_3
from .rib import Rib
from .table_study import Series, TableStudy, Told, solved

__all__ = ["N_CELLS", "READINGS", "readings_of", "table3"]

N_CELLS = 6
"""Of Section 3.3; Section 4 states none. Where the moment is fitted it hardly matters."""

READINGS: dict[str, dict[str, Any]] = {
    "flush": {"section": "flush"},
    "square": {"section": "square"},
    "square, bosses": {"section": "square", "bosses": True},
}
"""How the missing figure of the bars' section may be read, see `RibGeometry`."""


def readings_of(fidelity: str) -> tuple[str, ...]:
    """Return the readings that a fidelity tells apart: the paper's formula knows no bosses."""
    return tuple(name for name, section in READINGS.items()
                 if fidelity != "instant" or "bosses" not in section)


def table3(
    fidelities: Sequence[str] = ("instant", "draft"),
    readings: Sequence[str] = tuple(READINGS),
    comm: MPI.Comm | None = None,
    told: Told | None = None,
    done: Callable[[TableStudy], None] | None = None,
) -> TableStudy:
    """Compute Table 3's rows in each reading, under its fitted end moment.

    Parameters
    ----------
    fidelities
        Rungs of the rib's ladder, see `Rib`.
    readings
        Some of `READINGS`, each with a moment of its own.
    comm
        Communicator; all ranks of MPI by default.
    told
        Called with each row under 1 N mm as soon as it is known.
    done
        Called after each reading of each fidelity with the study so far.
    """
    rungs = LADDERS["rib"]
    for name in fidelities:
        require(name in rungs, "fidelity", name, "", f"one of {', '.join(rungs)}")
    for name in readings:
        require(name in READINGS, "reading", name, "", f"one of {'; '.join(READINGS)}")
    study = TableStudy(TABLE_3, comm or MPI.COMM_WORLD, {
        "n_cells": N_CELLS, "end_moment": "one for all rows of a series, fitted by least squares"})
    for fidelity in dict.fromkeys(fidelities):
        for reading in filter(readings_of(fidelity).__contains__, readings):
            def run(levels: Mapping[str, str], f: str = fidelity, r: str = reading) -> Path:
                return Rib(rib_of(levels, r), fidelity=f, comm=study.comm).bend(torque=1.0)

            series = Series(fidelity, reading)
            study.parts[series] = fitted(solved(TABLE_3, series, run, told))
            if done is not None:
                done(study)
    return study


def rib_of(levels: Mapping[str, str], reading: str) -> RibGeometry:
    """Return the rib of a row of Table 3: its ratios are printed as lengths in mm."""
    shaft_thickness, pivot_length = map(float, levels["T_rs/l_cs"].split("/"))
    pivot_diameter, shaft_length = map(float, levels["D_cs/l_rs"].split("/"))
    return RibGeometry(shaft_length, shaft_thickness, pivot_diameter, pivot_length,
                       float(levels["alpha"]), N_CELLS, **READINGS[reading])


def fitted(part: pd.DataFrame) -> pd.DataFrame:
    """Scale rows under 1 N mm to the end moment that fits the angles printed of them best."""
    angle, per_Nmm = TABLE_3.angle, part[TABLE_3.angle]
    found = part[per_Nmm.notna() & part["printed_deg"].notna()]
    moment = np.nan
    if len(found):
        moment = found["printed_deg"] @ found[angle] / (found[angle] @ found[angle])
    part.insert(part.columns.get_loc(angle), "deg_per_Nmm", per_Nmm)
    part.insert(part.columns.get_loc(angle), "fitted_torque_Nmm", moment)
    return part.assign(**{angle: moment * per_Nmm, "energy_Nmm": moment**2 * part["energy_Nmm"]})
