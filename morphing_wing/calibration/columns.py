"""Which column of a table is strain or stress, of which kind, in which unit."""

from __future__ import annotations

import re
from dataclasses import dataclass

from morphing_wing.errors import InputError
from morphing_wing.units import quantity

from .delimited_text import DelimitedText

__all__ = ["PARTS", "Column", "column_of", "in_MPa"]

PARTS = {"%": 0.01, "percent": 0.01, "-": 1.0, "1": 1.0, "mm/mm": 1.0, "m/m": 1.0, "in/in": 1.0}
"""Units of strain, and how much they are."""

_OTHERS = re.compile(r"rate|transvers|lateral|width|thickness|(?<!pure[\s_-])shear|modulus|energy",
                     re.I)
_TRUE = re.compile(r"true|cauchy|hencky|(?<![a-z])log", re.I)
_NOMINAL = re.compile(r"nominal|(?<![a-z])eng|piola|(?<![a-z])pk1", re.I)
_STRETCH = re.compile(r"stretch|lambda|λ|extension ratio", re.I)
_STRAIN = re.compile(r"strain|epsilon|ε|elongation", re.I)
_STRESS = re.compile(r"stress|sigma|σ", re.I)
_UNIT = re.compile(r"[(\[]\s*([^()\[\]]*)\s*[)\]]|[/,_\s]\s*([^/,_()\[\]\s]+(?:/\S+)?)\s*$|"
                   r"(%)\s*$")


@dataclass(frozen=True)
class Column:
    """A column: where it stands, its header, and what is known of kind and unit."""

    place: int
    name: str
    kind: str | None
    unit: str | None

    def __str__(self) -> str:
        """Return its name in quotes, or its number from 1 on."""
        return f"'{self.name}'" if self.name else f"column {self.place + 1}"


def column_of(
    text: DelimitedText, named: str | None, what: str, kind: str | None, unit: str | None
) -> Column:
    """Return the column that is named, or the one that the header calls strain or stress."""
    columns = [_described(i, name, text, what) for i, name in enumerate(text.names)]
    if named is not None:
        found = _named(columns, text, named, what)
    else:
        found = _guessed(columns, what, kind)
    return Column(found.place, found.name, kind or found.kind, unit or found.unit)


def _described(place: int, name: str, text: DelimitedText, what: str) -> Column:
    plain = name.replace("_", " ")
    kind = "true" if _TRUE.search(plain) else "nominal" if _NOMINAL.search(plain) else None
    if what == "strain" and _STRETCH.search(plain):
        kind = "stretch"
    below = text.units[place] if place < len(text.units) else ""
    units = [below.strip("()[] "), *(next(filter(None, match.groups()), "")
                                     for match in _UNIT.finditer(name))]
    known = [unit for unit in units if unit and _knows(unit, what)]
    return Column(place, name, kind, known[0] if known else None)


def _named(columns: list[Column], text: DelimitedText, named: str, what: str) -> Column:
    wanted = " ".join(named.lower().split())
    for strip in (False, True):
        for column in columns:
            name = re.split(r"[(\[]", column.name)[0] if strip else column.name
            if wanted and " ".join(name.lower().split()) == wanted:
                return column
    width = max(map(len, text.rows))
    if wanted.isdecimal() and 1 <= int(wanted) <= width:
        place = int(wanted) - 1
        return columns[place] if place < len(columns) else Column(place, "", None, None)
    listed = ", ".join(f"'{column.name}'" for column in columns if column.name)
    raise InputError(f"{what} = {named!r}: must be one of {listed}, or a number from 1 to {width}"
                     * bool(listed)
                     or f"{what} = {named!r}: must be a number from 1 to {width}, the file has no "
                        "header")


def _guessed(columns: list[Column], what: str, kind: str | None) -> Column:
    """Return the one column that the header calls so; nominal ones before others."""
    words = (_STRESS,) if what == "stress" else (_STRETCH, _STRAIN)
    found = [column for column in columns
             if any(word.search(column.name) for word in words)
             and not _OTHERS.search(column.name)]
    if kind is not None:
        found = [column for column in found if column.kind in (kind, None)]
    for wanted in dict.fromkeys([kind, "nominal", "stretch", None, "true"]):
        same = [column for column in found if column.kind == wanted]
        if len(same) > 1:
            raise InputError(f"{' and '.join(map(str, same))} both claim to be "
                             f"{wanted or ''} {what}".replace("  ", " ")
                             + f", one must be named ({what}, --{what})")
        if same:
            return same[0]
    listed = ", ".join(f"'{column.name}'" for column in columns if column.name)
    there = f"none of {listed} says so" if listed else "the file has no header"
    raise InputError(f"no column of {what}, {there}: must be named ({what}, --{what})")


def in_MPa(column: Column) -> float:
    """Return how many MPa the unit of a column of stress is."""
    if column.unit is None:
        raise InputError(f"{column} has no unit of stress, must have one in its name, such as "
                         "'Stress (MPa)', or be given one (stress_unit, --stress-unit)")
    try:
        return quantity(f"1 {_written(column.unit)}", "pressure")
    except ValueError:
        raise InputError(f"{column}: unit {column.unit!r} must be one of stress, such as MPa or "
                         "N/mm^2") from None


def _knows(unit: str, what: str) -> bool:
    if what == "strain":
        return unit.lower() in PARTS
    try:
        return quantity(f"1 {_written(unit)}", "pressure") > 0.0
    except ValueError:
        return False


def _written(unit: str) -> str:
    """Return a unit as pint reads it: N/mm^2 for N/mm² and N/mm2."""
    return re.sub(r"(?<=[a-z])2$", "^2", unit.replace("²", "^2"))
