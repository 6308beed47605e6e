"""A way of several legs, each led where the one before has shown: one list of states, one file."""

from __future__ import annotations

import os
import time
from collections.abc import Callable, Mapping
from typing import TYPE_CHECKING

from . import restart as restart_files
from .errors import InputError
from .path import Path, State
from .stepping import Standing

if TYPE_CHECKING:
    from .scene import Scene

__all__ = ["Way"]


class Way:
    """The states so far, and how the next are reached. All of it is collective.

    Parameters
    ----------
    scene
        What is led.
    on_step, on_cut, restart
        See `Scene.follow`.

    Attributes
    ----------
    states
        All converged states.
    reason
        Why the last leg ended.
    """

    def __init__(
        self,
        scene: Scene,
        on_step: Callable[[State], None] | None,
        on_cut: Callable[[Mapping[str, float], str], None] | None,
        restart: str | os.PathLike | None,
    ) -> None:
        self._scene, self._on_step, self._on_cut, self._restart = scene, on_step, on_cut, restart
        self._begin = time.perf_counter()
        self.states: list[State] = []
        self.reason = ""

    def lead(self, load: Mapping[str, float]) -> bool:
        """Lead the scene to a load unless it stands there; return whether it was reached."""
        if self.states and load == self.states[-1].load:
            return True
        path = self._scene.follow(load, on_step=self._keep, on_cut=self._on_cut)
        self.reason = path.reason
        return path.converged

    def take_up(self, resume: str | os.PathLike) -> None:
        """Go on from a restart file."""
        states = restart_files.read(resume, self._scene).states
        wanted = [state.load for state in states if state.requested]
        if not wanted:
            raise InputError(f"{restart_files.restart_file(resume)}: must be of a trim")
        path = self._scene.follow(
            {name: [load[name] for load in wanted] for name in wanted[0]}, resume=resume)
        self.states = list(path)
        self._begin -= path.seconds

    def path(self, converged: bool, reason: str) -> Path:
        """Return all of it."""
        return Path(self.states, self._scene, converged, reason, self._seconds())

    def _keep(self, state: State) -> None:
        self.states.append(state)
        if self._restart is not None:
            # The next load is Newton's to choose again: the stepping stands at the end of its way.
            reached = sum(state.requested for state in self.states)
            standing = Standing(state.load, reached, state.load, state.load, 1.0, 1.0)
            restart_files.write(
                self._restart, self._scene, self.states, standing, self._seconds())
        if self._on_step is not None:
            self._on_step(state)

    def _seconds(self) -> float:
        return time.perf_counter() - self._begin
