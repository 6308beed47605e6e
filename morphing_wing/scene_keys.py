"""Which keys a scene file may have, and in which dimension each is given.

The keys of ``[geometry]`` are the field names of the geometry classes. All are optional here: what
the file leaves out comes from the preset, or from the class's own defaults.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import Annotated, Any, Literal, TypeVar

import pydantic
from pydantic import BeforeValidator, Field

from morphing_wing.errors import InputError, plain, require
from morphing_wing.scene_values import (
    Angle,
    Density,
    GlueStiffness,
    Length,
    Modulus,
    Multiple,
    Point,
    Pressure,
    Tension,
    Torque,
    Toughness,
    or_none,
)

__all__ = [
    "SCENES", "Keys", "RibKeys", "SparKeys", "Text", "WingKeys", "check_keys", "one_of",
    "validated",
]

Count = Annotated[int, Field(ge=1, le=1000)]
Text = Annotated[str, Field(min_length=1)]


class Keys(pydantic.BaseModel):
    """A table of a scene file: no key but its own, no number for a text, all numbers finite."""

    model_config = pydantic.ConfigDict(extra="forbid", strict=True, allow_inf_nan=False)

    def given(self) -> dict[str, Any]:
        """Return what the file gives, without what it leaves out; lists as tuples."""
        names = [name for name in type(self).model_fields if name in self.model_fields_set]
        values = {name: getattr(self, name) for name in names}
        return {n: tuple(v) if isinstance(v, list) else v for n, v in values.items()}


Model = TypeVar("Model", bound=Keys)


class SparKeys(Keys):
    """``[geometry]`` of a spar, as `morphing_wing.geometry.SparGeometry`."""

    preset: Literal["validation"] | None = None
    cavity_length: Length | None = None
    wall_length: Length | None = None
    top_thickness: Length | None = None
    cavity_height: Length | None = None
    middle_thickness: Length | None = None
    side_thickness: Length | None = None
    cavity_width: Length | None = None
    n_cells: Count | None = None
    wall_lengths: list[Length] | None = None


class RibKeys(Keys):
    """``[geometry]`` of a rib, as `morphing_wing.geometry.RibGeometry`."""

    preset: Literal["validation", "prototype"] | None = None
    shaft_length: Length | None = None
    shaft_thickness: Length | None = None
    pivot_diameter: Length | None = None
    pivot_length: Length | None = None
    crossing_angle: Angle | None = None
    n_cells: Count | None = None
    section: Literal["flush", "square"] | None = None
    bosses: bool | None = None
    layers: Count | None = None


class WingKeys(Keys):
    """``[geometry]`` of a wing, as `morphing_wing.geometry.WingGeometry`."""

    preset: Literal["prototype"] | None = None
    chord: Length | None = None
    aerofoil: Text | None = None
    spar_fraction: float | None = None
    n_cells: Count | None = None
    cavity_length: Length | None = None
    wall_length: Length | None = None
    top_thickness: Length | None = None
    middle_thickness: Length | None = None
    side_thickness: Length | None = None
    nose_length: Length | None = None
    skin_thickness: Annotated[Length | None, BeforeValidator(or_none)] = None
    skin_root: Literal["clamped", "free"] | None = None
    tip_wall: bool | None = None
    skin_over_spar: bool | None = None
    skin_slit: Literal["none", "lower", "trailing_edge"] | None = None
    skin_prestretch: Annotated[list[float], Field(min_length=2, max_length=2)] | None = None
    rib: Annotated[RibKeys | None, BeforeValidator(or_none)] = None
    rib_positions: Annotated[list[float], Field(min_length=1)] | None = None
    foot_height: Length | None = None
    foot_width: Length | None = None
    tail_bond_length: Length | None = None
    glue_stiffness: GlueStiffness | None = None
    cable_guide: Point | None = None


class ElastomerKeys(Keys):
    """``[elastomer]``: Yeoh's C10, C20, ..., the bulk modulus, the density."""

    coefficients: list[Modulus] | None = None
    bulk: Modulus | None = None
    density: Density | None = None


class ResinKeys(Keys):
    """``[resin]``: Young's modulus, Poisson's ratio, density."""

    E: Modulus | None = None
    nu: float | None = None
    density: Density | None = None


class AdhesiveKeys(Keys):
    """``[adhesive]``: glue that can fail; without this table it is elastic."""

    stiffness: GlueStiffness | None = None
    strength: Modulus | None = None
    shear_strength: Modulus | None = None
    toughness: Toughness | None = None


class PressureKeys(Keys):
    """``[loads]`` of a spar."""

    upper: Pressure | None = None
    lower: Pressure | None = None


class RibLoadKeys(Keys):
    """``[loads]`` of a rib: an end torque, or a cable and the point it runs to."""

    torque: Torque | None = None
    cable: Tension | None = None
    guide: Point | None = None


class WingLoadKeys(PressureKeys):
    """``[loads]`` of a wing: ``cable`` in each rib's, ``gravity`` in multiples of the standard."""

    cable: Tension | None = None
    gravity: Multiple | None = None


class SparFile(Keys):
    """A scene file of a spar."""

    scene: Literal["spar"]
    fidelity: Text | None = None
    tolerance: float | None = None
    geometry: SparKeys
    elastomer: ElastomerKeys = ElastomerKeys()
    loads: PressureKeys


class RibFile(Keys):
    """A scene file of a rib."""

    scene: Literal["rib"]
    fidelity: Text | None = None
    tolerance: float | None = None
    geometry: RibKeys
    resin: ResinKeys = ResinKeys()
    loads: RibLoadKeys


class WingFile(Keys):
    """A scene file of a wing."""

    scene: Literal["wing"]
    fidelity: Text | None = None
    tolerance: float | None = None
    contact: bool = True
    rib_model: Literal["frame", "cell", "solid"] | None = None
    geometry: WingKeys
    adhesive: AdhesiveKeys | None = None
    elastomer: ElastomerKeys = ElastomerKeys()
    resin: ResinKeys = ResinKeys()
    loads: WingLoadKeys


SCENES: dict[str, type[SparFile] | type[RibFile] | type[WingFile]] = {
    "spar": SparFile,
    "rib": RibFile,
    "wing": WingFile,
}


def check_keys(table: dict[str, Any]) -> SparFile | RibFile | WingFile:
    """Check keys and units of a whole file, by the model that its ``scene`` names.

    Raises
    ------
    InputError
        ``geometry.top_thicknes: unknown key, must be one of preset, cavity_length, ...``.
    """
    if "scene" not in table:
        raise InputError(f"scene: is missing, must be {one_of(SCENES)}")
    scene = table["scene"]
    require(isinstance(scene, str) and scene in SCENES, "scene", scene, "", one_of(SCENES))
    return validated(SCENES[scene], table)


def validated(model: type[Model], table: Mapping[str, Any], where: str = "") -> Model:
    """Return a table's keys, checked by a model.

    Raises
    ------
    InputError
        In one sentence on what is wrong first; ``where`` stands before the key.
    """
    try:
        return model.model_validate(table)
    except pydantic.ValidationError as problem:
        said = sentence(problem.errors()[0], model)
        raise InputError(f"{where}.{said}" if where else said) from None


def sentence(error: Any, model: type[Keys]) -> str:
    """Return one sentence for what pydantic found first."""
    where = ".".join(str(part) for part in error["loc"])
    if error["type"] == "missing":
        return f"{where}: is missing, must be given"
    if error["type"] == "extra_forbidden":
        for part in error["loc"][:-1]:
            model = table_inside(model.model_fields[part].annotation)
        return f"{where}: unknown key, must be {one_of(model.model_fields)}"
    if error["type"] == "value_error":
        said = str(error["ctx"]["error"])
    else:
        said = error["msg"].replace("Input should", "must").replace("List should", "must")
    return f"{where} = {plain(error['input'])}: {said}"


def table_inside(annotation: Any) -> type[Keys]:
    """Return the model in an annotation such as ``RibKeys | None``."""
    parts = getattr(annotation, "__args__", (annotation,))
    return next(p for p in parts if isinstance(p, type) and issubclass(p, Keys))


def one_of(words: Iterable[str]) -> str:
    """Return allowed words as the end of a sentence."""
    words = list(words)
    return words[0] if len(words) == 1 else f"one of {', '.join(words)}"
