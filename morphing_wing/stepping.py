"""Load stepping that adapts: from one wanted load to the next, in as few steps as Newton allows."""

from __future__ import annotations

import time
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import Protocol

import numpy as np

from .newton import NewtonResult
from .path import State
from .targets import load_words

Load = Mapping[str, float]

REACHED = "the last load was reached"


@dataclass(frozen=True)
class Stepping:
    """How load steps are chosen.

    Attributes
    ----------
    smallest
        Smallest step, as a part of the way between two wanted loads, before giving up.
    easy
        Up to this number of Newton iterations the next step is twice as long.
    largest
        Largest change of each named load in one step; loads without an entry are free.
    """

    smallest: float = 1.0 / 512
    easy: int = 8
    largest: Mapping[str, float] | None = None


class Steppable(Protocol):
    """What a scene offers to be led along a path."""

    def set_load(self, load: Load) -> None:
        """Set all loads."""

    def solve(self) -> NewtonResult:
        """Find the equilibrium from the present state."""

    def unknowns(self) -> list[np.ndarray]:
        """Return copies of the rank-local values of all functions."""

    def set_unknowns(self, values: Sequence[np.ndarray]) -> None:
        """Set the rank-local values of all functions."""

    def accept(self) -> None:
        """Take the present state as converged."""

    def state(self, load: Load, result: NewtonResult, seconds: float, requested: bool) -> State:
        """Measure the present state."""


@dataclass(frozen=True)
class Standing:
    """Where the stepping stands after a converged step: all that it needs to go on from there.

    Attributes
    ----------
    load
        The load of the last state.
    reached
        Number of wanted loads reached.
    begin, target
        The loads between which it is under way.
    done, step
        Part of this way that is done, and the next step.
    """

    load: Load
    reached: int
    begin: Load
    target: Load
    done: float
    step: float


def follow(
    scene: Steppable,
    start: Load,
    targets: Sequence[Load],
    stepping: Stepping,
    on_step: Callable[[State], None] | None = None,
    on_cut: Callable[[Load, str], None] | None = None,
    keep: Callable[[Standing, list[State]], None] | None = None,
    standing: Standing | None = None,
) -> tuple[list[State], bool, str]:
    """Lead a scene from its present equilibrium at ``start`` through all targets.

    Parameters
    ----------
    scene, start, targets, stepping
        What is led, from which load, to which loads, and how.
    on_step, on_cut
        Called after each converged step, and after each step that was cut.
    keep
        Called before ``on_step`` with where it stands, and the states of this call so far.
    standing
        What ``keep`` was given after the step that led to ``start``: goes on from there, past
        those of the targets that were reached.

    Returns
    -------
    states
        Every converged state, those between two targets too.
    converged
        Whether the last target was reached.
    reason
        Why and where it ended.
    """
    states: list[State] = []
    here = dict(start)
    for number, target in enumerate(targets):
        if standing is not None and number < standing.reached:
            continue
        begin, done, step = dict(here), 0.0, 1.0
        if standing is not None and standing.target == target and number == standing.reached:
            begin, done, step = dict(standing.begin), standing.done, standing.step
        way = {name: target[name] - begin[name] for name in target}
        limit = _longest(way, stepping)
        step = min(step, limit)
        while done < 1.0:
            step = min(step, 1.0 - done)
            load = dict(target) if done + step > 1.0 - 1e-9 else {
                name: begin[name] + (done + step) * way[name] for name in way
            }
            clock = time.perf_counter()
            last = scene.unknowns()
            scene.set_load(load)
            result = scene.solve()
            if not result.converged:
                scene.set_unknowns(last)
                scene.set_load(here)
                if step / 2 < stepping.smallest:
                    return states, False, f"stopped after {load_words(here)}: {result.reason}"
                if on_cut is not None:
                    on_cut(load, result.reason)
                step /= 2
                continue
            scene.accept()
            done += step
            here = load
            requested = done > 1.0 - 1e-9
            done = 1.0 if requested else done
            state = scene.state(load, result, time.perf_counter() - clock, requested)
            states.append(state)
            if result.iterations <= stepping.easy:
                step = min(2 * step, limit)
            if keep is not None:
                keep(Standing(here, number + requested, begin, target, done, step), states)
            if on_step is not None:
                on_step(state)
    return states, True, REACHED


def _longest(way: Load, stepping: Stepping) -> float:
    limits = stepping.largest or {}
    parts = [limits[name] / abs(change) for name, change in way.items()
             if name in limits and change != 0.0]
    return min([1.0, *parts])
