"""One rung on one case, timed."""

from __future__ import annotations

import gc
import time
from collections.abc import Callable
from typing import Any

from mpi4py import MPI

from ..burial import bury
from ..path import Path
from ..scene import Scene
from ..stopwatch import Stopwatch, forget_peak, peak_MB

__all__ = ["row"]


def row(
    comm: MPI.Comm,
    case: dict[str, Any],
    build: Callable[[], Scene],
    lead: Callable[[Scene], Path],
    angle: str,
) -> tuple[dict[str, Any], Path]:
    """Build and solve a scene; return what it cost, without an error yet, and its path. Collective.

    Parameters
    ----------
    comm
        Of the scene.
    case
        What the row begins with: names and numbers of the case.
    build, lead
        Make the scene, and lead it to the load at which it is judged. Seconds count from before the
        first to after the second; compile the forms before, where that is not to count.
    angle
        Name of the measure by which it is judged, of the last state.

    Returns
    -------
    row
        ``case`` and "fidelity", "ranks", "dofs", "iterations", "assembly_s", "factor_s", "seconds",
        "peak_MB", "angle_deg" (nan where the load was not reached).
    path
        The path; its scene can be led on.
    """
    gc.collect()
    bury(comm)  # what PETSc held of the cases before
    forget_peak()
    clock = time.perf_counter()
    scene = build()
    watch = Stopwatch(scene)
    path = lead(scene)
    seconds = time.perf_counter() - clock
    return case | {
        "fidelity": scene.fidelity,
        "ranks": scene.comm.size,
        "dofs": scene.dofs,
        "iterations": sum(state.newton_iterations for state in path),
        "assembly_s": watch.seconds["assembly"],
        "factor_s": watch.seconds["factor"],
        "seconds": seconds,
        "peak_MB": peak_MB(scene.comm),
        "angle_deg": path[-1].measures[angle] if path.converged else float("nan"),
    }, path
