"""Seconds that a scene spends in assembly and in factorising, and the peak of memory."""

from __future__ import annotations

import contextlib
import ctypes
import resource
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

from mpi4py import MPI

from .newton import Newton
from .scene import Scene

__all__ = ["Stopwatch", "forget_peak", "peak_MB"]


class Stopwatch:
    """Adds up the seconds that a scene spends in assembly, and in factorising and solving.

    Parameters
    ----------
    scene
        Before its first solve.

    Attributes
    ----------
    seconds
        By "assembly" and "factor".
    """

    def __init__(self, scene: Scene) -> None:
        self.seconds = {"assembly": 0.0, "factor": 0.0}
        if scene.dofs == 0:  # a formula
            return
        for name in ("residual", "tangent"):
            self._watch(scene.system, name, "assembly")
        make = scene._newton

        def newton() -> Newton:  # made with the first load
            solver = make()
            for name in ("setUp", "apply"):
                self._watch(solver.factor, name, "factor")
            return solver

        scene._newton = newton  # type: ignore[method-assign]

    def _watch(self, owner: Any, name: str, part: str) -> None:
        inner: Callable[..., Any] = getattr(owner, name)

        def timed(*arguments: Any) -> Any:
            clock = time.perf_counter()
            try:
                return inner(*arguments)
            finally:
                self.seconds[part] += time.perf_counter() - clock

        setattr(owner, name, timed)


def forget_peak() -> None:
    """Let the peak of this process's memory count from now on, where that is possible (Linux)."""
    with contextlib.suppress(OSError, AttributeError):
        ctypes.CDLL(None).malloc_trim(0)  # what was freed goes back first
        Path("/proc/self/clear_refs").write_text("5")


def peak_MB(comm: MPI.Comm) -> float:
    """Return the peak of memory in MB since it was last forgotten, summed over the ranks."""
    try:
        status = Path("/proc/self/status").read_text()
        peak = next(line for line in status.splitlines() if line.startswith("VmHWM")).split()[1]
    except OSError:  # elsewhere than on Linux: since the process began
        peak = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
    return comm.allreduce(int(peak) / 1024)
