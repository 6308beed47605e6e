"""Which dimension each key of a scene file has, and how a bare number becomes its value.

A key is written as in the file, with dots: ``geometry.top_thickness``, ``loads.upper``,
``elastomer.coefficients.0``.
"""

from __future__ import annotations

import numbers
from collections.abc import Iterator
from typing import Any, get_args

from morphing_wing.errors import InputError
from morphing_wing.scene_keys import SCENES, Keys, one_of
from morphing_wing.scene_values import Kind
from morphing_wing.units import KINDS

__all__ = ["as_value", "column_of", "counts", "kind_of", "unit_of"]

_SUFFIXES = {"length": "mm", "pressure": "MPa", "force": "N", "torque": "Nmm", "angle": "deg",
             "stiffness per area": "N_mm3", "energy per area": "N_mm", "density": "kg_m3"}


def kind_of(scene: str, key: str) -> str | None:
    """Return what the value of a key measures, see `morphing_wing.units.KINDS`; None: no unit.

    Parameters
    ----------
    scene
        "spar", "rib" or "wing".
    key
        With dots, as in a scene file; a number names an entry of a list, the first is 0.

    Raises
    ------
    InputError
        ``geometry.top_thicknes: unknown key, must be one of preset, cavity_length, ...``.

    Examples
    --------
    >>> kind_of("spar", "geometry.top_thickness"), kind_of("spar", "geometry.n_cells")
    ('length', None)
    """
    return next((part.name for part in _parts(scene, key) if isinstance(part, Kind)), None)


def unit_of(scene: str, key: str) -> str:
    """Return the unit in which the package computes a key's value; "" for none."""
    kind = kind_of(scene, key)
    return "" if kind is None else KINDS[kind][0]


def counts(scene: str, key: str) -> bool:
    """Whether a key's value is a whole number."""
    return int in _parts(scene, key)


def column_of(scene: str, key: str) -> str:
    """Return the name that a key has as the column of a table, with its unit.

    Examples
    --------
    >>> column_of("wing", "geometry.rib.shaft_length"), column_of("spar", "loads.upper")
    ('rib_shaft_length_mm', 'upper_MPa')
    """
    kind = kind_of(scene, key)
    words = key.removeprefix("geometry.").removeprefix("loads.").replace(".", "_")
    if key == "loads.gravity":
        return "gravity_g"
    return words if kind is None else f"{words}_{_SUFFIXES[kind]}"


def as_value(scene: str, key: str, value: Any) -> Any:
    """Return a value as a scene file has it: a bare number gets the key's own unit.

    Whole numbers given as floats become whole where the key counts something. Texts, True and False
    remain as they are; of lists each entry is written so.
    """
    if isinstance(value, (list, tuple)):
        return [as_value(scene, key, item) for item in value]
    if isinstance(value, bool) or not isinstance(value, numbers.Real):
        return value
    unit, number = unit_of(scene, key), float(value)
    if unit:
        return f"{number!r} {unit}"
    return int(number) if counts(scene, key) and number.is_integer() else number


def _parts(scene: str, key: str) -> list[Any]:
    """Return all types and marks in the annotation of a key."""
    model: type[Keys] = SCENES[scene]
    names = key.split(".")
    for place, name in enumerate(names):
        field = model.model_fields.get(name)
        if field is None:
            raise InputError(f"{key}: unknown key, must be {one_of(model.model_fields)}"
                             + (f" of {'.'.join(names[:place])}" if place else ""))
        parts = [part for seed in (field.annotation, *field.metadata) for part in _flat(seed)]
        inner = next((p for p in parts if isinstance(p, type) and issubclass(p, Keys)), None)
        rest = names[place + 1 :]
        if inner is None:
            if len(rest) > 1 or any(not part.isdecimal() for part in rest) or (
                    rest and not any(getattr(part, "__origin__", None) is list for part in parts)):
                raise InputError(f"{key}: unknown key, {'.'.join(names[: place + 1])} has no such "
                                 "part")
            return parts
        model = inner
    raise InputError(f"{key}: is a table, must be one of its keys: {', '.join(model.model_fields)}")


def _flat(annotation: Any) -> Iterator[Any]:
    yield annotation
    for part in get_args(annotation):
        yield from _flat(part)
