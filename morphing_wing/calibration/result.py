"""What tests say about a rubber: laws, material, tables, sentences, files."""

from __future__ import annotations

import os
import pathlib
from dataclasses import dataclass
from typing import Any

import numpy as np
import pandas as pd

from morphing_wing.materials import Yeoh
from morphing_wing.root import write_whole
from morphing_wing.study_files import write_study

from .deformation import MODES
from .fit import Fit
from .laws import YeohLaw
from .material_test import MaterialTest
from .stability import stable_to

__all__ = ["PAPER", "Calibration"]

PAPER = "the paper's pair"
"""Name of the law that every scene has unless another is given."""


@dataclass(frozen=True, eq=False)
class Calibration:
    """What tests say about a rubber.

    Attributes
    ----------
    tests
        The tests, with what of them was used.
    fits
        Name -> fit of each law that the data determine, and `PAPER`, whose constants are given.
    refused
        Name -> why a law's constants were not found.
    terms
        Of Yeoh's law, how many make `material`.
    stable
        Stretch up to which laws were made stable; None: nothing was asked for.
    seconds
        How long it took.
    """

    tests: tuple[MaterialTest, ...]
    fits: dict[str, Fit]
    refused: dict[str, str]
    terms: int
    stable: float | None
    seconds: float

    @property
    def chosen(self) -> Fit:
        """The fit of Yeoh's law with the number of terms asked for."""
        return self.fits[YeohLaw(self.terms).name]

    @property
    def material(self) -> Yeoh:
        """The material for `Spar`, `Wing` and others: bulk modulus and density by default."""
        return Yeoh(tuple(float(value) for value in self.chosen.values))

    @property
    def toml(self) -> str:
        """The table of a scene file that gives the material."""
        constants = ", ".join(f'"{value:.6g} MPa"' for value in self.chosen.values)
        return f"[elastomer]\ncoefficients = [{constants}]\n"

    @property
    def measured(self) -> tuple[str, ...]:
        """The modes that were measured."""
        return tuple(mode for mode in MODES if mode in {test.mode for test in self.tests})

    def table(self) -> pd.DataFrame:
        """Return one row a constant: its value, standard error and 95 % interval, its law's fit."""
        rows = []
        for name, fit in self.fits.items():
            for i, constant in enumerate(fit.law.constants):
                rows.append({
                    "law": name, "chosen": fit is self.chosen, "constant": constant,
                    "unit": fit.law.units[i], "value": fit.values[i],
                    "standard_error": fit.errors[i],
                    "lower_95": fit.values[i] - fit.half_width[i],
                    "upper_95": fit.values[i] + fit.half_width[i], "fitted": fit.fitted,
                    "held_by_stability": fit.held, "points": fit.points, "rms_MPa": fit.rms,
                    "r2": fit.r2, "aic": fit.aic, "bic": fit.bic,
                    "residual_correlation": fit.correlation,
                    "shear_modulus_MPa": fit.law.shear_modulus(fit.values),
                    **{f"stable_to_{mode}": end for mode, end in
                       stable_to(fit.stability).items()}})
        return pd.DataFrame(rows)

    def stability(self) -> pd.DataFrame:
        """Return of each law, mode and criterion the stretches between which it is stable."""
        return pd.concat([fit.stability.assign(law=name) for name, fit in self.fits.items()],
                         ignore_index=True)[["law", "mode", "criterion", "from", "to"]]

    def curves(self) -> pd.DataFrame:
        """Return one row a measured point: nominal stress, whether it is used, and of each law."""
        parts = []
        for test in self.tests:
            parts.append(pd.DataFrame({
                "test": test.name, "mode": test.mode, "stretch": test.stretch,
                "measured_MPa": test.stress, "used": test.used,
                **{name: fit.law.stress(fit.values, test.mode, test.stretch)
                   for name, fit in self.fits.items()}}))
        return pd.concat(parts, ignore_index=True)

    def sentences(self) -> list[str]:
        """Return what is to be told of the fit beside its figures."""
        chosen, found = self.chosen, []
        name = chosen.law.name
        if chosen.held:
            found.append(f"{name}: held stable up to stretch {self.stable:g}, so that its constants"
                         " have no intervals of their own.")
        reach = stable_to(chosen.stability)
        used = {test.mode: test.largest for test in self.tests}
        for mode, end in reach.items():
            if end < used.get(mode, 1.0):
                found.append(f"{name}: unstable in {mode} tension from stretch {end:.4g} on, within"
                             " the data: ask for stability, or another number of terms.")
        lacking = [mode for mode in MODES if mode not in self.measured]
        if lacking:
            ends = ", ".join(f"{mode} {_until(reach[mode])}" for mode in lacking)
            found.append(f"Not measured: {' and '.join(lacking)}; what {name} says there is a "
                         f"prediction, stable {ends}.")
        if chosen.fitted and not chosen.held and chosen.correlation > 0.5:
            found.append(f"{name}: neighbouring residuals correlate by {chosen.correlation:.2f}, so"
                         " that the law errs more than the measurement, and the intervals, made for"
                         " independent errors, are too narrow.")
        found += [f"{name} is left out: it {why}." for name, why in self.refused.items()]
        return found

    def summary(self) -> dict[str, Any]:
        """Return what ``summary.json`` tells; stretches without end are None."""
        stability = self.stability()
        return {
            "study": "calibrate", "converged": True, "reason": "least squares were found",
            "seconds": self.seconds, "terms": self.terms, "stable": self.stable,
            "coefficients_MPa": list(self.chosen.values),
            "tests": [{"name": test.name, "mode": test.mode, "weight": test.weight,
                       "points": test.stretch.size, "used": int(test.used.sum()),
                       "max_stretch": test.largest, "remarks": list(test.remarks)}
                      for test in self.tests],
            "laws": [{
                "law": name, "constants": dict(zip(fit.law.constants, fit.values, strict=True)),
                "standard_errors": list(fit.errors), "half_width_95": list(fit.half_width),
                "fitted": fit.fitted, "held_by_stability": fit.held, "points": fit.points,
                "rms_MPa": fit.rms, "r2": fit.r2, "aic": fit.aic, "bic": fit.bic,
                "residual_correlation": fit.correlation,
                "stability": stability[stability["law"] == name].drop(
                    columns="law").to_dict("records")} for name, fit in self.fits.items()],
            "left_out": self.refused, "sentences": self.sentences(),
        }

    def plot(self, file: str | os.PathLike) -> pathlib.Path:
        """Draw data, fits, residuals and predictions into a PNG, PDF or SVG file."""
        from .picture import draw

        return draw(self, file)

    def save(self, directory: str | os.PathLike) -> None:
        """Write table, stability and curves as CSV, summary.json, elastomer.toml, a picture."""
        folder = pathlib.Path(directory)
        write_study(folder, self.summary(), {
            "table": self.table(), "stability": self.stability(), "curves": self.curves()})
        write_whole(folder / "elastomer.toml", lambda at: at.write_text(self.toml))
        self.plot(folder / "calibration.png")


def _until(end: float) -> str:
    return "as far as was looked" if not np.isfinite(end) else f"up to {end:.4g}"
