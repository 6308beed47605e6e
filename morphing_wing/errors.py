"""Bad input, said in one sentence: parameter, value, unit, what is allowed."""

from __future__ import annotations

import math
import numbers
from typing import Any

import numpy as np

__all__ = ["InputError", "is_count", "is_number", "one_line", "require"]


class InputError(ValueError):
    """What the user gave cannot be computed with; the message is one clear sentence."""


def require(condition: bool, name: str, value: Any, unit: str, allowed: str) -> None:
    """Refuse a value that does not fulfil its condition.

    Numbers that are not finite are refused whatever the condition says, because every comparison
    with NaN is false and a condition written as a negation would let it pass.

    Parameters
    ----------
    condition
        What must hold.
    name
        The parameter as the user knows it, e.g. ``"top_thickness"``.
    value
        What the user gave.
    unit
        Its unit, ``""`` for none.
    allowed
        The end of the sentence "must be ...", e.g. ``"greater than 0 mm"``.

    Raises
    ------
    InputError
        ``top_thickness = -1 mm: must be greater than 0 mm``.

    Examples
    --------
    >>> require(-1.0 > 0, "top_thickness", -1.0, "mm", "greater than 0 mm")
    Traceback (most recent call last):
    morphing_wing.errors.InputError: top_thickness = -1 mm: must be greater than 0 mm
    """
    if condition and is_finite(value):
        return
    measured = f"{plain(value)} {unit}".rstrip()
    raise InputError(f"{name} = {measured}: must be {allowed}")


def is_number(value: object) -> bool:
    """Whether ``value`` is a real number; True and False are not meant as numbers here."""
    return isinstance(value, numbers.Real) and not isinstance(value, bool)


def is_count(value: object) -> bool:
    """Whether ``value`` is a whole number of at least 1."""
    return isinstance(value, numbers.Integral) and not isinstance(value, bool) and value >= 1


def is_finite(value: Any) -> bool:
    """Whether no number in ``value`` is NaN or infinite; what is not a number counts as finite."""
    if isinstance(value, np.ndarray):
        value = value.tolist()
    if isinstance(value, (list, tuple)):
        return all(is_finite(item) for item in value)
    try:
        return math.isfinite(value)
    except (TypeError, OverflowError):
        return True


def plain(value: Any) -> str:
    """Text of a value as a user would type it: ``-1``, not ``-1.0`` or ``np.float64(-1.0)``."""
    if isinstance(value, bool) or isinstance(value, str):
        return repr(value)
    try:
        return f"{float(value):.10g}"
    except (TypeError, ValueError, OverflowError):
        return str(value)


def one_line(said: object) -> str:
    """Return the text of an exception or warning without line breaks."""
    return " ".join(str(said).split())
