"""What loads contribute to the residual: the force that a solution's tolerance is relative to."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from .system import EquilibriumSystem

__all__ = ["load_force"]


def load_force(system: EquilibriumSystem, loads: Mapping[str, Sequence[Any]]) -> float:
    """Return the norm in N of the residual's change if all loads are taken off. Collective.

    Parameters
    ----------
    system
        The equations; the functions keep the present state.
    loads
        Of each load by name the constants that carry it, as they are now.
    """
    x, with_loads, without = (system.x.duplicate() for _ in range(3))
    system.push(x)
    system.residual(x, with_loads)
    constants = [constant for carriers in loads.values() for constant in carriers]
    values = [float(constant.value) for constant in constants]
    for constant in constants:
        constant.value = 0.0
    system.residual(x, without)
    for constant, value in zip(constants, values, strict=True):
        constant.value = value
    without.axpy(-1.0, with_loads)
    force = without.norm()
    for vector in (x, with_loads, without):
        vector.destroy()
    return force if np.isfinite(force) else 0.0
