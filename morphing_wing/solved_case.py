"""One case of a study solved, and what happened to it as a row of the study's table."""

from __future__ import annotations

import gc
import time
from collections.abc import Callable, Mapping, Sequence
from typing import Any

import numpy as np

from .errors import InputError
from .path import Path
from .record import without_fields

__all__ = ["OUTCOME", "solved_case"]

OUTCOME = ("energy_Nmm", "dofs", "newton_iterations", "seconds", "refused", "stopped")
"""Columns of a row behind the angle."""


def solved_case(
    case: Mapping[str, str], angle: str, run: Callable[[Mapping[str, str]], Path],
    measures: Sequence[str] = (),
) -> dict[str, Any]:
    """Solve one case and return its row. Collective.

    Parameters
    ----------
    case
        Levels of the factors; other columns are kept as they are.
    angle
        Column of a scene's measures that is asked for.
    run
        Levels of the factors -> path to the load.
    measures
        Further columns of measures, where the scene has them.

    Returns
    -------
    dict
        The case, and behind it the angle and `OUTCOME`: ``refused`` says why the fidelity cannot
        model it, ``stopped`` why its path ended before the load; then the angle is missing.
    """
    row = {**case, angle: np.nan, "refused": "", "stopped": ""}
    begin = time.perf_counter()
    try:
        path = without_fields(run(case))
    except InputError as problem:
        row["refused"] = str(problem)
    else:
        row |= {"dofs": path.scene.dofs, "newton_iterations":
                sum(state.newton_iterations for state in path)}
        if path.converged:
            found = path[-1].measures
            row |= {angle: found[angle], "energy_Nmm": path[-1].energy_Nmm}
            row |= {name: found[name] for name in measures if name in found}
        else:
            row["stopped"] = path.reason
    if row.get("dofs") != 0:  # of a formula there is nothing to free, and collecting costs more
        gc.collect()  # at one point on all ranks: a scene's matrices and factors go together
    row["seconds"] = time.perf_counter() - begin
    return row
