"""Text in columns as programs of testing machines write it: separator, decimal sign, header."""

from __future__ import annotations

import codecs
import csv
import pathlib
import re
from dataclasses import dataclass

from morphing_wing.errors import InputError

__all__ = ["DelimitedText", "number", "read_text"]

# Separator and decimal sign, the likelier first; None: any white space.
FORMS = ((";", "."), (";", ","), ("\t", "."), ("\t", ","), (",", "."), (None, "."), (None, ","))
SPOKEN = {";": "semicolons", "\t": "tabs", ",": "commas", None: "spaces"}
NUMBER = re.compile(r"[+-]?(?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d+)?|[+-]?(?:nan|inf(?:inity)?)", re.I)
MARKS = {codecs.BOM_UTF8: "utf-8-sig", codecs.BOM_UTF16_LE: "utf-16",
         codecs.BOM_UTF16_BE: "utf-16"}
TELLING = re.compile(r"stress|strain|stretch|sigma|epsilon|lambda|elongation|[σελ]", re.I)
MOST_BYTES = 200_000_000


@dataclass(frozen=True)
class DelimitedText:
    """A table of text cells under a header.

    Attributes
    ----------
    names
        Header of each column; empty where the file has none.
    units
        Cells of a line of units below it; empty where there is none.
    rows
        Cells of each line below, those without any text left out.
    lines
        Number of each of these lines in the file, from 1 on.
    before
        What stands above the header.
    decimal
        The decimal sign.
    separator
        The separator in words.
    """

    names: tuple[str, ...]
    units: tuple[str, ...]
    rows: tuple[tuple[str, ...], ...]
    lines: tuple[int, ...]
    before: str
    decimal: str
    separator: str


def read_text(file: pathlib.Path) -> DelimitedText:
    """Read a table; separator, decimal sign and header are found from what it holds.

    Raises
    ------
    InputError
        If it cannot be read, is no text, or has no two columns of numbers.
    """
    lines = _decoded(file).splitlines()
    numbered = [(i, line) for i, line in enumerate(lines, start=1) if line.strip(" \t;,")]
    if not numbered:
        raise InputError(f"{file}: is empty, must hold columns of strain and stress")
    separator, decimal = max(FORMS, key=lambda form: _fits(numbered, *form))
    cells = [(i, _split(line, separator)) for i, line in numbered]
    counts = [sum(number(cell, decimal) is not None for cell in row) for _, row in cells]
    if max(counts) < 2:
        raise InputError(f"{file}: must hold at least two columns of numbers, separated by ; or , "
                         "or tabs or spaces")
    head = _head(cells, counts, decimal)
    first = head + 1
    units: list[str] = []
    if 0 <= head and first + 1 < len(cells) and counts[first] == 0 and counts[first + 1] >= 2:
        units, first = cells[first][1], first + 1
    if head < 0:
        first = next(i for i, count in enumerate(counts) if count >= 2)
    return DelimitedText(
        tuple(cells[head][1]) if head >= 0 else (), tuple(units),
        tuple(tuple(row) for _, row in cells[first:]), tuple(i for i, _ in cells[first:]),
        "\n".join(line for _, line in numbered[:max(head, 0)]), decimal, SPOKEN[separator])


def number(cell: str, decimal: str) -> float | None:
    """Return what a cell says, NaN and infinite too; None where it is no number."""
    text = cell.strip().replace("\u2212", "-")
    if decimal == ",":
        text = "?" if "." in text else text.replace(",", ".")
    return float(text) if NUMBER.fullmatch(text) else None


def _decoded(file: pathlib.Path) -> str:
    try:
        with file.open("rb") as there:
            data = there.read(MOST_BYTES + 1)
    except (OSError, ValueError) as problem:
        why = getattr(problem, "strerror", None) or "no valid file name"
        raise InputError(f"{file}: cannot be read, {why.lower()}") from None
    if len(data) > MOST_BYTES:
        raise InputError(f"{file}: must have at most {MOST_BYTES // 1_000_000} MB")
    marked = next((name for mark, name in MARKS.items() if data.startswith(mark)), None)
    for encoding in (marked,) if marked else ("utf-8", "cp1252"):  # Windows writes the latter
        try:
            text = data.decode(encoding)
        except UnicodeDecodeError:
            continue
        if "\0" not in text:
            return text
    raise InputError(f"{file}: must be a text file, in UTF-8 or as Windows writes it")


def _split(line: str, separator: str | None) -> list[str]:
    if separator is None:
        return line.split()
    try:
        [row] = csv.reader([line], delimiter=separator)
    except (csv.Error, ValueError):
        row = line.split(separator)
    return [cell.strip() for cell in row]


def _fits(numbered: list[tuple[int, str]], separator: str | None, decimal: str) -> tuple:
    """Return how well a form reads the lines: rows with two numbers, share of numbers in them."""
    rows = numbers = others = 0
    for _, line in numbered[:5000]:
        found = [number(cell, decimal) is not None for cell in _split(line, separator) if cell]
        if sum(found) >= 2:
            rows, numbers = rows + 1, numbers + sum(found)
            others += len(found) - sum(found)
    return rows, numbers / max(numbers + others, 1)


def _head(cells: list[tuple[int, list[str]]], counts: list[int], decimal: str) -> int:
    """Return which row names the columns, -1 for none: text above the longest run of numbers."""
    best, score = -1, (False, 0)
    for i, (_, row) in enumerate(cells):
        if counts[i] or sum(bool(cell) for cell in row) < 2:
            continue
        run, at = 0, i + 1
        if at + 1 < len(cells) and counts[at] == 0:  # a line of units
            at += 1
        while at + run < len(cells) and counts[at + run] >= 2:
            run += 1
        found = any(map(TELLING.search, row)), run
        if run and found > score:
            best, score = i, found
    return best

