"""Several laws fitted to tests of a rubber."""

from __future__ import annotations

import math
import os
import time
from collections.abc import Sequence

from morphing_wing.errors import InputError, is_count, is_number, require
from morphing_wing.materials import DRAGON_SKIN_30

from .curve_file import read_test
from .fit import Fit, UndeterminedError, fitted, judged
from .laws import Law, MooneyRivlinLaw, YeohLaw
from .material_test import MaterialTest
from .ogden import OgdenLaw
from .points import Points
from .result import PAPER, Calibration
from .stability import FARTHEST

__all__ = ["LAWS", "calibrate"]

MOST_TERMS = 3
LAWS: tuple[Law, ...] = (
    *(YeohLaw(n) for n in range(1, MOST_TERMS + 1)), MooneyRivlinLaw(), OgdenLaw(1), OgdenLaw(2))


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
    require(stable is None or is_number(stable) and 1.0 < stable <= FARTHEST, "stable", stable, "",
            f"a stretch greater than 1, at most {FARTHEST:g}")
    if not tests:
        raise InputError("tests: is empty, must be at least one")
    read = [test if isinstance(test, MaterialTest) else read_test(test) for test in tests]
    used = _up_to([test.until_failure(whole) for test in read], max_stretch)
    data = Points.of(used)
    chosen = YeohLaw(terms)
    fits: dict[str, Fit] = {}
    refused: dict[str, str] = {}
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
    for_all = is_number(max_stretch)
    limits = [max_stretch] * len(tests) if for_all else list(max_stretch)  # type: ignore[arg-type]
    if len(limits) != len(tests):
        raise InputError(f"max_stretch: is given {len(limits)} times, must be once, or once for "
                         f"each of {len(tests)} tests")
    for limit, test in zip(limits, tests, strict=True):
        require(is_number(limit) and limit > 1.0, "max_stretch", limit, "", "greater than 1")
        largest = max(t.largest for t in tests) if for_all else test.largest
        if largest <= 1.0:
            raise InputError(f"max_stretch = {limit:g}: must be left out, {test.name} is in "
                             "compression")
        require(limit <= largest, "max_stretch", limit, "",
                f"at most {math.floor(1e4 * largest) / 1e4:g}, the largest stretch used of "
                f"{'the tests' if for_all and len(tests) > 1 else test.name}")
        if not (test.points[0] <= limit).sum() >= 2:
            raise InputError(f"max_stretch = {limit:g}: must leave at least 2 points of "
                             f"{test.name}")
    return [test.up_to(limit) for limit, test in zip(limits, tests, strict=True)]
