"""How far angles are from the wanted ones, and the change of the loads that brings them nearest."""

from __future__ import annotations

import dataclasses
from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from .path import State
from .sensitivity import sensitivities
from .steering import Steering

if TYPE_CHECKING:
    from .scene import Scene

__all__ = ["ANGLES", "Aim"]

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
        errors = np.array([s.wanted - state.measures[s.angle] for s in steerings])
        # The same bits on all ranks, which all take the same way then.
        return cls(state, steerings, numbers, scene.comm.bcast(errors),
                   sensitivities(scene, active))

    @property
    def error(self) -> float:
        """The largest error in degrees."""
        return float(np.abs(self.errors).max())

    @property
    def distance(self) -> float:
        """The norm of the errors in degrees."""
        return float(np.linalg.norm(self.errors))

    @property
    def merit(self) -> float:
        """The norm in degrees of those errors that no limit of their own load excuses."""
        return float(np.linalg.norm(self._open(self.errors, self.numbers)))

    @property
    def slack(self) -> np.ndarray:
        """Which loads that only pull one way do not pull at all, and leave an error, as a mask."""
        one_way = np.array([s.opposite is None for s in self.steerings])
        return one_way & (self.numbers == 0.0) & (self.errors != 0.0)

    def change(self, radius: float) -> tuple[np.ndarray, float]:
        """Return a change of the numbers, and the merit that it promises.

        Each angle changes by ``radius`` degrees at most. A load that meets its limit stays there
        and its angle is given up: the others are still met, and not traded for it.
        """
        change = np.zeros_like(self.numbers)
        slopes = self._slopes()
        if not np.isfinite(slopes).all():
            return change, self.merit
        lowest, highest = self._limits()
        # Where an angle saturates, a small change of it takes a large one of the load.
        longest = np.maximum(np.abs(self.numbers), 0.25 * highest)
        low = np.maximum(lowest - self.numbers, -longest)
        high = np.minimum(highest - self.numbers, longest)
        aimed = np.clip(self.errors, -radius, radius)
        free = np.ones(len(change), dtype=bool)
        while free.any():
            left = aimed[free] - slopes[np.ix_(free, ~free)] @ change[~free]
            change[free] = np.linalg.lstsq(slopes[np.ix_(free, free)], left, rcond=None)[0]
            inside = np.clip(change, low, high)
            beyond = np.where(free, np.abs(change - inside) / highest, 0.0)
            worst = int(np.argmax(beyond))
            if beyond[worst] == 0.0:
                break
            change[worst], free[worst] = inside[worst], False
        promised = self._open(self.errors - slopes @ change, self.numbers + change)
        return change, float(np.linalg.norm(promised))

    def held(self) -> str:
        """Return in words what keeps the angles from coming nearer."""
        if not np.isfinite(self._slopes()).all():
            return "the tangent could not be factorised"
        excused = self._open(self.errors, self.numbers) != self.errors
        limits = [s.at_limit(number) for s, number, there in
                  zip(self.steerings, self.numbers, excused, strict=True) if there]
        return " and ".join(limits) or "no change of the loads brings it nearer"

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

    def _limits(self) -> tuple[np.ndarray, np.ndarray]:
        return (np.array([s.lowest for s in self.steerings]),
                np.array([s.limit for s in self.steerings]))

    def _open(self, errors: np.ndarray, numbers: np.ndarray) -> np.ndarray:
        """Return the errors, zero where only a load beyond its limit would make them smaller."""
        lowest, highest = self._limits()
        more = errors * np.sign(np.diag(self._slopes()))
        near = 1e-9 * highest
        excused = ((numbers >= highest - near) & (more > 0.0)) | (
            (numbers <= lowest + near) & (more < 0.0))
        return np.where(excused, 0.0, errors)
