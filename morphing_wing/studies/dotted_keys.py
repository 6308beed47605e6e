"""Tables within tables, as TOML has them, as keys with dots."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any

from morphing_wing.scene_keys import Keys

__all__ = ["flat", "has_keys_of", "is_load_range"]


def is_load_range(table: Mapping[str, Any]) -> bool:
    """Whether a table is the value of a load, ``{ from = ..., to = ..., points = ... }``."""
    return bool({"from", "to", "points"} & set(table))


def has_keys_of(model: type[Keys]) -> Callable[[Mapping[str, Any]], bool]:
    """Return a test of whether a table is a model's, whole or not; an empty one is too."""
    return lambda table: not table or bool(set(table) & set(model.model_fields))


def flat(
    table: Mapping[str, Any], is_value: Callable[[Mapping[str, Any]], bool] = is_load_range,
    above: str = "",
) -> dict[str, Any]:
    """Return the values of nested tables by dotted keys.

    Parameters
    ----------
    table
        Tables within tables.
    is_value
        Which tables are values themselves.
    above
        What stands before every key.

    Examples
    --------
    >>> flat({"geometry": {"rib": {"n_cells": 3}}, "loads": {"upper": {"to": "1 kPa"}}})
    {'geometry.rib.n_cells': 3, 'loads.upper': {'to': '1 kPa'}}
    """
    found: dict[str, Any] = {}
    for name, value in table.items():
        key = f"{above}{name}"
        inside = isinstance(value, Mapping) and not is_value(value)
        found |= flat(value, is_value, f"{key}.") if inside else {key: value}
    return found
