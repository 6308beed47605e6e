"""Problem files: TOML that says what to optimise, every dimensional value as text with its unit.

A file names a scene, what to seek, which of the scene's keys may change between which bounds,
what must hold, and the rungs to compute on::

    scene = "spar-validation"
    maximize = "span_angle_deg"
    rungs = ["instant", "cell", "standard"]

    [base]
    loads.upper = "20 kPa"

    [variables]
    geometry.cavity_length = { low = "2.0 mm", high = "2.8 mm" }

    [constraints]
    mass_g = { max = "base" }
    largest_stretch = { max = 1.5 }
"""

from __future__ import annotations

import pathlib
from collections.abc import Mapping
from typing import Annotated, Any

from pydantic import Field

from morphing_wing.built_in import built_in_problems
from morphing_wing.errors import InputError, is_number, plain
from morphing_wing.scene_dimensions import kind_of
from morphing_wing.scene_file import located, parse_table, read_table
from morphing_wing.scene_keys import Keys, Text, one_of, validated
from morphing_wing.scene_values import quantity_at
from morphing_wing.studies.case import Case
from morphing_wing.studies.dotted_keys import flat, has_keys_of

from .problem import Constraint, Goal, Problem, Variable

__all__ = ["parse_problem", "read_problem"]

GOALS = ("maximize", "minimize", "match")
BASE = "base"
"""In place of a limit: what the design to start from has."""

SUFFIXES = {"_Nmm": "energy", "_MPa": "pressure", "_deg": "angle", "_mm": "length", "_N": "force",
            "_g": "mass"}


class ProblemKeys(Keys):
    """A problem file."""

    scene: Any
    rungs: Annotated[list[Text], Field(min_length=1)] | None = None
    maximize: Text | None = None
    minimize: Text | None = None
    match: Text | None = None
    target: Any = None
    evaluations: Annotated[int, Field(ge=5, le=10_000)] | None = None
    tolerance: Annotated[float, Field(ge=1e-6, le=0.1)] | None = None
    own_slopes: bool | None = None
    base: dict[str, Any] = {}
    variables: dict[str, Any]
    constraints: dict[str, Any] = {}


class RangeKeys(Keys):
    """Bounds of a variable."""

    low: Any
    high: Any


class LimitKeys(Keys):
    """Limits of a constraint."""

    min: Any = None
    max: Any = None


def read_problem(problem: str | pathlib.Path) -> Problem:
    """Read and check a built-in problem, by its name, or a problem file.

    Raises
    ------
    InputError
        ``mine.toml: variables.geometry.top_thickness.from = '1 kPa': must be a length ...``.
    """
    built_in = built_in_problems()
    if str(problem) in built_in:
        return parse_problem(parse_table(built_in[str(problem)], str(problem)), str(problem))
    if pathlib.Path(problem).suffix != ".toml":
        raise InputError(f"problem = {str(problem)!r}: must be a problem file, NAME.toml, or "
                         f"{one_of(built_in)}")
    return parse_problem(read_table(problem), str(problem), pathlib.Path(problem).parent)


def parse_problem(
    table: Mapping[str, Any], name: str = "problem", folder: str | pathlib.Path = "."
) -> Problem:
    """Check a problem given as its TOML's table.

    Parameters
    ----------
    table
        Keys as in problem files.
    name
        Stands for the file in error messages.
    folder
        Where the scene's file is looked for.
    """
    with located(name):
        keys = validated(ProblemKeys, table)
        case = Case.of(keys.scene, flat(keys.base), folder)
        with located(BASE):
            scene = case.scene
        given = {"rungs": tuple(keys.rungs) if keys.rungs else None,
                 "evaluations": keys.evaluations, "tolerance": keys.tolerance,
                 "own_slopes": keys.own_slopes}
        return Problem(
            case, _goal(keys),
            tuple(_variable(scene, key, value) for key, value
                  in flat(keys.variables, has_keys_of(RangeKeys)).items()),
            tuple(c for output, value in keys.constraints.items() for c in _limits(output, value)),
            **{key: value for key, value in given.items() if value is not None})


def _goal(keys: ProblemKeys) -> Goal:
    given = [kind for kind in GOALS if getattr(keys, kind) is not None]
    if len(given) != 1:
        raise InputError(f"{' and '.join(given) or 'goal'}: must be one of {', '.join(GOALS)}")
    kind, output = given[0], getattr(keys, given[0])
    if (kind == "match") != (keys.target is not None):
        raise InputError("target: must be given where the goal is to match, and only there")
    target = None if kind != "match" else _measured(output, keys.target, "target")
    return Goal(kind, output, target)


def _variable(scene: str, key: str, value: Any) -> Variable:
    where = f"variables.{key}"
    with located("variables"):
        kind = kind_of(scene, key)
    if not isinstance(value, Mapping):
        example = "1.0" if kind is None else '"1.0 mm"'
        raise InputError(f"{where} = {plain(value)}: must be written as "
                         f"{{ low = {example}, high = ... }}")
    bounds = validated(RangeKeys, value, where)
    return Variable(key, *(_number(bound, kind, f"{where}.{end}") for end, bound
                           in (("low", bounds.low), ("high", bounds.high))))


def _limits(output: str, value: Any) -> list[Constraint]:
    where = f"constraints.{output}"
    if not isinstance(value, Mapping):
        raise InputError(f"{where} = {plain(value)}: must be written as {{ max = ... }}, "
                         "{ min = ... } or with both")
    given = validated(LimitKeys, value, where).given()
    if not given:
        raise InputError(f"{where}: is empty, must have min, max or both")
    return [Constraint(output, side, None if limit == BASE
                       else _measured(output, limit, f"{where}.{side}"))
            for side, limit in given.items()]


def _measured(output: str, value: Any, where: str) -> float:
    """Return a value of an output, whose unit its name ends with."""
    kind = next((kind for end, kind in SUFFIXES.items() if output.endswith(end)), None)
    return _number(value, None if output == "gravity_g" else kind, where)


def _number(value: Any, kind: str | None, where: str) -> float:
    if kind is None:
        if not is_number(value) or value != value or abs(value) == float("inf"):
            raise InputError(f"{where} = {plain(value)}: must be a plain finite number")
        return float(value)
    return quantity_at(where, value, kind)
