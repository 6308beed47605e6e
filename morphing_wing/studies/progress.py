"""How far a study is: a bar with the time left on a terminal, else a line now and then."""

from __future__ import annotations

import time
from collections.abc import Mapping, Sequence
from types import TracebackType
from typing import Any

from rich.console import Console
from rich.progress import BarColumn, Progress, TextColumn, TimeElapsedColumn

__all__ = ["StudyProgress"]

_LINES = 20
"""Lines that a whole study prints where there is no terminal."""


class StudyProgress:
    """Call it with how many cases are done, how many there are, and the last one's row.

    Parameters
    ----------
    console
        Where to.
    size
        How many cases there are.
    outputs
        The first one's value is told.
    bar
        Whether a terminal may show a bar; mpirun makes a terminal of everything.

    Examples
    --------
    >>> with StudyProgress(console(), size, study.outputs) as progress:   # doctest: +SKIP
    ...     study.run(workers=2, told=progress)
    """

    def __init__(
        self, console: Console, size: int, outputs: Sequence[str], bar: bool = True
    ) -> None:
        self._console, self._output = console, outputs[0]
        self._lines = not (bar and console.is_terminal)
        self._begin = time.perf_counter()
        self._first: int | None = None
        self._told = 0
        self._bar = Progress(
            BarColumn(), TextColumn("{task.completed}/{task.total} cases"), TimeElapsedColumn(),
            TextColumn("{task.description}"), console=console,
            disable=self._lines)
        self._task = self._bar.add_task("", total=size)

    def __enter__(self) -> StudyProgress:
        """Show the bar."""
        self._bar.start()
        return self

    def __exit__(
        self, kind: type[BaseException] | None, problem: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        """Leave the bar as it is."""
        self._bar.stop()

    def __call__(self, done: int, size: int, row: Mapping[str, Any]) -> None:
        """Tell of a case that has ended."""
        if self._first is None:
            self._first = done - 1  # were done by an earlier run
        spent = time.perf_counter() - self._begin
        left = spent * (size - done) / (done - self._first)
        bad = row["refused"] or row["stopped"]
        found = bad or f"{self._output} = {row[self._output]:.5g}"
        words = f"{in_words(left)} left" if done < size else f"done in {in_words(spent)}"
        self._bar.update(self._task, completed=done,
                         description=f"{words}; {found[:60]}")
        part = done * _LINES // size
        if self._lines and (part > self._told or bad):
            self._told = part
            self._console.print(f"{done} of {size} cases, {words}: {found}", highlight=False,
                                markup=False, soft_wrap=True)
            self._console.file.flush()


def in_words(seconds: float) -> str:
    """Return a time as one says it.

    Examples
    --------
    >>> in_words(8.26), in_words(100), in_words(5400)
    ('8.3 s', '1 min 40 s', '1 h 30 min')
    """
    if seconds < 59.95:
        return f"{seconds:.2g} s" if seconds < 9.95 else f"{seconds:.0f} s"
    whole = round(seconds)
    if whole < 3600:
        return f"{whole // 60} min {whole % 60} s"
    return f"{whole // 3600} h {whole % 3600 // 60} min"
