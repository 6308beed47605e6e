"""The ladders of fidelities, what each rung costs and errs as measured, and which one to take.

The figures stand in ``measured/*.csv`` beside this module; ``morphing-wing tradeoff SCENE --keep``
measures them anew.
"""

from __future__ import annotations

import csv
import math
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cache
from importlib import resources
from typing import Any

from morphing_wing.errors import InputError, is_number, require

__all__ = ["AUTO", "LADDERS", "Pick", "errors_of", "pick"]

LADDERS = {
    "spar": ("instant", "cell", "draft", "standard", "reference"),
    "rib": ("instant", "cell", "draft", "standard", "reference"),
    "wing": ("draft", "standard", "reference"),
}
"""Rungs that each scene has, cheapest first."""

AUTO = "auto"
"""In place of a rung: the cheapest one whose measured error is within the tolerance."""

TOLERANCE = 0.02


@dataclass(frozen=True)
class Pick:
    """A rung and how far it is off.

    Attributes
    ----------
    fidelity
        Name of the rung.
    error
        Largest relative error of the angle that was measured of it in scenes like the wanted one;
        None: nothing like it was measured.
    """

    fidelity: str
    error: float | None


def pick(
    scene: str,
    fidelity: str,
    tolerance: float | None = None,
    n_cells: int = 0,
    allowed: Sequence[str] | None = None,
) -> Pick:
    """Return the rung of a name, or for "auto" the cheapest that is accurate enough.

    Parameters
    ----------
    scene
        "spar", "rib" or "wing".
    fidelity, tolerance
        Name of a rung, or "auto" and the relative error that is allowed; None: 0.02.
    n_cells
        Chambers in a row, or cells of the rib: errors are those measured at the next smaller count.
    allowed
        The rungs to pick from; None: all of the scene's.

    Raises
    ------
    InputError
        If there is no such rung, or none of them is as accurate as the tolerance asks.
    """
    rungs = LADDERS[scene]
    if fidelity != AUTO:
        if fidelity not in rungs:
            raise InputError(
                f"fidelity = {fidelity!r}: must be one of {', '.join(rungs)}, or {AUTO}")
        if tolerance is not None:
            raise InputError(f"tolerance = {tolerance!r}: must be left out unless fidelity is "
                             f"{AUTO!r}")
        return Pick(fidelity, errors_of(scene, n_cells).get(fidelity))
    tolerance = TOLERANCE if tolerance is None else tolerance
    require(is_number(tolerance) and tolerance > 0.0, "tolerance", tolerance, "",
            "a relative error of the angle greater than 0")
    errors = errors_of(scene, n_cells)
    known = {name: error for name, error in errors.items() if name in (allowed or rungs)}
    for name, error in known.items():
        if error <= tolerance:
            return Pick(name, error)
    if not known:
        raise InputError(f"fidelity = {AUTO!r}: must be one of {', '.join(rungs)} until 'tradeoff "
                         f"{scene} --keep' has measured them")
    best = min(known, key=known.__getitem__)
    raise InputError(f"tolerance = {tolerance:g}: must be at least {known[best]:.2g}, the measured "
                     f"error of the most accurate rung, {best}")


def errors_of(scene: str, n_cells: int = 0) -> dict[str, float]:
    """Return of each measured rung its largest relative error, cheapest rungs first; see `pick`."""
    rows = _measured(scene)
    counts = sorted({row["n_cells"] for row in rows})
    near = max((count for count in counts if count <= n_cells), default=min(counts, default=0))
    rows = [row for row in rows if row["n_cells"] == near]
    found: dict[str, float] = {}
    for row in sorted(rows, key=lambda row: row["seconds"]):
        error = abs(row["error"]) if math.isfinite(row["error"]) else math.inf
        found[row["fidelity"]] = max(found.get(row["fidelity"], 0.0), error)
    return found


def kept_exact(scene: str, case: str) -> float:
    """Return the angle in degrees against which the kept errors of a case were taken."""
    return next(row["angle_deg"] / (1.0 + row["error"]) for row in _measured(scene)
                if row["case"] == case)


@cache
def _measured(scene: str) -> list[dict[str, Any]]:
    file = resources.files("morphing_wing") / "measured" / f"{scene}.csv"
    if not file.is_file():
        return []
    with file.open(encoding="utf-8") as text:
        return [{"fidelity": row["fidelity"], "n_cells": int(row["n_cells"]),
                 "case": row["case"], "error": float(row["error"]),
                 "angle_deg": float(row["angle_deg"]),
                 # Some angles were taken without their cost.
                 "seconds": math.inf if row["seconds"] in ("", "nan") else float(row["seconds"])}
                for row in csv.DictReader(text)]
