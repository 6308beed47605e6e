"""Which tensions a cable may have: it pulls, and it pulls at a rib."""

from __future__ import annotations

import math
from collections.abc import Sequence
from numbers import Real

import numpy as np

from .errors import require


def check_tension(cable: float | Sequence[float] | None, ribs: bool = True) -> None:
    """Refuse tensions that no cable of the scene can have.

    What is no finite number is left to the check that all loads go through.

    Parameters
    ----------
    cable
        Tension in N: a number, a sequence of them, or None.
    ribs
        Whether there is a rib for a cable to pull at.

    Raises
    ------
    InputError
        If a tension is negative, or is not zero where there are no ribs.
    """
    given = np.asarray([] if cable is None else cable, dtype=object).ravel()
    tensions = [t for t in given if isinstance(t, Real) and math.isfinite(t)]
    lowest, highest = min(tensions, default=0.0), max(tensions, default=0.0)
    require(not lowest < 0.0, "cable", lowest, "N", "0 N or more: cables only pull")
    require(ribs or not highest > 0.0, "cable", highest, "N",
            "0 N or left out in a wing without ribs, at whose tails cables pull")
