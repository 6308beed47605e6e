"""A calibration as tables and sentences for a terminal."""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import TYPE_CHECKING

import pandas as pd
from rich.table import Table

from morphing_wing.terminal_tables import text_table

from .deformation import MODES
from .result import PAPER
from .stability import CRITERIA, FARTHEST, stable_to

if TYPE_CHECKING:
    from .fit import Fit
    from .result import Calibration

__all__ = ["report"]


def report(found: Calibration) -> Iterator[Table | str]:
    """Yield how tests were read, the laws, their constants, their stability, and sentences."""
    for test in found.tests:
        yield f"{test.name}: {'; '.join(test.remarks)}"
    lowest = min((fit for fit in found.fits.values() if fit.fitted), key=lambda fit: fit.aic)
    yield text_table(
        f"Laws on {found.chosen.points} points, the one asked for marked *; stable up to stretch",
        ["law", "RMS kPa", "R2", "AIC", "BIC", *MODES],
        [[name + " *" * (fit is found.chosen) + " (lowest AIC)" * (fit is lowest),
          f"{1000.0 * fit.rms:.4g}", f"{fit.r2:.5f}", f"{fit.aic:.1f}", f"{fit.bic:.1f}",
          *map(_stretch, stable_to(fit.stability).values())]
         for name, fit in found.fits.items()])
    yield text_table(
        "Constants, by least squares on nominal stress",
        ["law", "constant", "value", "unit", "standard error", "95 % interval"],
        [row for name, fit in found.fits.items() for row in _constants(name, fit)])
    shown = [name for name, fit in found.fits.items() if fit is found.chosen or name == PAPER]
    yield text_table(
        f"Stretches between which a law is stable, sought from {1 / FARTHEST:g} to {FARTHEST:g}",
        ["law", "mode", *CRITERIA],
        [row for name in shown for row in _stability(name, found.fits[name].stability)])
    yield from found.sentences()


def _constants(name: str, fit: Fit) -> Iterator[list[str]]:
    for i, (constant, value) in enumerate(zip(fit.law.constants, fit.values, strict=True)):
        half = fit.half_width[i]
        why = "given" if not fit.fitted else "held by stability"
        sure = math.isfinite(half)
        yield [name if i == 0 else "", constant, f"{value:.4g}", fit.law.units[i] or "1",
               f"{fit.errors[i]:.2g}" if sure else "-",
               f"{value - half:.4g} to {value + half:.4g}" if sure else why]


def _stability(name: str, stability: pd.DataFrame) -> Iterator[list[str]]:
    for number, (mode, part) in enumerate(stability.groupby("mode", sort=False)):
        ends = part.set_index("criterion").loc[list(CRITERIA)]
        yield ["" if number else name, str(mode), *(
            "all" if begin == 0.0 and math.isinf(end)
            else f"{_low(begin)} to {_stretch(end)}"
            for begin, end in zip(ends["from"], ends["to"], strict=True))]


def _stretch(end: float) -> str:
    return f"beyond {FARTHEST:g}" if math.isinf(end) else f"{end:.4f}"


def _low(begin: float) -> str:
    return f"below {1 / FARTHEST:g}" if begin == 0.0 else f"{begin:.4f}"
