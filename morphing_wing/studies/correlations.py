"""How a response goes with each factor in a sample that fills the space."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import pandas as pd
from scipy.stats import spearmanr

from .factors import Factor

__all__ = ["correlations"]

_FEWEST = 3


def correlations(table: pd.DataFrame, factors: Sequence[Factor], response: str) -> pd.DataFrame:
    """Return Spearman's rank correlation, and the standardised coefficients of a linear fit.

    Parameters
    ----------
    table
        Cases; those without a response are left out.
    factors
        Its factors; those that are words have no order, and no figures.
    response
        Column.

    Returns
    -------
    DataFrame
        Of each factor ``spearman`` with its ``p``, and ``standardized_coefficient``: by how many of
        its standard deviations the response of the linear fit rises with one of the factor's; the
        same in all rows, ``r_squared`` of that fit.
    """
    good = table[table[response].notna()]
    numeric = [f.column for f in factors if f.is_range and good[f.column].nunique() > 1]
    y = good[response].to_numpy(float)
    found = pd.DataFrame({"factor": [factor.column for factor in factors]}).set_index("factor")
    found = found.assign(spearman=np.nan, p=np.nan, standardized_coefficient=np.nan,
                         r_squared=np.nan)
    if len(y) < max(_FEWEST, len(numeric) + 2) or np.ptp(y) == 0.0:
        return found.reset_index()
    x = good[numeric].to_numpy(float)
    x = (x - x.mean(axis=0)) / x.std(axis=0)
    z = (y - y.mean()) / y.std()
    slopes = np.linalg.lstsq(x, z, rcond=None)[0]
    for column, slope in zip(numeric, slopes, strict=True):
        rank = spearmanr(good[column].to_numpy(float), y)
        found.loc[column, ["spearman", "p", "standardized_coefficient"]] = [
            rank[0], rank[1], slope]
    found["r_squared"] = 1.0 - float(np.mean((z - x @ slopes) ** 2))
    return found.reset_index()
