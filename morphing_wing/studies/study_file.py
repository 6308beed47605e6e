"""Study files: TOML that says which scene is varied, by which factors, and what is wanted.

::

    scene = "spar-validation"       # a built-in scene, a scene file beside this one, or a [scene]
    outputs = ["span_angle_deg", "mass_g"]

    [base]                          # changes to the scene that all cases have
    fidelity = "draft"
    loads.upper = "20 kPa"

    [factors]                       # keys as in the scene's file
    geometry.top_thickness = { low = "1.0 mm", high = "1.4 mm" }
    geometry.wall_length = { within = 0.1 }                 # 10 % about the scene's value
    geometry.n_cells = { low = 4, high = 8 }                # whole numbers
    fidelity = { levels = ["instant", "draft"] }

    [design]
    kind = "latin_hypercube"
    points = 200
    seed = 1

What cannot be computed with is refused in one sentence that names file, key and value.
"""

from __future__ import annotations

import pathlib
from typing import Annotated, Any

from pydantic import Field

from morphing_wing.errors import InputError, is_number, plain, require
from morphing_wing.scene_dimensions import column_of, counts, kind_of, unit_of
from morphing_wing.scene_file import located, parse_table, read_table
from morphing_wing.scene_keys import Keys, Text, validated
from morphing_wing.scene_values import quantity_at

from .case import Case
from .case_outputs import OUTPUTS
from .designs import Design
from .dotted_keys import flat, has_keys_of
from .factors import Factor
from .study import Study

__all__ = ["parse_study", "read_study"]

DEFAULT_OUTPUTS = ("span_angle_deg", "chord_angle_deg", "energy_Nmm", "mass_g")


class DesignKeys(Keys):
    """``[design]``, as `morphing_wing.studies.designs.Design`."""

    kind: Text
    points: int | None = None
    levels: int | None = None
    array: Text | None = None
    seed: int = 0
    second_order: bool = False


class FactorKeys(Keys):
    """A factor: ``low`` and ``high``, or ``within`` a part of the scene's value, or ``levels``."""

    low: Any = None
    high: Any = None
    within: float | None = None
    levels: Annotated[list[Any] | None, Field(min_length=2)] = None


class StudyKeys(Keys):
    """A study file."""

    scene: Any
    outputs: Annotated[list[Text] | None, Field(min_length=1)] = None
    base: dict[str, Any] = {}
    factors: Annotated[dict[str, Any], Field(min_length=1)]
    design: DesignKeys


def read_study(file: str | pathlib.Path) -> Study:
    """Read and check a study file.

    Raises
    ------
    InputError
        ``lhs.toml: factors.geometry.top_thickness.low = '1 kPa': must be a length as text ...``.
    """
    file = pathlib.Path(file)
    return check_study(read_table(file), str(file), file.stem, file.parent)


def parse_study(text: str, name: str) -> Study:
    """Check a study given as TOML text; ``name`` stands for the file in error messages."""
    return check_study(parse_table(text, name), name, name, pathlib.Path())


def check_study(table: dict[str, Any], name: str, stem: str, folder: pathlib.Path) -> Study:
    """Check a study given as the table that its TOML holds; scene files are beside ``folder``."""
    with located(name):
        keys = validated(StudyKeys, table)
        case = Case.of(keys.scene, flat(keys.base), folder)
        scene = case.scene
        factors = [factor_of(case, key, given) for key, given
                   in flat(keys.factors, has_keys_of(FactorKeys)).items()]
        design = Design(**keys.design.given())
        default = [output for output in DEFAULT_OUTPUTS if output in OUTPUTS[scene]]
        study = Study(case, factors, design, keys.outputs or default, stem)
        study.inputs()  # refuses factors that do not go with the design
    return study


def factor_of(case: Case, key: str, given: Any) -> Factor:
    """Return a factor, its values in the package's units."""
    scene = case.scene
    with located("factors"):
        kind_of(scene, key)
    where = f"factors.{key}"
    if not isinstance(given, dict):
        raise InputError(f"{where} = {plain(given)}: must be a table, such as {{ low = ..., high = "
                         "... }, { within = 0.1 } or { levels = [..., ...] }")
    keys = validated(FactorKeys, given, where)
    names = dict(column=column_of(scene, key), unit=unit_of(scene, key))
    with located("factors"):
        if keys.within is not None:
            if len(keys.model_fields_set) > 1:
                raise InputError(f"{key}: must have within alone, or levels, or low and high")
            middle = case.value(key)
            require(0.0 < keys.within < 1.0, f"{key}.within", keys.within, "",
                    "between 0 and 1, a part of the scene's value")
            if not is_number(middle) or middle == 0:
                raise InputError(f"{key}.within = {plain(keys.within)}: must be left out, the "
                                 f"scene's value is {plain(middle)}")
            ends = sorted(middle * (1.0 + sign * keys.within) for sign in (-1, 1))
            if counts(scene, key):
                ends = [round(end) for end in ends]
            return Factor(key, *ends, whole=counts(scene, key), **names)
        if keys.levels is not None:
            levels = tuple(value_of(scene, key, f"{key}.levels", v) for v in keys.levels)
            extra = {name: value_of(scene, key, f"{key}.{name}", getattr(keys, name))
                     for name in ("low", "high") if getattr(keys, name) is not None}
            return Factor(key, levels=levels, **extra, **names)
        ends = {name: value_of(scene, key, f"{key}.{name}", getattr(keys, name))
                for name in ("low", "high") if getattr(keys, name) is not None}
        return Factor(key, **ends, whole=counts(scene, key), **names)


def value_of(scene: str, key: str, where: str, given: Any) -> Any:
    """Return a value in the package's unit."""
    kind = kind_of(scene, key)
    if kind is None:
        if not isinstance(given, (str, bool, int, float)):
            raise InputError(f"{where} = {plain(given)}: must be a number, a word, true or false")
        return given
    return quantity_at(where, given, kind)
