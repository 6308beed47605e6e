"""What each factor does alone, the others as they are: of a study one factor at a time."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import pandas as pd

from .designs import VARIED
from .factors import Factor

__all__ = ["effects"]


def effects(table: pd.DataFrame, factors: Sequence[Factor], response: str) -> pd.DataFrame:
    """Return how far a response goes while one factor goes through its levels.

    Parameters
    ----------
    table
        Cases of the design "one_at_a_time"; those without a response are left out.
    factors
        Its factors.
    response
        Column.

    Returns
    -------
    DataFrame
        Of each factor ``lowest`` and ``highest`` response, their difference ``change``, the
        ``slope`` of the straight line through the responses, per unit of the factor, and the
        ``elasticity``: that slope in per cent per per cent of the base. The last two are not a
        number of words, and without a known base.
    """
    good = table[table[response].notna()]
    base = good[good[VARIED] == "none"]
    rows = []
    for factor in factors:
        x = pd.concat([base, good[good[VARIED] == factor.column]])
        y = x[response].to_numpy(float)
        row = {"factor": factor.column, "lowest": np.nan, "highest": np.nan, "change": np.nan,
               "slope": np.nan, "elasticity": np.nan}
        if len(y):
            row |= {"lowest": y.min(), "highest": y.max(), "change": np.ptp(y)}
        if factor.is_range and x[factor.column].nunique() > 1:
            row["slope"] = float(np.polyfit(x[factor.column].to_numpy(float), y, 1)[0])
            if len(base) and base[response].iloc[0] != 0.0:
                row["elasticity"] = row["slope"] * float(base[factor.column].iloc[0]) / float(
                    base[response].iloc[0])
        rows.append(row)
    return pd.DataFrame(rows)
