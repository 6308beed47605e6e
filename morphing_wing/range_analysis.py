r"""Range analysis of an orthogonal experiment: which factor matters, and at which level most.

Every factor j has levels i, each tested in equally many rows, and each with every level of every
other factor equally often. So the other factors drop out of the means (the paper's Section 4)

.. math:: \bar T_{ij} = \frac{1}{m_j} \sum_{\text{rows of level } i} y , \qquad
    R_j = \max_i \bar T_{ij} - \min_i \bar T_{ij} , \qquad
    S_j = m_j \sum_i (\bar T_{ij} - \bar y)^2 ,

and the sums of squares S_j with a rest, of interactions, make up that of all rows.
"""

from __future__ import annotations

from collections.abc import Sequence
from itertools import combinations
from typing import Any

import numpy as np
import pandas as pd

from morphing_wing.errors import InputError

__all__ = ["best_levels", "range_analysis"]


def range_analysis(table: pd.DataFrame, factors: Sequence[str], response: str) -> pd.DataFrame:
    """Return the mean of each level of each factor, with the factor's range and sum of squares.

    Parameters
    ----------
    table
        One row a test.
    factors
        Columns that hold the levels, of any type.
    response
        Column of what was measured, in any unit.

    Returns
    -------
    DataFrame
        One row a level, in order of appearance: ``factor``, ``level`` (as text), ``mean`` and, the
        same in all rows of a factor, ``range``, ``sum_of_squares`` and ``share`` of that of all
        tests.

    Raises
    ------
    InputError
        If the tests are not orthogonal, or a response is missing.

    Examples
    --------
    >>> tests = pd.DataFrame({"a": [1, 1, 2, 2], "b": [1, 2, 1, 2], "y": [1.0, 2.0, 5.0, 6.0]})
    >>> range_analysis(tests, ["a", "b"], "y")[["factor", "level", "mean", "range"]]
      factor level  mean  range
    0      a     1   1.5    4.0
    1      a     2   5.5    4.0
    2      b     1   3.0    1.0
    3      b     2   4.0    1.0
    """
    values = table[response].to_numpy(float)
    if not np.isfinite(values).all():
        raise InputError(f"{response}: must be known of every test, or levels cannot be compared")
    for pair in combinations(factors, 2):
        if np.ptp(pd.crosstab(*(table[name] for name in pair)).to_numpy()) > 0:
            raise InputError(f"{' and '.join(pair)}: must have each pair of levels in equally many "
                             "tests, or other factors do not drop out of a level's mean")
    total = float(np.sum((values - values.mean()) ** 2))
    parts = []
    for factor in factors:
        tests = table.groupby(factor, sort=False)[response]
        means = tests.mean()
        squares = float(np.sum(tests.size() * (means - values.mean()) ** 2))
        parts.append(pd.DataFrame({
            "factor": factor, "level": [_text(level) for level in means.index],
            "mean": means.to_numpy(), "range": float(np.ptp(means)), "sum_of_squares": squares,
            "share": squares / total if total > 0.0 else 0.0}))
    return pd.concat(parts, ignore_index=True)


def best_levels(levels: pd.DataFrame) -> dict[str, Any]:
    """Return of each factor the level of the largest mean; see `range_analysis`."""
    best = levels.loc[levels.groupby("factor", sort=False)["mean"].idxmax()]
    return dict(zip(best["factor"], best["level"], strict=True))


def _text(level: Any) -> str:
    # 1.98, not the 1.9800000000000002 of 2.2 less a tenth.
    return str(float(f"{level:.12g}")) if isinstance(level, float) else str(level)
