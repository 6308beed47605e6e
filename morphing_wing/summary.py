"""What ``summary.json`` holds: the figures of a path as other programs read them."""

from __future__ import annotations

import math
import platform
from importlib import metadata
from typing import TYPE_CHECKING, Any

import numpy as np

from . import blas
from .passed import passed

if TYPE_CHECKING:
    from morphing_wing.path import Path

__all__ = ["summary", "versions"]

LOADS = ("pressure_MPa", "torque_Nmm", "cable_N")
ANGLES = ("span_angle_deg", "chord_angle_deg")


def summary(path: Path) -> dict[str, Any]:
    """Return arrays over the converged steps, and scalars, as strict JSON takes them.

    ``pressure_MPa``, ``torque_Nmm``, ``cable_N``, ``span_angle_deg``, ``chord_angle_deg``,
    ``newton_iterations`` and ``energy_Nmm`` are always there, with one entry a step: 0.0 where the
    scene has no such load, None where it has no such angle. The other columns of the table stand
    beside them. ``contact_from`` is the index of the first step whose skin passes through itself or
    a rib for want of contact forces, ``touching_from`` of the first step in which something presses
    on something; None if there is none. ``passed`` says which limits of the materials were passed
    and from which load on, where they were measured. ``error_estimate`` is the relative error of
    the angle that was measured of this fidelity, None where nothing like the scene was.
    """
    table = path.table().drop(columns=["step_seconds"], errors="ignore")
    steps = len(path)
    arrays: dict[str, list] = {load: [0.0] * steps for load in LOADS}
    arrays |= {angle: [None] * steps for angle in ANGLES}
    arrays |= {"newton_iterations": [], "energy_Nmm": []}
    arrays |= {name: [plain(value) for value in table[name]] for name in table}
    touching = [i for i, state in enumerate(path) if state.measures.get("touching")]
    in_contact = [i for i, state in enumerate(path) if state.contact]
    return {
        "scene": path.scene.name,
        "fidelity": path.scene.fidelity,
        "error_estimate": getattr(path.scene, "error_estimate", None),
        "dofs": int(path.scene.dofs),
        "seconds": path.seconds,
        "converged": path.converged,
        "reason": path.reason,
        "steps": steps,
        "contact_from": in_contact[0] if in_contact else None,
        "touching_from": touching[0] if touching else None,
        "passed": passed(path),
        **arrays,
        "parameters": plain(path.scene.description()),
        "versions": versions(),
    }


def versions() -> dict[str, str]:
    """Return the versions of what decides the numbers."""
    found = {"python": platform.python_version()}
    for package in ("dolfinx", "petsc4py", "numpy"):
        module = __import__(package)
        found[package] = str(getattr(module, "__version__", "unknown"))
    try:
        found["morphing_wing"] = metadata.version("morphing-wing")
    except metadata.PackageNotFoundError:
        found["morphing_wing"] = "not installed"
    used = blas.describe()
    found["blas"] = " ".join(filter(None, (used["library"], used["version"], used["core"])))
    return found


def plain(value: Any) -> Any:
    """Return ``value`` in Python's own types, None for numbers that are not finite."""
    if isinstance(value, dict):
        return {str(key): plain(item) for key, item in value.items()}
    if isinstance(value, (list, tuple, np.ndarray)):
        return [plain(item) for item in value]
    if isinstance(value, np.generic):
        value = value.item()
    if isinstance(value, float) and not math.isfinite(value):
        return None
    return value if isinstance(value, (str, int, float, bool, type(None))) else str(value)
