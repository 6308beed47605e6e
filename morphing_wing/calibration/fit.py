r"""Weighted least squares of a law's constants on tests, with intervals and criteria of choice.

Minimised is :math:`S = \sum_k \omega_k \sum_i (P_{law}(\lambda_{ki}) - P_{ki})^2` of the nominal
stresses, where test k counts by its weight however many points it has:
:math:`\omega_k = w_k N / (n_k \sum w)`, so that a test alone has :math:`\omega = 1`. With p
constants, :math:`s^2 = S/(N - p)` and the stress's derivatives J by them,

.. math:: \operatorname{cov} = s^2 (J^T \Omega J)^{-1} , \qquad
    c \pm t_{0.975, N - p} \sqrt{\operatorname{cov}_{cc}} , \qquad
    \mathrm{AIC} = N \ln \frac{S}{N} + 2 (p + 1) , \qquad
    \mathrm{BIC} = N \ln \frac{S}{N} + (p + 1) \ln N ,

exact for independent normal errors where the law is linear in its constants, else asymptotic.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
import pandas as pd
from scipy import linalg, stats
from scipy.optimize import least_squares, nnls

from .laws import Law
from .ogden import OgdenLaw
from .points import Points
from .stability import ranges
from .stable_fit import Objective, is_stable, stable_values

__all__ = ["Fit", "UndeterminedError", "fitted", "judged"]

CONFIDENCE = 0.95
STEEPEST = 30.0
"""Largest exponent of Ogden's law that is looked for."""

INDISTINCT = 1e-10
"""Ratio of singular values below which the data do not tell the constants apart."""


class UndeterminedError(ValueError):
    """The data do not determine a law's constants; the message is the end of a sentence."""


@dataclass(frozen=True, eq=False)
class Fit:
    """A law with its constants, how sure they are, and how well it describes the data.

    Attributes
    ----------
    law
        The law.
    values
        Its constants, in the order of ``law.constants``.
    errors
        Their standard errors; NaN where nothing was fitted or stability holds a constant.
    half_width
        Half of the 95 % intervals; NaN likewise.
    fitted
        Whether the constants were fitted, not given.
    held
        Whether a condition of stability decides the constants.
    points
        Number of points.
    rms
        Root of the mean squared residual in MPa, each point counted once.
    r2
        1 minus residual over total sum of squares, weighted.
    aic, bic
        Criteria of Akaike and Schwarz; to be compared among laws fitted to the same data.
    correlation
        Of neighbours' residuals: near 1 the errors are not independent but those of the law.
    """

    law: Law
    values: np.ndarray
    errors: np.ndarray
    half_width: np.ndarray
    fitted: bool
    held: bool
    points: int
    rms: float
    r2: float
    aic: float
    bic: float
    correlation: float

    @cached_property
    def stability(self) -> pd.DataFrame:
        """See `morphing_wing.calibration.stability.ranges`."""
        return ranges(self.law, self.values)


def fitted(law: Law, data: Points, stable: float | None = None) -> Fit:
    """Find a law's constants by weighted least squares.

    Parameters
    ----------
    law
        The law.
    data
        What it is fitted to.
    stable
        Stretch up to which it must be stable in all three modes; None: not asked for.

    Raises
    ------
    UndeterminedError
        If the points are too few, or do not tell the constants apart.
    """
    p = len(law.constants)
    distinct = np.unique(np.concatenate([stretch for _, stretch in data.parts]))
    if np.count_nonzero(np.abs(distinct - 1.0) > 1e-12) <= p:
        raise UndeterminedError(f"needs points at more than {p} different stretches other than 1")
    if not law.linear and {mode for mode, _ in data.parts} == {"planar"}:
        # There exponents of either sign are the same law.
        raise UndeterminedError("has constants that planar tension alone does not tell apart")
    values = _linear(law, data) if law.linear else _nonlinear(law, data)
    held = stable is not None and not is_stable(law, values, stable)
    if held:
        values = stable_values(
            Objective(law, data.computed, data.slopes, data.stress, data.weights), values, stable)
    return judged(law, values, data, held=held)


def judged(
    law: Law, values: Any, data: Points, fitted: bool = True, held: bool = False
) -> Fit:
    """Return given constants with how well they describe the data."""
    values = np.asarray(values, dtype=float)
    residuals = data.computed(law, values) - data.stress
    n, p = data.stress.size, values.size
    squares = float(data.weights @ residuals**2)
    mean = np.average(data.stress, weights=data.weights)
    total = float(data.weights @ (data.stress - mean) ** 2)
    # Data without any error would else have a logarithm of zero.
    least = n * (np.finfo(float).eps * max(np.abs(data.stress).max(), 1e-300)) ** 2
    likelihood = n * math.log(max(squares, least) / n)
    free = p if fitted else 0
    errors = np.full(p, math.nan)
    if fitted and not held:
        errors = np.sqrt(squares / (n - p) * np.diag(_inverse(law, values, data)))
    centred = residuals - residuals.mean()
    spread = float(centred @ centred)
    return Fit(
        law, values, errors, errors * stats.t.ppf(0.5 + 0.5 * CONFIDENCE, max(n - p, 1)), fitted,
        held, n, float(np.sqrt(np.mean(residuals**2))),
        1.0 - squares / total if total > 0.0 else math.nan,
        likelihood + 2.0 * (free + 1), likelihood + (free + 1) * math.log(n),
        float(centred[1:] @ centred[:-1]) / spread if spread > 0.0 else 0.0)


def _linear(law: Law, data: Points) -> np.ndarray:
    """Return the constants of a law that is linear in them."""
    return _solved(data.slopes(law, np.zeros(len(law.constants))), data)[0]


def _solved(slopes: np.ndarray, data: Points) -> tuple[np.ndarray, float]:
    """Return the weighted least squares' solution, of columns scaled alike, and its residual."""
    root = np.sqrt(data.weights)
    scale = np.sqrt(data.weights @ slopes**2)
    scale[scale == 0.0] = 1.0
    matrix = root[:, None] * slopes / scale
    found, _, _, singular = linalg.lstsq(matrix, root * data.stress)
    if singular[-1] < INDISTINCT * singular[0]:
        raise UndeterminedError("has constants that these data do not tell apart")
    return found / scale, float(np.sum((matrix @ found - root * data.stress) ** 2))


def _nonlinear(law: Law, data: Points) -> np.ndarray:
    """Return Ogden's constants: moduli by linear least squares for many exponents, then all.

    Moduli are kept positive, so that Drucker's condition holds at every stretch. Else two terms run
    away, with exponents that become one and moduli that grow without bound against each other.
    """
    assert isinstance(law, OgdenLaw)
    terms, few = law.terms, data.thinned(300)
    fewer = _nonlinear(OgdenLaw(terms - 1), data) if terms > 1 else None
    starts = _moduli_of_exponents(law, few)[: 4 if fewer is None else 3]
    if fewer is not None:
        moduli, exponents = np.split(fewer, 2)
        starts += [[*moduli, 0.02 * moduli.sum(), *exponents, more] for more in (-4.0, 1.0, 6.0)]
    near = min((_searched(law, few, start) for start in starts), key=lambda end: end.cost)
    best = _searched(law, data, near.x)
    if (np.abs(best.x[terms:]) > 0.999 * STEEPEST).any():
        raise UndeterminedError(f"needs exponents beyond {STEEPEST:g}")
    if fewer is not None:
        off = data.computed(OgdenLaw(terms - 1), fewer) - data.stress
        if 2.0 * best.cost > (1.0 - 1e-4) * float(data.weights @ off**2):
            raise UndeterminedError("gains nothing by another term of positive modulus")
    return law.in_order(best.x)


def _searched(law: Law, data: Points, start: Any) -> Any:
    """Return scipy's answer from one start, moduli of at least 0 and bounded exponents."""
    root = np.sqrt(data.weights)
    lower = [0.0 if unit else -STEEPEST for unit in law.units]
    upper = [math.inf if unit else STEEPEST for unit in law.units]
    return least_squares(
        lambda values: root * (data.computed(law, values) - data.stress), start,
        jac=lambda values: root[:, None] * data.slopes(law, values), x_scale="jac",
        bounds=(lower, upper), xtol=1e-12, ftol=1e-12, gtol=1e-12, max_nfev=400)


def _moduli_of_exponents(law: OgdenLaw, data: Points) -> list[list[float]]:
    """Return constants to begin with, the best first: moduli of at least 0 for many exponents."""
    root, starts = np.sqrt(data.weights), []
    for exponents in law.exponents():
        slopes = data.slopes(law, [*[1.0] * law.terms, *exponents])[:, : law.terms]
        scale = np.sqrt(data.weights @ slopes**2)
        moduli, residual = nnls(root[:, None] * slopes / scale, root * data.stress)
        starts.append((residual, [*(moduli / scale), *exponents]))
    return [start for _, start in sorted(starts)]


def _inverse(law: Law, values: np.ndarray, data: Points) -> np.ndarray:
    """Return the inverse of J^T Omega J."""
    slopes = np.sqrt(data.weights)[:, None] * data.slopes(law, values)
    scale = np.linalg.norm(slopes, axis=0)
    scale[scale == 0.0] = 1.0
    _, singular, rows = linalg.svd(slopes / scale, full_matrices=False)
    if singular[-1] < INDISTINCT * singular[0]:
        raise UndeterminedError("has constants that these data do not tell apart")
    half = rows.T / singular / scale[:, None]
    return half @ half.T
