"""What the curves of Figure 5 are, and their points in its table."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
import pandas as pd

__all__ = ["COLUMNS", "Curve", "points_of"]

COLUMNS = {"spar": ("pressure_MPa", "span_angle_deg"), "rib": ("torque_Nmm", "chord_angle_deg")}
"""Load and angle of each half."""


class Curve(NamedTuple):
    """Which curve: of "spar" or "rib", how computed, and how the rib's section is read."""

    scene: str
    fidelity: str
    reading: str = ""

    def __str__(self) -> str:
        """Return the curve in words."""
        return ", ".join(filter(None, self))


def points_of(table: pd.DataFrame, curve: Curve) -> tuple[np.ndarray, np.ndarray]:
    """Return a curve's load and angle at the loads asked for, but for zero."""
    load, angle = COLUMNS[curve.scene]
    of_curve = (table[list(Curve._fields)] == pd.Series(curve._asdict())).all(axis=1)
    rows = table[of_curve & table["requested"] & (table[load] > 0.0)]
    return rows[load].to_numpy(float), rows[angle].to_numpy(float)
