"""One line a converged step, as it happens: on rank 0, coloured where there is a terminal."""

from __future__ import annotations

import time
from collections.abc import Mapping
from typing import TYPE_CHECKING, Any, TextIO

if TYPE_CHECKING:
    from rich.console import Console

    from morphing_wing.path import State

__all__ = ["Progress", "announced"]

# Column of a load -> (factor to the printed unit, heading). Only those that a scene has appear.
_LOADS = {
    "upper_MPa": (1000.0, "upper kPa"), "lower_MPa": (1000.0, "lower kPa"),
    "upper_mm3": (1.0, "upper mm^3"), "lower_mm3": (1.0, "lower mm^3"),
    "cable_N": (1.0, "cable N"), "torque_Nmm": (1.0, "torque N mm"),
    "gravity_g": (1.0, "gravity g"),
}
_ANGLES = {"span_angle_deg": "phi_1 deg", "chord_angle_deg": "phi_2 deg"}
_WIDTH = 13


class Progress:
    """Prints a table line by line while a scene solves; pass it as ``on_step``.

    Parameters
    ----------
    comm
        Communicator of the scene: rank 0 prints, the others say nothing. None: this process prints.
    file
        Where to; standard output by default. Colours only if it is a terminal.

    Examples
    --------
    >>> progress = Progress(spar.comm)                                       # doctest: +SKIP
    >>> spar.inflate(upper=[0.01, 0.02], on_step=progress, on_cut=progress.cut)  # doctest: +SKIP
    """

    def __init__(self, comm: Any = None, file: TextIO | None = None) -> None:
        self._console = None if comm is not None and comm.rank != 0 else _console(file)
        self._columns: tuple[str, ...] | None = None
        self._start = time.perf_counter()
        self.steps = 0

    def __call__(self, state: State) -> None:
        """Print the line of a converged step, under a heading where its columns are new."""
        self.steps += 1
        if self._console is None:
            return
        columns = tuple(
            name for name in (*_LOADS, *_ANGLES) if name in state.load or name in state.measures)
        if columns != self._columns:
            self._columns = columns
            headings = [_LOADS[c][1] if c in _LOADS else _ANGLES[c] for c in columns]
            self._print(_row("step", [*headings, "iterations", "energy N mm", "neg. piv.", "s"]),
                        "bold")
        found = state.measures | state.load  # filled chambers' pressures are measured
        values = [f"{found[c] * _LOADS[c][0]:.5g}" if c in _LOADS else f"{found[c]:z.3f}"
                  for c in columns]
        values += [f"{state.newton_iterations}", f"{state.energy_Nmm:.5g}",
                   f"{state.negative_pivots}", f"{state.step_seconds:.1f}"]
        mark = "" if state.requested else "  in between"
        if state.contact:
            mark += "  skin passes through itself or a rib"
        self._print(_row(f"{self.steps}", values) + mark, self._style(state))

    def cut(self, load: Mapping[str, float], reason: str) -> None:
        """Print that a step to ``load`` failed and is tried again in smaller steps."""
        if self._console is None:
            return
        text = ", ".join(
            f"{_LOADS[n][1].replace(' ', ' = ' + format(v * _LOADS[n][0], '.5g') + ' ', 1)}"
            for n, v in load.items() if n in _LOADS and v != 0.0)
        self._print(f"      smaller step: {text or 'no load'}: {reason}", "yellow")

    def end(self, converged: bool, reason: str) -> None:
        """Print how the path ended, after how many steps and seconds."""
        if self._console is None:
            return
        seconds = time.perf_counter() - self._start
        state = "done" if converged else "stopped"
        self._print(f"{state} after {self.steps} steps, {seconds:.1f} s: {reason}",
                    "green" if converged else "red")

    def say(self, text: str) -> None:
        """Print a text as it is."""
        if self._console is not None:
            self._print(text, "")

    @staticmethod
    def _style(state: State) -> str:
        if state.negative_pivots or state.contact:
            return "magenta"
        return "" if state.requested else "bright_black"

    def _print(self, text: str, style: str) -> None:
        self._console.print(text, style=style or None, markup=False, highlight=False)
        self._console.file.flush()


def announced(curve: object, scene: Any) -> Progress:
    """Print which of a study's curves begins, and return what prints its steps."""
    progress = Progress(scene.comm)
    progress.say(f"\n{curve}: {scene.dofs:,} unknowns on {scene.comm.size} rank(s)")
    return progress


def _console(file: TextIO | None) -> Console:
    from rich.console import Console

    return Console(file=file, soft_wrap=True)  # one step, one line, in a file too


def _row(first: str, values: list[str]) -> str:
    return f"{first:>5}" + "".join(f"{value:>{_WIDTH}}" for value in values)
