"""What the curves of Figure 7 say in figures: limits reached, fidelities, skin, coupling.

All of it from the long table of `figure7.Figure7.table`, so a saved ``table.csv`` does as well.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

import numpy as np
import pandas as pd

from morphing_wing.ladder import LADDERS
from morphing_wing.materials import YIELD_MPA

__all__ = ["KEYS", "PANELS", "Panel", "coupling", "facts", "reached_at", "words"]

KEYS = ["panel", "skin", "direction", "fidelity"]
"""Columns that name a curve."""


@dataclass(frozen=True)
class Panel:
    """One half of Figure 7.

    Attributes
    ----------
    load, factor, unit
        Load's column in the table, and the unit in which it is told.
    angle, line
        Columns of the angle that the load is for: face rotation, and deflection line.
    space
        Column of that face's rotation in space, where the angle is told against the spar.
    other
        Column of the angle that it should leave alone.
    limit_deg
        Angle that the paper's test reached.
    """

    load: str
    factor: float
    unit: str
    angle: str
    line: str
    space: str | None
    other: str
    limit_deg: float

    def words(self, load: float) -> str:
        """Return a load as one reads it."""
        return f"{self.factor * load:.3g} {self.unit}"


PANELS = {
    "pressure": Panel("pressure_MPa", 1000.0, "kPa", "span_angle_deg", "span_line_deg", None,
                      "chord_angle_deg", 12.0),
    "cables": Panel("cable_N", 1.0, "N", "chord_angle_deg", "chord_line_deg",
                    "trailing_edge_deg", "span_angle_deg", 35.0),
}


def facts(table: pd.DataFrame) -> dict[str, list[dict[str, Any]]]:
    """Return the facts, ready for JSON.

    Parameters
    ----------
    table
        Long table with the columns `KEYS`, ``load`` (MPa or N), the angles, ``requested``.

    Returns
    -------
    dict
        ``curves``: of each curve the load at which the paper's angle is reached (``reached_at``
        by the face's rotation, ``line_reached_at`` by the deflection line, ``space_reached_at`` by
        the trailing edge against the horizontal, None: not reached or no such angle),
        the last load and angles, the coupling there (``coupling_deg`` and its ratio to the main
        angle), where the ribs' resin yields (``resin_yields_at``, None: nowhere, or not measured),
        and from which load on the skin touches something (``touching_from``), or passes through it
        for want of contact forces (``contact_from``), and the state is unstable
        (``unstable_from``).
        ``fidelities``: the largest relative difference of the angle to that of the finest.
        ``skin``: angle without skin over angle with it.
    """
    if table.empty:
        return {"curves": [], "fidelities": [], "skin": []}
    curves = {key: rows for key, rows in table.groupby(KEYS, sort=False)}
    return {
        "curves": [_named(key) | _curve(PANELS[key[0]], rows) for key, rows in curves.items()],
        "fidelities": list(_fidelities(curves)),
        "skin": list(_skin(curves)),
    }


def words(fact: dict[str, Any], by: str = "") -> str:
    """Return in words where a curve's limit is reached.

    ``by`` is "" for the face's rotation, "line_" for the deflection line, "space_" for the face
    against the horizontal.
    """
    panel = PANELS[fact["panel"]]
    if by == "space_" and panel.space is None:
        return "-"
    at = fact[f"{by}reached_at"]
    if at is not None:
        return f"{fact['limit_deg']:g} deg at {panel.words(at)}"
    last = fact[f"last_{by or 'angle_'}deg"]
    if last is None:
        return "not measured"
    return f"not reached, {abs(last):.3g} deg at {panel.words(fact['last_load'])}"


def reached_at(load: np.ndarray, angle: np.ndarray, limit: float) -> float | None:
    """Return the least load at which an angle's size is ``limit``, straight between points.

    Parameters
    ----------
    load, angle
        Points of a curve in the order in which it was run; from load 0, angle 0.
    limit
        In the angle's unit.

    Returns
    -------
    The load, None where the curve stays below the limit.
    """
    load, size = np.append(0.0, load), np.append(0.0, np.abs(angle))
    beyond = np.flatnonzero(size >= limit)
    if len(beyond) == 0:
        return None
    i = beyond[0]
    part = (limit - size[i - 1]) / (size[i] - size[i - 1])
    return float(load[i - 1] + part * (load[i] - load[i - 1]))


def coupling(angle: float, other: float) -> float | None:
    """Return the angle that should not be over the one that should; None without the latter."""
    return float(other / angle) if np.isfinite(other) and angle != 0.0 else None


def _named(key: tuple) -> dict[str, Any]:
    panel, skin, direction, fidelity = key
    return {"panel": panel, "skin": bool(skin), "direction": direction, "fidelity": fidelity}


def _curve(panel: Panel, rows: pd.DataFrame) -> dict[str, Any]:
    load = rows["load"].to_numpy(float)
    angle, line, space, other = (
        _column(rows, name) for name in (panel.angle, panel.line, panel.space, panel.other))
    return {
        "limit_deg": panel.limit_deg,
        "reached_at": reached_at(load, angle, panel.limit_deg),
        "line_reached_at": reached_at(load, line, panel.limit_deg),
        "space_reached_at": reached_at(load, space, panel.limit_deg),
        "last_load": float(load[-1]),
        "last_angle_deg": float(angle[-1]),
        "last_line_deg": _number(line[-1]),
        "last_space_deg": _number(space[-1]),
        "coupling_deg": _number(other[-1]),
        "coupling": coupling(angle[-1], other[-1]),
        "resin_yields_at": reached_at(load, _column(rows, "rib_stress_MPa"), YIELD_MPA),
        "contact_from": _first(load, _column(rows, "contact", 0.0) > 0.0),
        "touching_from": _first(load, _column(rows, "touching", 0.0) > 0.0),
        "unstable_from": _first(load, _column(rows, "negative_pivots", 0.0) > 0.0),
    }


def _fidelities(curves: dict[tuple, pd.DataFrame]) -> Iterator[dict[str, Any]]:
    """Compare every curve with that of the finest fidelity that stands beside it."""
    ladder = LADDERS["wing"]
    for key, rows in curves.items():
        finest = max((k for k in curves if k[:3] == key[:3]), key=lambda k: ladder.index(k[3]))
        both = _side_by_side(rows, curves[finest], PANELS[key[0]].angle)
        if finest == key or both.empty:
            continue
        difference = (both["one"] / both["two"] - 1.0).abs()
        yield _named(key) | {
            "against": finest[3], "largest_difference": float(difference.max()),
            "at_load": float(difference.idxmax()),
        }


def _skin(curves: dict[tuple, pd.DataFrame]) -> Iterator[dict[str, Any]]:
    for key, rows in curves.items():
        panel, skin, *rest = key
        bare = curves.get((panel, False, *rest))
        if not skin or bare is None:
            continue
        both = _side_by_side(rows, bare, PANELS[panel].angle)
        if len(both):
            last = both.iloc[-1]
            yield {name: value for name, value in _named(key).items() if name != "skin"} | {
                "load": float(both.index[-1]), "with_deg": float(last["one"]),
                "without_deg": float(last["two"]), "without_over_with": last["two"] / last["one"],
            }


def _side_by_side(one: pd.DataFrame, two: pd.DataFrame, angle: str) -> pd.DataFrame:
    """Return an angle of two curves at the loads that both were asked for, by load."""
    parts = {}
    for name, rows in (("one", one), ("two", two)):
        asked = rows[rows["requested"] & (rows["load"] > 0.0)]
        parts[name] = asked.set_index(asked["load"].round(12))[angle]
    both = pd.DataFrame(parts).dropna()
    return both[(both != 0.0).all(axis=1)]


def _column(rows: pd.DataFrame, name: str | None, missing: float = np.nan) -> np.ndarray:
    if name not in rows:
        return np.full(len(rows), missing)
    return rows[name].fillna(missing).to_numpy(float)


def _number(value: float) -> float | None:
    return float(value) if np.isfinite(value) else None


def _first(load: np.ndarray, flag: np.ndarray) -> float | None:
    return float(load[flag.argmax()]) if flag.any() else None
