"""Trim: the loads at which a wing has wanted angles, by Newton's method over its equilibria."""

from __future__ import annotations

import dataclasses
import os
from collections.abc import Callable, Mapping, Sequence
from typing import TYPE_CHECKING

import numpy as np

from .aim import ANGLES, Aim
from .path import Path, State
from .steering import Steering
from .way import Way

if TYPE_CHECKING:
    from .scene import Scene

__all__ = ["Trim", "trim"]

FIRST_RADIUS, LARGEST_RADIUS = 10.0, 90.0
"""Change in degrees that a step aims at, at most: the angles saturate."""

PROBE = 0.02
"""Part of its limit at which a load that did not pull is tried."""


@dataclasses.dataclass(frozen=True, eq=False)
class Trim:
    """What a trim found.

    Attributes
    ----------
    loads
        All loads of the nearest state: ``upper_MPa``, ``lower_MPa``, ``cable_N``.
    angles
        Its ``span_angle_deg`` and ``chord_angle_deg``, as far as the wing has them.
    path
        All converged states on the way; the last is the nearest, in which the wing stands.
    iterations
        How many loads were tried.
    converged
        Whether all wanted angles are within the tolerance.
    reason
        One sentence: why it ended.
    sensitivities : (2, 2) array
        Of the nearest state, d(span, chord)/d(pressure, cable) in degrees per kPa in the row of
        chambers in use and degrees per N; not a number for a load that was left alone.
    """

    loads: dict[str, float]
    angles: dict[str, float]
    path: Path
    iterations: int
    converged: bool
    reason: str
    sensitivities: np.ndarray


def trim(
    scene: Scene,
    steerings: Sequence[Steering],
    start: Mapping[str, float],
    tolerance: float,
    max_iterations: int,
    on_step: Callable[[State], None] | None = None,
    on_cut: Callable[[Mapping[str, float], str], None] | None = None,
    restart: str | os.PathLike | None = None,
    resume: str | os.PathLike | None = None,
) -> Trim:
    """Lead a scene to the loads at which angles are as wanted.

    Each iteration solves for the change of the loads, within their limits and a trust region, by
    the sensitivities of the nearest state so far, and leads the scene there. A change that brings
    the angles no nearer shrinks the region. Where that fails, it begins once more without loads,
    and from a small tension where cables are slack. Collective.

    Parameters
    ----------
    scene, start
        What is led, and the loads at which it stands.
    steerings
        The wanted angles, and what steers each. All other loads stay.
    tolerance
        Largest error in degrees of each angle.
    max_iterations
        Loads that are tried at most.
    on_step, on_cut, restart, resume
        See `Wing.trim`.
    """
    way = Way(scene, on_step, on_cut, restart)
    if resume is None:
        way.lead(start)
    else:
        way.take_up(resume)
    if not way.states:
        return Trim(dict(start), {}, way.path(False, way.reason), 0, False, way.reason,
                    np.full((2, 2), np.nan))
    idle = dict(way.states[-1].load)
    search = _Search(scene, steerings, idle, way, tolerance, max_iterations)
    first = np.array([s.number(idle) for s in steerings])
    nearest, cause = search.run(first)
    if cause and first.any() and search.tried < max_iterations:
        # Far out angles fall again with the load, and the way back looks like the way on.
        again, other = search.run(np.zeros_like(first))
        nearest, cause = min((nearest, cause), (again, other), key=lambda end: end[0].distance)
    if cause and nearest.slack.any() and search.tried < max_iterations:
        # The first newtons may turn an angle the other way than all that follow.
        pulled = np.array([PROBE * s.limit for s in steerings])
        again, other = search.run(np.where(nearest.slack, pulled, nearest.numbers))
        nearest, cause = min((nearest, cause), (again, other), key=lambda end: end[0].distance)
    end = nearest.state
    if cause and len(steerings) > 1:
        # What cannot be met is given up where it is, so that the other angle still can be.
        worst = int(np.argmax(np.abs(nearest.errors)))
        search.idle, search.steerings = end.load, [*steerings[:worst], *steerings[worst + 1 :]]
        end = search.run(np.delete(nearest.numbers, worst))[0].state
    if end is not nearest.state or end is not way.states[-1]:
        way.lead(end.load)
        nearest = Aim.of(scene, steerings, way.states[-1])
    converged = nearest.error <= tolerance
    reason = "the wanted angles were reached" if converged else f"{nearest.words()}: {cause}"
    return Trim(
        loads=dict(nearest.state.load),
        angles={name: value for name, value in nearest.state.measures.items() if name in ANGLES},
        path=way.path(converged, reason),
        iterations=search.tried,
        converged=converged,
        reason=reason,
        sensitivities=nearest.table(),
    )


@dataclasses.dataclass(eq=False)
class _Search:
    """Newton's method with a trust region in the angles."""

    scene: Scene
    steerings: Sequence[Steering]
    idle: Mapping[str, float]
    way: Way
    tolerance: float
    max_iterations: int
    tried: int = 0

    def run(self, numbers: np.ndarray) -> tuple[Aim, str]:
        """Search from some loads on; return the best aim and why it ended, empty if it is met."""
        led = self._lead(numbers)
        here, radius, slow, failed = self._aim(), FIRST_RADIUS, 0, 0 if led else 2
        while here.error > self.tolerance:
            change, promised = here.change(radius)
            least = max(1e-3 * min(here.merit, radius), 0.1 * self.tolerance)
            if here.merit <= self.tolerance or here.merit - promised <= least:
                return here, here.held()
            if failed == 2:
                return here, self.way.reason
            if slow == 4:
                return here, "no change of the loads brings it nearer"
            if self.tried == self.max_iterations:
                return here, f"max_iterations = {self.max_iterations} are used up"
            self.tried += 1
            led = self._lead(here.numbers + change)
            there = self._aim()
            kept = (here.merit - there.merit) / (here.merit - promised)
            slow = slow + 1 if here.merit - there.merit < 1e-3 * here.merit else 0
            failed += not led
            if not led or kept < 0.25:
                radius = 0.25 * min(radius, here.error)
            elif kept > 0.75:
                radius = min(2.0 * radius, LARGEST_RADIUS)
            if kept > 0.0:
                here = there
        return here, ""

    def _lead(self, numbers: np.ndarray) -> bool:
        load = dict(self.idle)
        for steering, number in zip(self.steerings, numbers, strict=True):
            load |= steering.loads(float(number))
        return self.way.lead(load)

    def _aim(self) -> Aim:
        return Aim.of(self.scene, self.steerings, self.way.states[-1])
