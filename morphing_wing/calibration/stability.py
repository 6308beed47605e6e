r"""Up to which stretch an incompressible law is stable, by four criteria, in the three tests.

With :math:`\tilde W(\lambda_1, \lambda_2) = W(\lambda_1, \lambda_2, 1/(\lambda_1 \lambda_2))`:

- "force": the nominal stress of the test rises, :math:`dP/d\lambda > 0`;
- "dead loads": the Hessian of :math:`\tilde W` is positive definite, so that the sheet is stable
  under two given forces; what `morphing_wing.materials.Yeoh.stability` tells of solutions. It
  concerns a free sheet, whose forces may give way where the material is sound;
- "Drucker": :math:`d\tau : d\varepsilon > 0` for Kirchhoff's stress and logarithmic strain, that is

  .. math:: D_{ab} = \lambda_a \lambda_b \tilde W_{ab} + \delta_{ab} \lambda_a \tilde W_a

  is positive definite, as finite-element programs check it;
- "ellipticity": waves of every direction n and every polarisation m across it have real speeds,

  .. math:: \mathcal A_{0ijkl} n_i m_j n_k m_l > 0 , \qquad m \cdot n = 0

  (Ogden 1984, Section 6; strong ellipticity, incompressible). For laws in I1 alone this is
  :math:`W' > 0` and :math:`W' + 2 W'' (\lambda_{max} - \lambda_{min})^2 > 0`.
"""

from __future__ import annotations

import math
from functools import partial
from typing import Any

import numpy as np
import pandas as pd
from scipy.optimize import brentq

from .deformation import MODES, accelerations, principal, rates
from .ellipticity import least_wave_modulus
from .laws import Law

__all__ = ["CRITERIA", "ENFORCED", "FARTHEST", "margin", "ranges", "stable_to"]

CRITERIA = ("force", "dead loads", "Drucker", "ellipticity")
ENFORCED = ("force", "Drucker", "ellipticity")
"""What makes a law "stable" here; dead loads are told beside it."""

FARTHEST = 10.0
"""Stretch, and 1 over it, up to which stability is looked for."""


def margin(
    law: Law, values: Any, criterion: str, mode: str, stretch: Any
) -> np.ndarray:
    """Return how far from instability a law is, in MPa: greater than 0 where it is stable.

    Parameters
    ----------
    law, values
        The law and its constants.
    criterion
        One of `CRITERIA`.
    mode
        One of `morphing_wing.calibration.deformation.MODES`.
    stretch
        Stretches of any shape, greater than 0.
    """
    stretches = principal(mode, stretch)
    gradient, hessian = law.gradient(values, stretches), law.hessian(values, stretches)
    if criterion == "force":
        rate, loaded = rates(mode, stretch), 2.0 if mode == "equibiaxial" else 1.0
        bent = np.sum(gradient * accelerations(mode, stretch), axis=-1)
        return (np.einsum("...i,...ij,...j", rate, hessian, rate) + bent) / loaded
    if criterion == "ellipticity":
        return least_wave_modulus(stretches, gradient, hessian)
    first, second = _in_the_plane(stretches, gradient, hessian)
    if criterion == "Drucker":
        plane = stretches[..., :2]
        second = second * plane[..., :, None] * plane[..., None, :]
        second = second + (plane * first)[..., None] * np.eye(2)
    trace = 0.5 * (second[..., 0, 0] + second[..., 1, 1])
    return trace - np.hypot(0.5 * (second[..., 0, 0] - second[..., 1, 1]), second[..., 0, 1])


def ranges(law: Law, values: Any) -> pd.DataFrame:
    """Return in which stretches about 1 a law is stable.

    Returns
    -------
    DataFrame
        One row a mode and criterion: ``mode``, ``criterion``, and the stretches ``from`` and ``to``
        between which it holds; 0 and infinity where it holds as far as was looked, to `FARTHEST`.
    """
    rows = []
    for mode in MODES:
        for criterion in CRITERIA:
            ends = [_end(partial(margin, law, values, criterion, mode), sign) for sign in (-1, 1)]
            rows.append({"mode": mode, "criterion": criterion, "from": ends[0], "to": ends[1]})
    return pd.DataFrame(rows)


def stable_to(stability: pd.DataFrame) -> dict[str, float]:
    """Return of each mode the stretch up to which all of `ENFORCED` hold; see `ranges`."""
    known = stability[stability["criterion"].isin(ENFORCED)]
    return {mode: float(part["to"].min()) for mode, part in known.groupby("mode", sort=False)}


def _in_the_plane(
    stretches: np.ndarray, gradient: np.ndarray, hessian: np.ndarray
) -> tuple[np.ndarray, np.ndarray]:
    """Return gradient and Hessian of W as a function of the first two stretches."""
    plane, third = stretches[..., :2], stretches[..., 2, None]
    by = -third / plane
    twice = by[..., :, None] * by[..., None, :] / third[..., None] * (1.0 + np.eye(2))
    first = gradient[..., :2] + gradient[..., 2, None] * by
    mixed = hessian[..., :2, 2, None] * by[..., None, :]
    second = (hessian[..., :2, :2] + mixed + np.swapaxes(mixed, -1, -2)
              + hessian[..., 2, 2, None, None] * by[..., :, None] * by[..., None, :]
              + gradient[..., 2, None, None] * twice)
    return first, second


def _end(margin_at: Any, sign: int) -> float:
    """Return the stretch nearest to 1, above (+1) or below, at which a margin is 0."""
    logs = sign * np.linspace(0.0, math.log(FARTHEST), 121)
    lost = np.flatnonzero(~(margin_at(np.exp(logs)) > 0.0))
    if lost.size == 0:
        return math.inf if sign > 0 else 0.0
    if lost[0] == 0:
        return 1.0
    between = logs[lost[0] - 1], logs[lost[0]]
    return math.exp(brentq(lambda log: float(margin_at(np.exp(log))), *between, xtol=1e-12))
