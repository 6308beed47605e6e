"""Outputs of a case at fidelity "instant", of many changes of it at once.

The same figures as `run_case` gives of each change alone, a thousand times as fast. There are none
where a scene has no formula, or a key is none of the formula's.
"""

from __future__ import annotations

import dataclasses
from collections.abc import Callable, Mapping, Sequence
from typing import Any

import numpy as np

from morphing_wing.analytic_rib import RibFormula
from morphing_wing.analytic_spar import SparFormula
from morphing_wing.arc_line import arc_line
from morphing_wing.forms.gravity import mass_density
from morphing_wing.geometry.rib import RibGeometry
from morphing_wing.geometry.spar import SparGeometry

from .case import Case

__all__ = ["formula_outputs"]

Values = Mapping[str, np.ndarray]
Ways = dict[str, Callable[[], Any]]
"""Of each output, what computes it."""

_LISTED = "elastomer.coefficients."
_LOADS = {"spar": "upper", "rib": "torque"}
_OF_RESIN = {"resin.E": "E", "resin.nu": "nu"}
_KNOWN = {
    "spar": {f.name for f in dataclasses.fields(SparGeometry)[:8]}
    | {f"C{i}0" for i in range(1, 10)},
    "rib": {f.name for f in dataclasses.fields(RibGeometry)[:6]} | {"E", "nu"},
}


def formula_outputs(
    case: Case, values: Values, names: Sequence[str] | None = None
) -> dict[str, np.ndarray]:
    """Return what the formula tells of a case's changes, by the outputs' names.

    Parameters
    ----------
    case
        A spar under pressure in its upper chambers, or a rib under a moment.
    values
        Of keys with dots, arrays of one shape in the package's units.
    names
        Outputs to compute, as far as the formula tells them; None: all.

    Returns
    -------
    dict
        Arrays of that shape, not a number where the formula has no equilibrium or the geometry is
        refused; empty where the formula cannot take the scene, a key or the load.
    """
    scene = case.scene
    load = _LOADS.get(scene)
    if load is None or set(case.file.loads) != {load}:
        return {}
    formulas = {key: _name(scene, key) for key in values}
    if not set(formulas.values()) <= _KNOWN[scene] | {load, "density"}:
        return {}
    shape = np.broadcast_shapes(*(np.shape(value) for value in values.values()))
    given = {formulas[key]: np.broadcast_to(np.asarray(value, dtype=float), shape)
             for key, value in values.items()}
    with np.errstate(invalid="ignore"):
        ways = (_spar if scene == "spar" else _rib)(case, given, shape)
        found = {name: way() for name, way in ways.items() if names is None or name in names}
    return {name: np.array(np.broadcast_to(value, shape)) for name, value in found.items()}


def _name(scene: str, key: str) -> str:
    """Return the formula's name of a key, or the key itself where it has none."""
    if scene == "spar" and key.startswith(_LISTED):
        return f"C{int(key.removeprefix(_LISTED)) + 1}0"
    if scene == "rib" and key in _OF_RESIN:
        return _OF_RESIN[key]
    if key in ("elastomer.density", "resin.density"):
        return "density"
    group, _, name = key.partition(".")
    return name if group in ("geometry", "loads") else key


def _spar(case: Case, given: dict[str, Any], shape: tuple[int, ...]) -> Ways:
    file = case.file
    geometry, material = file.geometry, file.materials["material"]
    if geometry.wall_lengths is not None or file.loads["upper"][-1] < 0.0:
        return {}
    pressure = given.pop("upper", np.full(shape, file.loads["upper"][-1]))
    density = given.pop("density", material.density)
    g = _Lengths(geometry, given)
    fine = _positive(*(g[field.name] for field in dataclasses.fields(SparGeometry)[:8]),
                     given.get("C10", 1.0))
    formula = SparFormula(geometry, material, **_kept(given, fine))
    turn = np.where(fine, formula.turn(pressure), np.nan)
    angle = g["n_cells"] * turn
    length = g["n_cells"] * g["cavity_length"] + (g["n_cells"] + 1) * g["wall_length"]
    height = 2 * (g["top_thickness"] + g["cavity_height"]) + g["middle_thickness"]
    width = g["cavity_width"] + 2 * g["side_thickness"]
    chambers = 2 * g["n_cells"] * g["cavity_length"] * g["cavity_height"] * g["cavity_width"]
    ways: Ways = {
        "span_angle_deg": lambda: np.degrees(angle), "span_line_deg": lambda: arc_line(angle),
        "energy_Nmm": lambda: formula.energy(turn), "pressure_MPa": lambda: pressure,
        "external_work_Nmm": lambda: formula.energy(turn), "upper_MPa": lambda: pressure,
        "ballooning_margin": lambda: formula.stiffness_left(turn),
        "largest_stretch": lambda: formula.stretches(turn).max(axis=-1),
        "mass_g": lambda: 1000 * mass_density(density) * (length * height * width - chambers),
        "length_mm": lambda: length, "height_mm": lambda: height, "width_mm": lambda: width,
    }
    if not any(name[0] == "C" for name in given):  # the stability is of one law
        ways["material_stability"] = lambda: material.stability(
            stretches := formula.stretches(turn), np.ones_like(stretches)).min(axis=-1)
    return ways


def _rib(case: Case, given: dict[str, Any], shape: tuple[int, ...]) -> Ways:
    file = case.file
    geometry, material = file.geometry, file.materials["material"]
    if geometry.layers != 3 or geometry.bosses:
        return {}
    torque = given.pop("torque", np.full(shape, file.loads["torque"][-1]))
    density = given.pop("density", material.density)
    g = _Lengths(geometry, given)
    half = np.radians(g["crossing_angle"]) / 2
    bar, thickness, diameter = g["shaft_length"], g["shaft_thickness"], g["pivot_diameter"]
    pitch, height = bar * np.cos(half), bar * np.sin(half)
    flush = geometry.section == "flush"
    spacing = g["pivot_length"] + (0.0 if flush else thickness)
    fine = _positive(bar, thickness, diameter, g["pivot_length"], g["n_cells"], np.sin(2 * half))
    fine &= diameter < np.minimum(np.minimum(bar / 2, height), pitch)  # as `RibGeometry` has it
    fine &= spacing > thickness
    formula = RibFormula(geometry, material, **_kept(given, fine))
    degrees = np.where(fine, formula.angle(torque), np.nan)
    angle = np.radians(degrees)
    cells = g["n_cells"]
    bars = 3 * cells * bar * thickness * (diameter if flush else thickness)
    pivots = (4 * (cells - 1) + 2 * cells) * (spacing - thickness) * np.pi * diameter**2 / 4
    return {
        "chord_angle_deg": lambda: degrees, "chord_line_deg": lambda: arc_line(angle),
        "energy_Nmm": lambda: 0.5 * torque * angle, "torque_Nmm": lambda: torque,
        "external_work_Nmm": lambda: 0.5 * torque * angle,
        "mass_g": lambda: 1000 * mass_density(density) * (bars + pivots),
        "length_mm": lambda: cells * pitch, "height_mm": lambda: height,
        "depth_mm": lambda: 2 * spacing + thickness,
    }


class _Lengths(dict):
    """What is given, and the geometry's own value of what is not."""

    def __init__(self, geometry: SparGeometry | RibGeometry, given: Values) -> None:
        super().__init__(given)
        self._geometry = geometry

    def __missing__(self, name: str) -> Any:
        return getattr(self._geometry, name)


def _positive(*values: Any) -> np.ndarray:
    return np.logical_and.reduce(np.broadcast_arrays(*(np.asarray(v) > 0.0 for v in values)))


def _kept(given: Values, fine: np.ndarray) -> dict[str, np.ndarray]:
    """Return what is given, where it is not fine of some other place that is, or left out."""
    if not fine.any():
        return {}
    place = np.unravel_index(int(np.argmax(fine)), fine.shape)
    return {name: np.where(fine, value, np.broadcast_to(value, fine.shape)[place])
            for name, value in given.items()}

