"""Wanted loads as the user gives them, turned into the points that a path leads through."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np

from .errors import InputError, require

UNITS = {"MPa": "MPa", "mm3": "mm^3", "N": "N", "Nmm": "N mm", "g": "g", "part": ""}
"""End of a load's name -> its unit as one writes it."""


def load_targets(
    names: Sequence[str], loads: Mapping[str, float | Sequence[float] | None]
) -> list[dict[str, float]]:
    """Return one dict of all loads for each wanted point.

    Parameters
    ----------
    names
        All loads of a scene, each with its unit: ``upper_MPa``, ``cable_N``, ``torque_Nmm``,
        ``gravity_g``.
    loads
        Of each load by name a number, a sequence of them, or None for none; broadcast together.

    Raises
    ------
    InputError
        If a load is no finite number or sequence of them, or lengths differ.
    """
    arrays = []
    for name in names:
        given = loads.get(name)
        word, unit = name.rsplit("_", 1)
        try:
            array = np.atleast_1d(np.asarray(0.0 if given is None else given, dtype=float))
        except (TypeError, ValueError):
            raise InputError(
                f"{word} = {given!r}: must be a number or a sequence of numbers in {UNITS[unit]}"
            ) from None
        ok = array.ndim == 1 and array.size > 0 and bool(np.isfinite(array).all())
        require(ok, word, given, UNITS[unit], "finite, a number or a sequence of numbers")
        arrays.append(array)
    try:
        table = np.broadcast_arrays(*arrays)
    except ValueError:
        sizes = ", ".join(f"{n.rsplit('_', 1)[0]} {len(a)}"
                          for n, a in zip(names, arrays, strict=True))
        raise InputError(f"loads have lengths {sizes}: must be equal, or 1") from None
    rows = np.stack(table, axis=1)
    return [dict(zip(names, map(float, row), strict=True)) for row in rows]


def load_words(load: Mapping[str, float]) -> str:
    """Return a load in words: ``upper = 0.02 MPa, lower = 0 MPa``."""
    named = ((*name.rsplit("_", 1), value) for name, value in load.items())
    return ", ".join(f"{word} = {value:.6g} {UNITS[unit]}".rstrip() for word, unit, value in named)
