"""A file of a test, read: which columns are strain and stress, of which kind, in which units."""

from __future__ import annotations

import pathlib
import re
from dataclasses import dataclass
from importlib import resources

import numpy as np

from morphing_wing.errors import InputError, require
from morphing_wing.units import quantity

from .deformation import MODES
from .delimited_text import DelimitedText, number, read_text
from .material_test import MaterialTest

__all__ = ["BUILT_IN", "STRAIN_KINDS", "STRESS_KINDS", "read_test"]

STRAIN_KINDS = ("nominal", "true", "stretch")
STRESS_KINDS = ("nominal", "true")

BUILT_IN = {"dragon_skin_30": "dragon_skin_30_tensile.csv"}
"""Tests that come with the package, see ``data/README.md``: read where there is no such file."""

UNBELIEVABLE = 30.0
"""Nominal strain beyond which a column without a unit is taken to be in something else than 1."""

_OTHERS = re.compile(r"rate|transvers|lateral|width|thickness|shear|modulus|energy", re.I)
_TRUE = re.compile(r"true|cauchy|hencky|(?<![a-z])log", re.I)
_NOMINAL = re.compile(r"nominal|(?<![a-z])eng|piola|(?<![a-z])pk1", re.I)
_STRETCH = re.compile(r"stretch|lambda|λ|extension ratio", re.I)
_STRAIN = re.compile(r"strain|epsilon|ε|elongation", re.I)
_STRESS = re.compile(r"stress|sigma|σ", re.I)
_UNIT = re.compile(r"[(\[]\s*([^()\[\]]*)\s*[)\]]|[/,_]\s*([^/,_()\[\]\s]+(?:/\S+)?)\s*$|"
                   r"\bin ([^()\[\]\s]+)\s*$")
_PARTS = {"%": 0.01, "percent": 0.01, "-": 1.0, "1": 1.0, "mm/mm": 1.0, "m/m": 1.0, "in/in": 1.0}
_MODES = {"equibiaxial": re.compile(r"bi-?axial|bulge|inflation", re.I),
          "planar": re.compile(r"planar|pure[\s_-]?shear", re.I),
          "uniaxial": re.compile(r"uni-?axial|tensile|tension|pull|compression", re.I)}


@dataclass(frozen=True)
class _Column:
    place: int
    name: str
    kind: str | None
    unit: str | None

    def __str__(self) -> str:
        return f"'{self.name}'" if self.name else f"column {self.place + 1}"


def read_test(
    file: str | pathlib.Path, mode: str | None = None, weight: float = 1.0,
    strain: str | None = None, stress: str | None = None,
    strain_kind: str | None = None, stress_kind: str | None = None,
    strain_unit: str | None = None, stress_unit: str | None = None,
) -> MaterialTest:
    """Read a test from a file with columns, such as testing machines write.

    Separator (semicolon, comma, tab, spaces), decimal sign and header are found; lines above the
    header are passed over. What is not given is looked for in the header: of nominal and true
    columns side by side the nominal ones are taken. True stress is divided by the stretch.

    Parameters
    ----------
    file
        Its name, or one of `BUILT_IN` where no such file exists.
    mode
        How it was stretched; None: as a word in the file's name or header says, else uniaxial.
    weight
        How much the test counts beside others.
    strain, stress
        Name of the column as in the header, with its unit or without, or its number from 1 on.
    strain_kind
        ``"nominal"`` (length over length at rest, minus 1), ``"true"`` (logarithmic) or
        ``"stretch"``.
    stress_kind
        ``"nominal"`` (force over the area at rest) or ``"true"`` (over the area as it is).
    strain_unit
        ``"%"`` or ``"1"``.
    stress_unit
        Such as ``"MPa"``, ``"N/mm^2"`` or ``"psi"``.

    Raises
    ------
    InputError
        In one sentence that names the file, and the column or line that is wrong.

    Examples
    --------
    >>> read_test("dragon_skin_30").largest
    8.09091
    """
    for name, kind, kinds in (("mode", mode, MODES), ("strain_kind", strain_kind, STRAIN_KINDS),
                              ("stress_kind", stress_kind, STRESS_KINDS)):
        require(kind is None or kind in kinds, name, kind, "", f"one of {', '.join(kinds)}")
    built_in = str(file) in BUILT_IN and not pathlib.Path(file).exists()
    place = (pathlib.Path(str(resources.files("morphing_wing"))) / "data" / BUILT_IN[str(file)]
             if built_in else pathlib.Path(file))
    text = read_text(place)
    try:
        strains = _column(text, strain, "strain", strain_kind, strain_unit)
        stresses = _column(text, stress, "stress", stress_kind, stress_unit)
        if strains.place == stresses.place:
            raise InputError(f"{stresses} is named for both strain and stress, must be one of them")
        lines, values = _numbers(text, strains, stresses)
        stretch, said = _stretch(strains, values[:, 0], lines)
        factor = _stress_factor(stresses)
    except InputError as problem:
        raise InputError(f"{file}: {problem}") from None
    nominal = factor * values[:, 1] / (stretch if stresses.kind == "true" else 1.0)
    found, assumed = _mode(mode, text, place)
    remarks = (f"{found}{assumed}, {stresses.kind or 'nominal'} stress {stresses} against {said}; "
               f"{len(lines)} points to stretch {stretch.max():.4g}",)
    name = str(file) if built_in else place.name
    return MaterialTest(stretch, nominal, found, weight, name, lines, remarks)


def _column(
    text: DelimitedText, named: str | None, what: str, kind: str | None, unit: str | None
) -> _Column:
    """Return the column that is named, or the one that the header calls strain or stress."""
    columns = [_described(i, name, text, what) for i, name in enumerate(text.names)]
    if named is not None:
        found = _named(columns, text, named, what)
    else:
        found = _guessed(columns, what, kind)
    return _Column(found.place, found.name, kind or found.kind, unit or found.unit)


def _described(place: int, name: str, text: DelimitedText, what: str) -> _Column:
    plain = name.replace("_", " ")
    kind = "true" if _TRUE.search(plain) else "nominal" if _NOMINAL.search(plain) else None
    if what == "strain" and _STRETCH.search(plain):
        kind = "stretch"
    below = text.units[place] if place < len(text.units) else ""
    units = [below.strip("()[] "), *(next(filter(None, match.groups()), "")
                                     for match in _UNIT.finditer(name))]
    known = [unit for unit in units if unit and _knows(unit, what)]
    return _Column(place, name, kind, known[0] if known else None)


def _named(columns: list[_Column], text: DelimitedText, named: str, what: str) -> _Column:
    wanted = " ".join(named.lower().split())
    for strip in (False, True):
        for column in columns:
            name = re.split(r"[(\[]", column.name)[0] if strip else column.name
            if wanted and " ".join(name.lower().split()) == wanted:
                return column
    width = max(map(len, text.rows))
    if wanted.isdigit() and 1 <= int(wanted) <= width:
        place = int(wanted) - 1
        return columns[place] if place < len(columns) else _Column(place, "", None, None)
    listed = ", ".join(f"'{column.name}'" for column in columns if column.name)
    raise InputError(f"{what} = {named!r}: must be one of {listed}" * bool(listed)
                     or f"{what} = {named!r}: must be a number from 1 to {width}, the file has no "
                        "header")


def _guessed(columns: list[_Column], what: str, kind: str | None) -> _Column:
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


def _numbers(
    text: DelimitedText, strains: _Column, stresses: _Column
) -> tuple[np.ndarray, np.ndarray]:
    """Return line numbers and both columns; rows after the end of both are left out."""
    picked = [[row[c.place] if c.place < len(row) else "" for c in (strains, stresses)]
              for row in text.rows]
    while picked and not any(picked[-1]):  # another column is longer
        picked.pop()
    values = np.empty((len(picked), 2))
    for i, row in enumerate(picked):
        for j, (cell, column) in enumerate(zip(row, (strains, stresses), strict=True)):
            value = number(cell, text.decimal)
            if value is None or not np.isfinite(value):
                said = f"{cell!r}" if cell else "empty"
                raise InputError(f"{column} is {said} in line {text.lines[i]}: must be a finite "
                                 f"number with decimal {text.decimal!r}")
            values[i, j] = value
    if len(picked) < 2:
        raise InputError(f"{len(picked)} row(s) of numbers under {strains} and {stresses}, must be "
                         "at least 2")
    return np.array(text.lines[: len(picked)]), values


def _stretch(
    column: _Column, values: np.ndarray, lines: np.ndarray
) -> tuple[np.ndarray, str]:
    """Return stretches, and in words what they were made from."""
    unit = (column.unit or "1").lower()
    if unit not in _PARTS:
        raise InputError(f"{column}: unit {column.unit!r} must be % or 1 (strain_unit, "
                         "--strain-unit)")
    kind = column.kind or "nominal"
    values = values * _PARTS[unit]
    largest = np.abs(values).max()
    if column.unit is None and largest > UNBELIEVABLE:
        raise InputError(f"{column} reaches {largest:.6g} without a unit, must be at most "
                         f"{UNBELIEVABLE:g} or have one, such as % (strain_unit, --strain-unit)")
    with np.errstate(over="ignore"):
        stretch = {"nominal": 1.0 + values, "stretch": values, "true": np.exp(values)}[kind]
    for i in np.flatnonzero(~((stretch > 0.0) & np.isfinite(stretch)))[:1]:
        raise InputError(f"{column} gives stretch {stretch[i]:.6g} in line {lines[i]}: must be "
                         "greater than 0 (a nominal strain greater than -1)")
    return stretch, f"{column}" if kind == "stretch" else f"{kind} strain {column}"


def _stress_factor(column: _Column) -> float:
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
        return unit.lower() in _PARTS
    try:
        return quantity(f"1 {_written(unit)}", "pressure") > 0.0
    except ValueError:
        return False


def _written(unit: str) -> str:
    """Return a unit as pint reads it: N/mm^2 for N/mm² and N/mm2."""
    return re.sub(r"(?<=[a-z])2$", "^2", unit.replace("²", "^2"))


def _mode(mode: str | None, text: DelimitedText, place: pathlib.Path) -> tuple[str, str]:
    """Return the mode, and in words whether that was found or taken for granted."""
    if mode is not None:
        return mode, ""
    for where in (place.stem, " ".join(text.names), text.before):
        for known, words in _MODES.items():
            if words.search(where.replace("_", " ")):
                return known, " (by a word in name or header)"
    return "uniaxial", " (taken for granted: mode is not given)"
