"""What the paper's formulas share: parameters that are numbers or arrays, checked by name."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from morphing_wing.blockwise import in_blocks
from morphing_wing.errors import InputError, require

__all__ = ["COUNT", "FINITE", "POSITIVE", "Allowed", "BroadcastFormula"]

Values = Mapping[str, np.ndarray]


class Allowed(NamedTuple):
    """Which values a parameter may have: a test of arrays, and its words."""

    test: Callable[[np.ndarray], np.ndarray]
    words: str


POSITIVE = Allowed(lambda v: (v > 0.0) & np.isfinite(v), "finite and greater than 0")
FINITE = Allowed(np.isfinite, "finite")
COUNT = Allowed(lambda v: (v >= 1) & (v == np.round(v)), "a whole number of at least 1")


class BroadcastFormula:
    """Parameters by name, and functions over all of them that broadcast.

    Parameters
    ----------
    values
        Of the parameters, each a number.
    changes
        Numbers or arrays that take the place of values.
    rules
        Of each parameter its unit and what is allowed.

    Raises
    ------
    InputError
        If a change has no value's name, or is not allowed.
    """

    def __init__(self, values: Mapping[str, float], changes: Mapping[str, ArrayLike],
                 rules: Mapping[str, tuple[str, Allowed]]) -> None:  # fmt: skip
        for name, given in changes.items():
            if name not in values:
                raise InputError(f"{name}: unknown parameter, must be one of {', '.join(values)}")
            value, (unit, allowed) = np.asarray(given), rules[name]
            if value.dtype.kind not in "iuf":
                require(False, name, str(value), "", "numbers")
            fine = allowed.test(value)
            if not fine.all():
                require(False, name, value[~fine].flat[0], unit, allowed.words)
        self._values = {name: np.asarray(value, dtype=float)
                        for name, value in {**values, **changes}.items()}

    def _over(
        self, function: Callable[..., tuple[np.ndarray, ...]], *loads: ArrayLike
    ) -> tuple[Any, ...]:
        """Return what a function of values and loads gives, in their common shape."""
        names = list(self._values)

        def over_block(*arrays: np.ndarray) -> tuple[np.ndarray, ...]:
            return function(dict(zip(names, arrays, strict=False)), *arrays[len(names):])

        found = in_blocks(over_block, *self._values.values(),
                          *(np.asarray(load, dtype=float) for load in loads))
        return tuple(part[()] for part in found)  # numbers in place of arrays without a dimension
