"""Values of a scene file: text with units, and loads as one value, a list or a range."""

from __future__ import annotations

from typing import Annotated, Any

import pydantic
from pydantic import BeforeValidator, Field

from morphing_wing.units import KINDS, quantity

__all__ = [
    "Angle",
    "GlueStiffness",
    "Length",
    "Modulus",
    "Point",
    "Pressure",
    "Tension",
    "Torque",
    "or_none",
]

MAX_POINTS = 10_000


def measured(kind: str) -> BeforeValidator:
    """Return a validator of text with a unit."""
    return BeforeValidator(lambda value: quantity(value, kind))


def or_none(value: Any) -> Any:
    """Read parts that a scene can do without: the word "none" stands for None."""
    return None if value == "none" else value


def load(kind: str) -> BeforeValidator:
    """Return a validator of a load: one value, a list, or evenly spaced points, ends included."""
    example = KINDS[kind][1]

    def steps(value: Any) -> tuple[float, ...]:
        if isinstance(value, dict):
            return evenly_spaced(value)
        given = value if isinstance(value, list) else [value]
        if not given:
            raise ValueError(f'must hold at least one value such as "{example}"')
        return tuple(quantity(item, kind) for item in given)

    def evenly_spaced(table: dict[str, Any]) -> tuple[float, ...]:
        if not {"to", "points"} <= set(table) <= {"from", "to", "points"}:
            raise ValueError(f'must be written as {{ from = "...", to = "{example}", points = 5 }}')
        points = table["points"]
        if type(points) is not int or not 2 <= points <= MAX_POINTS:
            raise ValueError(f"must have points as a whole number from 2 to {MAX_POINTS}")
        last = quantity(table["to"], kind)
        first = quantity(table["from"], kind) if "from" in table else 0.0
        inner = (first + (last - first) * i / (points - 1) for i in range(1, points - 1))
        return (first, *inner, last)

    return BeforeValidator(steps)


def pulling(tensions: tuple[float, ...]) -> tuple[float, ...]:
    """Refuse tensions below zero: a cable cannot push."""
    if min(tensions) < 0.0:
        raise ValueError("must not be negative, a cable cannot push")
    return tensions


Length = Annotated[float, measured("length")]
Angle = Annotated[float, measured("angle")]
GlueStiffness = Annotated[float, measured("stiffness per area")]
Modulus = Annotated[float, measured("pressure")]
Point = Annotated[list[Length], Field(min_length=3, max_length=3)]
Pressure = Annotated[tuple[float, ...], load("pressure")]
Torque = Annotated[tuple[float, ...], load("torque")]
Tension = Annotated[tuple[float, ...], pydantic.AfterValidator(pulling), load("force")]
