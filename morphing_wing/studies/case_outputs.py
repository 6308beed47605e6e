"""What can be asked of a case: columns of its path's table, its mass, and what tells of limits."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from morphing_wing.analytic_spar import SparFormula
from morphing_wing.errors import InputError
from morphing_wing.ladder import AUTO
from morphing_wing.mass import mass
from morphing_wing.scene_file import SceneFile

__all__ = ["OUTPUTS", "check_outputs", "found_outputs", "needs_limits", "outputs_of"]

OF_ALL = {
    "energy_Nmm": "stored energy",
    "external_work_Nmm": "work of the loads",
    "newton_iterations": "Newton iterations of the whole path",
    "negative_pivots": "surplus negative pivots of the tangent, 0: stable",
    "dofs": "unknowns",
    "mass_g": "mass of elastomer and resin",
}
OF_PRESSURE = {
    "pressure_MPa": "pressure of the upper chambers, or the lower where the upper stay empty",
    "upper_MPa": "pressure of the upper chambers",
    "lower_MPa": "pressure of the lower chambers",
    "ballooning_margin": "stiffness of the chambers against more air, over that at rest; 0: limit",
}
OF_RUBBER = {
    "largest_stretch": "largest principal stretch",
    "largest_stretch_x_mm": "where that is, x",
    "largest_stretch_y_mm": "where that is, y",
    "largest_stretch_z_mm": "where that is, z",
    "material_stability": "least stability of the rubber's law, 0: it gives way",
}
OF_RESIN = {
    "rib_stress_MPa": "largest von Mises stress in the resin",
    "shaft_gap_mm": "gap between neighbouring shafts of a rib",
}
OF_SPAN = {
    "span_angle_deg": "phi_1, rotation of the tip face",
    "span_line_deg": "deflection line along the span",
}
OF_CHORD = {
    "chord_angle_deg": "phi_2, rotation of the trailing edge or of the rib's tail",
    "chord_line_deg": "deflection line along the chord",
}
OF_BOX = {
    "length_mm": "length from the root to the tip, or to the tail",
    "height_mm": "height over all, or between a rib's joints",
}
OF_CONTACT = {
    "gap_mm": "smallest gap in the pocket",
    "touching": "1 where something presses on something",
    "contact_force_N": "sum of the contact forces",
    "penetration_mm": "deepest penetration",
    "contact": "1 where, without contact forces, the skin passes through itself or a rib",
    "glue_damage": "largest damage of the glue",
    "glue_dissipated_Nmm": "energy that the glue dissipated",
}
OUTPUTS: dict[str, dict[str, str]] = {
    "spar": OF_SPAN | OF_PRESSURE | OF_RUBBER | OF_BOX | {"width_mm": "chordwise width over all"}
    | OF_ALL,
    "rib": OF_CHORD | {"torque_Nmm": "end moment", "cable_N": "cable's tension"} | OF_RESIN
    | OF_BOX | {"depth_mm": "depth of all layers along the span"} | OF_ALL,
    "wing": OF_SPAN | OF_CHORD | OF_PRESSURE
    | {"spar_twist_deg": "rotation of the spar's rear wall about z",
       "trailing_edge_deg": "rotation of the trailing edge in space",
       "cable_N": "tension of each cable", "gravity_g": "multiple of standard gravity"}
    | OF_RUBBER | OF_RESIN | OF_CONTACT | OF_ALL,
}
"""Of each scene, what can be asked, and what that is."""

_RIB_MODELS = {"reference": "cell"}
"""Of `morphing_wing.wing.FIDELITIES`, which loads DOLFINx, those whose ribs are chains of cells."""

_BOX = ("length", "height", "width", "depth")
_BY_LIMITS = {*OF_RUBBER, *OF_RESIN}
_BY_FORMULA = {"largest_stretch", "material_stability"}


def outputs_of(file: SceneFile) -> dict[str, str]:
    """Return what can be asked of a scene: of a wing, the angles of each rib too."""
    known = OUTPUTS[file.scene]
    if file.scene != "wing" or file.geometry.rib is None:
        return known
    each = {
        "rotation_deg": "rotation of a rib's tail",
        "line_deg": "rotation of the line from a rib's root to its tail",
        "foot_use": "how far the glue at a rib's foot is used, 1: damage begins",
        "bond_use": "how far the glue at a rib's tail is used",
    }
    ribs = range(1, len(file.geometry.rib_positions) + 1)
    return known | {f"rib_{i}_{name}": words for i in ribs for name, words in each.items()}


def check_outputs(file: SceneFile, outputs: Sequence[str]) -> None:
    """Refuse what the scene does not have, or its fidelity does not tell.

    Raises
    ------
    InputError
        ``output 'span_angle': must be one of span_angle_deg, ...``.
    """
    known = outputs_of(file)
    for name in outputs:
        if name not in known:
            raise InputError(f"output {name!r}: must be one of {', '.join(known)}")
        by_field = _BY_LIMITS - (_BY_FORMULA if file.scene == "spar" else set())
        if file.fidelity == "instant" and name in by_field:
            raise InputError(f"output {name!r}: must be left out where fidelity is 'instant', a "
                             "formula has no field of displacements")
        if name in OF_RESIN and (key := _cells_by(file)) is not None:
            raise InputError(f"output {name!r}: must be left out where {key}, of a chain of cells "
                             "the axis alone is known")


def _cells_by(file: SceneFile) -> str | None:
    """Return what says that ribs are chains of condensed cells; None: they are not."""
    given = file.materials.get("rib_model")
    if file.scene == "rib" and file.fidelity == "cell":
        return "fidelity is 'cell'"
    if file.scene == "wing" and (given or _RIB_MODELS.get(file.fidelity)) == "cell":
        return "rib_model is 'cell'" if given else f"fidelity is {file.fidelity!r}"
    return None


def needs_limits(file: SceneFile, outputs: Sequence[str]) -> bool:
    """Whether the scene must tell of its limits, which takes time, for some outputs."""
    return file.fidelity == AUTO or bool(_BY_LIMITS & set(outputs))


def found_outputs(file: SceneFile, scene: Any, path: Any, outputs: Sequence[str]) -> dict[str, Any]:
    """Return outputs of a path that reached its last load.

    Raises
    ------
    InputError
        If the scene as it is made does not measure one of them.
    """
    last = path.table().iloc[-1].to_dict()
    last["newton_iterations"] = sum(state.newton_iterations for state in path)
    if scene.fidelity == "instant" and file.scene == "spar":
        last |= _told_by_formula(file, last["pressure_MPa"])
    elif "ballooning_margin" in outputs:
        rows = [name for name in ("upper_MPa", "lower_MPa") if name in scene.loads]
        last["ballooning_margin"] = scene.stiffness_left(rows) if rows else float("nan")
    last["dofs"] = int(scene.dofs)
    if "mass_g" in outputs:
        last["mass_g"] = mass(file)
    if file.scene != "wing":
        last |= {name: getattr(file.geometry, name[:-3])
                 for name in outputs if name in OUTPUTS[file.scene] and name[:-3] in _BOX}
    for name in outputs:
        if name not in last:
            raise InputError(f"output {name!r}: is not measured of this {file.scene}, fidelity "
                             f"{scene.fidelity!r}: must be one of {', '.join(last)}")
    return {name: _plain(last[name]) for name in outputs}


def _told_by_formula(file: SceneFile, pressure: float) -> dict[str, float]:
    material = file.materials["material"]
    formula = SparFormula(file.geometry, material)
    turn = formula.turn(pressure)
    stretches = formula.stretches(turn)
    return {
        "ballooning_margin": formula.stiffness_left(turn),
        "largest_stretch": float(stretches.max()),
        "material_stability": float(material.stability(stretches, np.ones(4)).min()),
    }


def _plain(value: Any) -> Any:
    if isinstance(value, (bool, np.bool_)):
        return int(value)
    return value.item() if isinstance(value, np.generic) else value
