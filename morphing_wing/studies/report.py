"""A study told on a terminal: its analysis as tables, and what went wrong."""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import TYPE_CHECKING, Any

from morphing_wing.terminal_tables import text_table

if TYPE_CHECKING:
    from rich.table import Table

    from .result import StudyResult

__all__ = ["report"]

_TITLES = {
    "levels": "means of levels, range R", "variance": "analysis of variance",
    "effects": "one factor at a time",
    "correlations": "rank correlation and linear regression",
    "indices": "Sobol' indices, with half-widths of 95 % intervals",
}
# What a terminal has no room for; the files have it.
_LEFT_OUT = {"levels": ("sum_of_squares", "share"), "variance": ("mean_square",)}


def report(result: StudyResult) -> Iterator[Table | str]:
    """Yield the tables of each output, then sentences."""
    for output in result.study.outputs:
        for name in result.analyses:
            found = result.analysis_of(name, output)
            if not len(found):
                continue
            found = found.drop(columns=list(_LEFT_OUT.get(name, ())))
            rows = [[_text(value) for value in row] for row in found.itertuples(index=False)]
            yield text_table(f"{output}: {_TITLES[name]}",
                             [column.replace("_", " ") for column in found], rows)
    yield from result.sentences()


def _text(value: Any) -> str:
    if isinstance(value, float):
        return "" if math.isnan(value) else f"{value:.4g}"
    return str(value)
