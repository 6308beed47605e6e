"""Several laws fitted to tests of a rubber, and what is to be known before one is used."""

from __future__ import annotations

import math
import os
import pathlib
import time
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
import pandas as pd

from morphing_wing.errors import InputError, is_count, is_number, require
from morphing_wing.materials import DRAGON_SKIN_30, Yeoh

from .curve_file import read_test
from .deformation import MODES
from .fit import Data, Fit, UndeterminedError, fitted, judged
from .laws import Law, MooneyRivlinLaw, OgdenLaw, YeohLaw
from .material_test import MaterialTest
from .stability import stable_to

__all__ = ["PAPER", "Calibration", "calibrate"]

PAPER = "the paper's pair"
"""Name of the law that every scene has unless another is given."""

MOST_TERMS = 3
LAWS: tuple[Law, ...] = (
    *(YeohLaw(n) for n in range(1, MOST_TERMS + 1)), MooneyRivlinLaw(), OgdenLaw(1), OgdenLaw(2))


@dataclass(frozen=True)
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
        from morphing_wing.root import write_whole
        from morphing_wing.study_files import write_study

        folder = pathlib.Path(directory)
        write_study(folder, self.summary(), {
            "table": self.table(), "stability": self.stability(), "curves": self.curves()})
        write_whole(folder / "elastomer.toml", lambda at: at.write_text(self.toml))
        self.plot(folder / "calibration.png")


def calibrate(
    *tests: MaterialTest | str | os.PathLike, terms: int = 2,
    max_stretch: float | Sequence[float] | None = None, stable: float | None = None,
    whole: bool = False,
) -> Calibration:
    """Fit Yeoh's law to tests by weighted least squares on nominal stress, and others beside it.

    Parameters
    ----------
    tests
        Tests, or files of them that `read_test` reads without being told more; "dragon_skin_30" is
        one that comes with the package.
    terms
        Terms of Yeoh's law that make the material: 1 to 3.
    max_stretch
        Largest stretch that is used; one for all tests, or one each. None: all.
    stable
        Stretch up to which every law must be stable in all three modes; None: only told.
    whole
        Use the curves beyond their largest stress too, see `MaterialTest.until_failure`.

    Raises
    ------
    InputError
        If a file or an option cannot be computed with, or the data do not determine the constants.

    Examples
    --------
    >>> from morphing_wing import Spar
    >>> from morphing_wing.geometry import SparGeometry
    >>> found = calibrate("dragon_skin_30", max_stretch=2)
    >>> spar = Spar(SparGeometry.validation(), found.material)                   # doctest: +SKIP
    """
    begin = time.perf_counter()
    require(is_count(terms) and terms <= MOST_TERMS, "terms", terms, "", f"1 to {MOST_TERMS}")
    require(stable is None or is_number(stable) and 1.0 < stable <= 10.0, "stable", stable, "",
            "a stretch greater than 1, at most 10")
    if not tests:
        raise InputError("tests: is empty, must be at least one")
    read = [test if isinstance(test, MaterialTest) else read_test(test) for test in tests]
    used = _up_to([test.until_failure(whole) for test in read], max_stretch)
    data = Data.of(used)
    chosen = YeohLaw(terms)
    fits, refused = {}, {}
    for law in LAWS:
        try:
            fits[law.name] = fitted(law, data, stable)
        except UndeterminedError as problem:
            if law == chosen:
                names = ", ".join(test.name for test in used)
                raise InputError(f"{names}: {law.name} {problem}") from None
            refused[law.name] = str(problem)
    stiffness = fits[chosen.name].values[0]
    if not stiffness > 0.0:
        names = ", ".join(test.name for test in used)
        raise InputError(f"{names}: C10 of {chosen.name} becomes {stiffness:.4g} MPa, must be "
                         "greater than 0: stress must grow with stretch, be positive in tension")
    paper = DRAGON_SKIN_30.coefficients
    fits[PAPER] = judged(YeohLaw(len(paper)), paper, data, fitted=False)
    return Calibration(tuple(used), fits, refused, terms, stable, time.perf_counter() - begin)


def _up_to(
    tests: list[MaterialTest], max_stretch: float | Sequence[float] | None
) -> list[MaterialTest]:
    """Return the tests up to a stretch that at least one of them reaches."""
    if max_stretch is None:
        return tests
    each = is_number(max_stretch)
    limits = [max_stretch] * len(tests) if each else list(max_stretch)  # type: ignore[arg-type]
    if len(limits) != len(tests):
        raise InputError(f"max_stretch: is given {len(limits)} times, must be once, or once for "
                         f"each of {len(tests)} tests")
    for limit, test in zip(limits, tests, strict=True):
        require(is_number(limit) and limit > 1.0, "max_stretch", limit, "", "greater than 1")
        largest = max(t.largest for t in tests) if each else test.largest
        require(limit <= largest, "max_stretch", limit, "",
                f"at most {math.floor(1e4 * largest) / 1e4:g}, the largest stretch used of "
                f"{'the tests' if each and len(tests) > 1 else test.name}")
        if not (test.points[0] <= limit).sum() >= 2:
            raise InputError(f"max_stretch = {limit:g}: must leave at least 2 points of "
                             f"{test.name}")
    return [test.up_to(limit) for limit, test in zip(limits, tests, strict=True)]


def _until(end: float) -> str:
    return "as far as was looked" if not np.isfinite(end) else f"up to {end:.4g}"
