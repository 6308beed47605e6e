"""A file of a test, read: stretch and nominal stress from its columns of strain and stress."""

from __future__ import annotations

import pathlib
import re
from importlib import resources

import numpy as np

from morphing_wing.errors import InputError, require

from .columns import PARTS, Column, column_of, in_MPa
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

_MODES = {"equibiaxial": re.compile(r"bi-?axial|bulge|inflation", re.I),
          "planar": re.compile(r"planar|pure[\s_-]?shear", re.I),
          "uniaxial": re.compile(r"uni-?axial|tensile|tension|pull|compression", re.I)}


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
        strains = column_of(text, strain, "strain", strain_kind, strain_unit)
        stresses = column_of(text, stress, "stress", stress_kind, stress_unit)
        if strains.place == stresses.place:
            raise InputError(f"{stresses} is named for both strain and stress, must be one of them")
        lines, values = _numbers(text, strains, stresses)
        stretch, said = _stretch(strains, values[:, 0], lines)
        factor = in_MPa(stresses)
    except InputError as problem:
        raise InputError(f"{file}: {problem}") from None
    nominal = factor * values[:, 1] / (stretch if stresses.kind == "true" else 1.0)
    found, assumed = _mode(mode, text, place)
    remarks = (f"{found}{assumed}, {stresses.kind or 'nominal'} stress {stresses} against {said}; "
               f"{len(lines)} points to stretch {stretch.max():.4g}",)
    name = str(file) if built_in else place.name
    return MaterialTest(stretch, nominal, found, weight, name, lines, remarks)


def _numbers(
    text: DelimitedText, strains: Column, stresses: Column
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
    column: Column, values: np.ndarray, lines: np.ndarray
) -> tuple[np.ndarray, str]:
    """Return stretches, and in words what they were made from."""
    unit = (column.unit or "1").lower()
    if unit not in PARTS:
        raise InputError(f"{column}: unit {column.unit!r} must be % or 1 (strain_unit, "
                         "--strain-unit)")
    kind = column.kind or "nominal"
    values = values * PARTS[unit]
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


def _mode(mode: str | None, text: DelimitedText, place: pathlib.Path) -> tuple[str, str]:
    """Return the mode, and in words whether that was found or taken for granted."""
    if mode is not None:
        return mode, ""
    for where in (place.stem, " ".join(text.names), text.before):
        for known, words in _MODES.items():
            if words.search(where.replace("_", " ")):
                return known, " (by a word in name or header)"
    return "uniaxial", " (taken for granted: mode is not given)"
