r"""Analysis of variance of a balanced experiment: which factors matter beyond the rest.

With the sum of squares :math:`S_j` of each factor (see `range_analysis`), of :math:`f_j` degrees of
freedom, and what all of them leave over, :math:`S_e` of :math:`f_e`,

.. math:: F_j = \frac{S_j / f_j}{S_e / f_e}, \qquad p_j = P(F_{f_j, f_e} > F_j), \qquad
    \rho_j = \frac{S_j - f_j S_e / f_e}{S_T} .

Computed results have no noise: the rest are interactions, and p says whether a factor stands out
from them. The contribution :math:`\rho_j` is Taguchi's, the share of all squares that is left when
as much of the rest as falls to the factor's degrees of freedom is taken off.
"""

from __future__ import annotations

from collections.abc import Sequence
from itertools import combinations

import numpy as np
import pandas as pd
from scipy.stats import f as f_distribution

from morphing_wing.range_analysis import range_analysis

__all__ = ["RESIDUAL", "variance_analysis"]

RESIDUAL = "residual"
"""Row of what the factors leave over."""

ROUNDING = 1e-12
"""Part of all squares below which differences of squares are rounding."""


def variance_analysis(
    table: pd.DataFrame, factors: Sequence[str], response: str, interactions: bool = False
) -> pd.DataFrame:
    """Return the analysis of variance of the factors, and of pairs of them.

    Parameters
    ----------
    table
        One row a test.
    factors
        Columns that hold the levels.
    response
        Column of what was measured.
    interactions
        Whether pairs have rows of their own. Right where each combination of their levels with
        those of all others was tested: in an orthogonal array pairs are mixed with factors.

    Returns
    -------
    DataFrame
        One row a source, the last is the residual: ``source``, ``sum_of_squares``,
        ``degrees_of_freedom``, ``mean_square``, ``F``, ``p`` (both not a number where nothing is
        left over), ``share`` of all squares, ``contribution``.

    Raises
    ------
    InputError
        As `range_analysis`.

    Examples
    --------
    >>> tests = pd.DataFrame({"a": [1, 1, 2, 2], "b": [1, 2, 1, 2], "y": [1.0, 2.0, 5.0, 6.2]})
    >>> variance_analysis(tests, ["a", "b"], "y")[["source", "degrees_of_freedom", "F"]].round(1)
         source  degrees_of_freedom       F
    0         a                   1  1681.0
    1         b                   1   121.0
    2  residual                   1     NaN
    """
    levels = range_analysis(table, factors, response)
    values = table[response].to_numpy(float)
    total = float(np.sum((values - values.mean()) ** 2))
    squares = {name: float(levels.loc[levels["factor"] == name, "sum_of_squares"].iloc[0])
               for name in factors}
    freedom = {name: table[name].nunique() - 1 for name in factors}
    if interactions:
        for a, b in combinations(list(factors), 2):
            cells = table.groupby([a, b], sort=False)[response]
            between = float(np.sum(cells.size() * (cells.mean() - values.mean()) ** 2))
            beyond = between - squares[a] - squares[b]
            squares[f"{a} x {b}"] = beyond if beyond > ROUNDING * total else 0.0
            freedom[f"{a} x {b}"] = freedom[a] * freedom[b]
    rest, free = total - sum(squares.values()), len(values) - 1 - sum(freedom.values())
    found = pd.DataFrame({
        "source": [*squares, RESIDUAL], "sum_of_squares": [*squares.values(), rest],
        "degrees_of_freedom": [*freedom.values(), free]})
    degrees = found["degrees_of_freedom"]
    known = free > 0 and rest > ROUNDING * total  # or it is nothing to compare with
    error = rest / free if known else np.nan
    found.loc[found.index[-1], "sum_of_squares"] = rest if known else 0.0
    found["mean_square"] = found["sum_of_squares"] / degrees.where(degrees > 0)
    sources = found["source"] != RESIDUAL
    found["F"] = (found["mean_square"] / error).where(sources)
    found["p"] = f_distribution.sf(found["F"], degrees, free) if known else np.nan
    found["share"] = found["sum_of_squares"] / total if total > 0.0 else 0.0
    taken = degrees * (error if known else 0.0)
    pure = (found["sum_of_squares"] - taken) / total if total > 0.0 else 0.0 * taken
    found["contribution"] = pure.where(sources, 1.0 - pure[sources].sum() if total > 0.0 else 0.0)
    return found
