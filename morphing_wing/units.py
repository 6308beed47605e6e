"""Quantities as text with their unit: ``"25 kPa"`` becomes 0.025 in the package's MPa.

The package computes in mm, N and MPa, with angles in degrees; text is turned into these here, by
pint, and nowhere else.
"""

from __future__ import annotations

import math
import re
from functools import cache, lru_cache
from typing import Any

import pint

__all__ = ["KINDS", "quantity"]

KINDS = {
    "length": ("mm", "1.2 mm"),
    "pressure": ("MPa", "25 kPa"),
    "force": ("N", "0.2 N"),
    "torque": ("N mm", "5 N mm"),
    "angle": ("deg", "70 deg"),
    "stiffness per area": ("N/mm^3", "50 N/mm^3"),
    "energy per area": ("N/mm", "0.5 N/mm"),
    "density": ("kg/m^3", "1080 kg/m^3"),
    "energy": ("N mm", "20 N mm"),
    "mass": ("g", "50 g"),
}
"""What can be measured: the unit that the package computes in, and an example of a text."""

ANGLES = ("degree", "radian", "milliradian", "turn", "arcminute")

NUMBER = r"[+-]?(?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d+)?|[+-]?(?:nan|inf)"
WORD = r"[A-Za-zµμ°]+(?:(?:\^|\*\*)-?\d)?"
QUANTITY = re.compile(rf"\s*({NUMBER})\s*({WORD}(?:(?:\s*[*/·]\s*|\s+){WORD})*)\s*")
"""One number, then units with one-digit powers: pint would also compute any other expression."""


def quantity(text: Any, kind: str) -> float:
    """Return the number, in the package's unit, that a text with a unit stands for.

    Parameters
    ----------
    text
        What the user wrote, e.g. ``"25 kPa"``.
    kind
        A key of `KINDS`.

    Raises
    ------
    ValueError
        Bare number, no number, unknown unit, wrong dimension, NaN or infinite; the message is the
        end of a sentence that begins with the value: ``must be a pressure with ...``.

    Examples
    --------
    >>> round(quantity("25 kPa", "pressure"), 12)
    0.025
    """
    unit, example = KINDS[kind]
    article = "an" if kind[0] in "aeiou" else "a"
    allowed = ValueError(f'must be {article} {kind} as text with its unit, such as "{example}"')
    match = QUANTITY.fullmatch(text) if isinstance(text, str) else None
    if match is None:
        raise allowed
    try:
        given = parsed(match[2])
        measured = registry().Quantity(float(match[1]), given).to(parsed(unit))
    except (pint.PintError, ValueError, TypeError, AttributeError, ArithmeticError):
        raise allowed from None
    # Degrees have no dimension, so that pint takes "70 percent" and "3 mm/m" for angles too.
    if kind == "angle" and str(given) not in ANGLES:
        raise allowed
    if not math.isfinite(measured.magnitude):
        raise ValueError(f"must be a finite {kind}")
    return float(measured.magnitude)


@lru_cache(maxsize=1000)
def parsed(units: str) -> pint.Unit:
    """Return the units of a text, each text parsed once."""
    return registry().parse_units(units)


@cache
def registry() -> pint.UnitRegistry:
    """Return pint's units, read once and only when a quantity is read (a tenth of a second)."""
    return pint.UnitRegistry()
