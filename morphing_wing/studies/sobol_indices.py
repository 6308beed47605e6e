r"""Sobol' indices from Saltelli's sample: what of a variance is owed to which factor.

.. math:: S_i = \frac{V(E(y | x_i))}{V(y)}, \qquad
    S_{Ti} = 1 - \frac{V(E(y | x_{\sim i}))}{V(y)}

(Saltelli et al. 2010, by SALib; confidence intervals by resampling).
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import pandas as pd

from morphing_wing.errors import InputError

from .designs import problem
from .factors import Factor

__all__ = ["sobol_indices"]

_SEED = 1


def sobol_indices(
    factors: Sequence[Factor], values: Sequence[float], second_order: bool = False
) -> tuple[pd.DataFrame, int]:
    """Return first-order and total indices, and those of pairs, with their confidence.

    Parameters
    ----------
    factors
        As the design "sobol" had them.
    values
        Of all its cases in order. A block of cases with one that is not a number is left out:
        indices compare the cases of a block. What is left no longer fills the space evenly.
    second_order
        As the design had it.

    Returns
    -------
    DataFrame
        ``factor`` (of a pair ``a x b``), ``S1``, ``S1_conf``, ``ST``, ``ST_conf``, ``S2``,
        ``S2_conf``; the ``..._conf`` are half-widths of 95 % confidence intervals.
    int
        Number of blocks left out.

    Raises
    ------
    InputError
        If fewer than two blocks are left, or all values are the same.
    """
    from SALib.analyze import sobol

    size = (2 if second_order else 1) * len(factors) + 2
    blocks = np.asarray(values, dtype=float).reshape(-1, size)
    whole = blocks[np.isfinite(blocks).all(axis=1)]
    if len(whole) < 2:
        raise InputError(f"Sobol' indices: {len(whole)} of {len(blocks)} blocks of {size} cases "
                         "are without bad cases, must be 2 or more")
    if np.ptp(whole) == 0.0:
        raise InputError("Sobol' indices: all cases have the same value, must vary")
    found = sobol.analyze(problem(factors), whole.ravel(), calc_second_order=second_order,
                          seed=_SEED, print_to_console=False)
    names = [factor.column for factor in factors]
    rows = [{"factor": name, **{key: float(found[key][i]) for key in
                                ("S1", "S1_conf", "ST", "ST_conf")}}
            for i, name in enumerate(names)]
    if second_order:
        rows += [{"factor": f"{names[i]} x {names[j]}", "S2": float(found["S2"][i, j]),
                  "S2_conf": float(found["S2_conf"][i, j])}
                 for i in range(len(names)) for j in range(i + 1, len(names))]
    return pd.DataFrame(rows), len(blocks) - len(whole)
