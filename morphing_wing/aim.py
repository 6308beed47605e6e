"""How far angles are from the wanted ones, and the change of the loads that brings them nearest."""

from __future__ import annotations

import dataclasses
from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np
from scipy.optimize import lsq_linear

from .path import State
from .sensitivity import sensitivities
from .steering import Steering

if TYPE_CHECKING:
    from .scene import Scene

__all__ = ["ANGLES", "Aim", "errors"]

ANGLES = ("span_angle_deg", "chord_angle_deg")


@dataclasses.dataclass(frozen=True, eq=False)
class Aim:
    """A state, how far its angles are from the wanted ones, and where to go from it.

    Attributes
    ----------
    state
        The state.
    steerings
        The k wanted angles and what steers them.
    numbers : (k,) array
        The loads of the state, see `Steering`.
    errors : (k,) array
        Wanted minus present angles in degrees.
    rates
        Derivatives of all angles by the k loads, see `sensitivities`.
    """

    state: State
    steerings: Sequence[Steering]
    numbers: np.ndarray
    errors: np.ndarray
    rates: dict[str, dict[str, float]]

    @classmethod
    def of(cls, scene: Scene, steerings: Sequence[Steering], state: State) -> Aim:
        """Return the aim from the scene's present state. Collective."""
        numbers = np.array([s.number(state.load) for s in steerings])
        active = [s.active(n)[0] for s, n in zip(steerings, numbers, strict=True)]
        return cls(state, steerings, numbers, errors(scene, steerings, state),
                   sensitivities(scene, active))

    @property
    def error(self) -> float:
        """The largest error in degrees."""
        return float(np.abs(self.errors).max())

    @property
    def distance(self) -> float:
        """The norm of the errors in degrees."""
        return float(np.linalg.norm(self.errors))

    def change(self, radius: float) -> tuple[np.ndarray, np.ndarray]:
        """Return the best change of the numbers, and of the angles in degrees by it."""
        slopes = self._slopes()
        if not np.isfinite(slopes).all():
            return np.zeros_like(self.numbers), np.zeros_like(self.errors)
        lowest, limit = (np.array([getattr(s, n) for s in self.steerings])
                         for n in ("lowest", "limit"))
        # Where an angle saturates, a small change of it takes a large one of the load.
        longest = np.maximum(np.abs(self.numbers), 0.25 * limit)
        bounds = (np.maximum(lowest - self.numbers, -longest),
                  np.minimum(limit - self.numbers, longest))
        aim = self.errors * min(1.0, radius / self.distance)
        # In parts of the limits: MPa and N differ by orders of magnitude.
        found = lsq_linear(slopes * limit, aim, (bounds[0] / limit, bounds[1] / limit), "bvls")
        change = np.clip(found.x * limit, *bounds)
        return change, slopes @ change

    def held(self) -> str:
        """Return in words what keeps the angles from coming nearer."""
        if not np.isfinite(self._slopes()).all():
            return "the tangent could not be factorised"
        limits = [s.at_limit(n) for s, n in zip(self.steerings, self.numbers, strict=True)]
        return " and ".join(filter(None, limits)) or "no change of the loads brings it nearer"

    def words(self) -> str:
        """Return the angles beside the wanted ones."""
        found = (f"{s.angle.split('_')[0]} = {self.state.measures[s.angle]:.4g} of "
                 f"{s.wanted:.4g} deg" for s in self.steerings)
        return f"{', '.join(found)} is the nearest"

    def table(self) -> np.ndarray:
        """Return d(span, chord)/d(pressure, cable) in degrees per kPa and per N."""
        found = np.full((2, 2), np.nan)
        for load, rates in self.rates.items():
            column, factor = (0, 1e-3) if load.endswith("_MPa") else (1, 1.0)
            found[:, column] = [factor * rates.get(name, np.nan) for name in ANGLES]
        return found

    def _slopes(self) -> np.ndarray:
        """Return the derivatives of the steered angles by the numbers."""
        active = [s.active(n) for s, n in zip(self.steerings, self.numbers, strict=True)]
        return np.array([[sign * self.rates[load][s.angle] for load, sign in active]
                         for s in self.steerings])


def errors(scene: Scene, steerings: Sequence[Steering], state: State) -> np.ndarray:
    """Return wanted minus present angles in degrees, the same bits on all ranks."""
    return scene.comm.bcast(np.array([s.wanted - state.measures[s.angle] for s in steerings]))
