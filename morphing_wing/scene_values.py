"""Values of a scene file: text with units, and loads as one value, a list or a range."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Annotated, Any

from pydantic import BeforeValidator, Field

from morphing_wing.errors import InputError, is_number, plain
from morphing_wing.units import KINDS, quantity

__all__ = [
    "Angle",
    "Density",
    "GlueStiffness",
    "Kind",
    "Length",
    "Modulus",
    "Multiple",
    "Point",
    "Pressure",
    "Tension",
    "Torque",
    "Toughness",
    "or_none",
    "quantity_at",
]

MAX_POINTS = 10_000


@dataclass(frozen=True)
class Kind:
    """What a value with a unit measures: a key of `morphing_wing.units.KINDS`."""

    name: str


def measured(kind: str) -> BeforeValidator:
    """Return a validator of text with a unit."""
    return BeforeValidator(lambda value: quantity(value, kind))


def quantity_at(where: str, value: Any, kind: str) -> float:
    """Return text with a unit as a number of the package's; ``where`` names it in errors.

    Raises
    ------
    InputError
        ``factors.geometry.top_thickness.low = 1: must be a length as text with its unit, ...``.
    """
    try:
        return quantity(value, kind)
    except ValueError as problem:
        raise InputError(f"{where} = {plain(value)}: {problem}") from None


def or_none(value: Any) -> Any:
    """Read parts that a scene can do without: the word "none" stands for None."""
    return None if value == "none" else value


def load(kind: str) -> BeforeValidator:
    """Return a validator of a load: one value, a list, or evenly spaced points, ends included."""

    def read(value: Any) -> tuple[float, ...]:
        if isinstance(value, dict):
            return evenly_spaced(value, kind)
        given = value if isinstance(value, list) else [value]
        if not given:
            raise ValueError(f"must hold at least one value such as {example(kind)}")
        return tuple(one_value(item, kind) for item in given)

    def read_and_check(value: Any) -> tuple[float, ...]:
        values = read(value)
        if kind == "force" and min(values) < 0.0:
            raise ValueError("must not be negative, a cable cannot push")
        return values

    return BeforeValidator(read_and_check)


def one_value(value: Any, kind: str) -> float:
    """Read text with a unit, or a plain number where a load is a multiple of something."""
    if kind != "multiple":
        return quantity(value, kind)
    if not is_number(value) or not math.isfinite(value):
        raise ValueError(f"must be a plain finite number, such as {example(kind)}")
    return float(value)


def example(kind: str) -> str:
    """Return a value of a load as one writes it in TOML."""
    return "1.0" if kind == "multiple" else f'"{KINDS[kind][1]}"'


def evenly_spaced(table: dict[str, Any], kind: str) -> tuple[float, ...]:
    """Read ``{ from = "0 kPa", to = "40 kPa", points = 9 }``; from zero where from is left out."""
    if not {"to", "points"} <= set(table) <= {"from", "to", "points"}:
        form = f"{{ from = ..., to = {example(kind)}, points = 5 }}"
        raise ValueError(f"must be written as {form}")
    points = table["points"]
    if type(points) is not int or not 2 <= points <= MAX_POINTS:
        raise ValueError(f"must have points as a whole number from 2 to {MAX_POINTS}")
    last = one_value(table["to"], kind)
    first = one_value(table["from"], kind) if "from" in table else 0.0
    inner = (first + (last - first) * i / (points - 1) for i in range(1, points - 1))
    return (first, *inner, last)


Length = Annotated[float, measured("length"), Kind("length")]
Angle = Annotated[float, measured("angle"), Kind("angle")]
GlueStiffness = Annotated[float, measured("stiffness per area"), Kind("stiffness per area")]
Toughness = Annotated[float, measured("energy per area"), Kind("energy per area")]
Modulus = Annotated[float, measured("pressure"), Kind("pressure")]
Density = Annotated[float, measured("density"), Kind("density")]
Point = Annotated[list[Length], Field(min_length=3, max_length=3)]
Pressure = Annotated[tuple[float, ...], load("pressure"), Kind("pressure")]
Torque = Annotated[tuple[float, ...], load("torque"), Kind("torque")]
Tension = Annotated[tuple[float, ...], load("force"), Kind("force")]
Multiple = Annotated[tuple[float, ...], load("multiple")]
