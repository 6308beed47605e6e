"""The paper's Figure 7 as a study: phi_1 against pressure (B-1), phi_2 against the cables (B-2).

The paper's own curves are not at hand; what its text says of them stands in `figure7_picture`.
"""

from __future__ import annotations

import gc
from collections.abc import Callable, Iterator, Sequence
from typing import Any

import numpy as np
from mpi4py import MPI

from .errors import InputError, require
from .figure7_facts import PANELS
from .figure7_result import Curve, Figure7
from .geometry.wing import WingGeometry
from .ladder import LADDERS
from .limits import actuated
from .path import Path
from .progress import Progress
from .record import without_fields
from .wing import Wing

__all__ = ["PRESSURES", "TENSIONS", "figure7"]

PRESSURES = tuple(np.linspace(0.0, 0.040, 9))  # MPa
TENSIONS = tuple(np.linspace(0.0, 0.5, 9))  # N in each cable
DIRECTIONS = ("down", "up")


def figure7(
    fidelities: Sequence[str] = ("draft",),
    pressures: Sequence[float] = PRESSURES,
    tensions: Sequence[float] = TENSIONS,
    skins: Sequence[bool] = (True, False),
    directions: Sequence[str] = ("down",),
    geometry: WingGeometry | None = None,
    panels: Sequence[str] = tuple(PANELS),
    comm: MPI.Comm | None = None,
    begin: Callable[[Curve, Wing], Progress] | None = None,
    done: Callable[[Figure7, Curve, Path], None] | None = None,
    **wing: Any,
) -> Figure7:
    """Run the curves of Figure 7, each with a wing of its own from rest.

    Parameters
    ----------
    fidelities
        Rungs of the wing's ladder, see `Wing`.
    pressures, tensions
        Loads of the two panels: MPa in one row of chambers, N in each cable.
    skins
        With skin, without, or both.
    directions
        "down": upper chambers and cables as the geometry has them; "up": lower chambers and
        cables guided to the other side, (dx, -dy, dz).
    geometry
        The paper's prototype by default.
    panels
        "pressure", "cables" or both.
    comm
        Communicator; all ranks of MPI by default.
    begin
        Called before each curve; returns what is told of its steps, a `Progress`.
    done
        Called after each curve with the study so far and the path with all its fields, which are
        let go of afterwards.
    wing
        Further keyword arguments of `Wing`.
    """
    geometry = WingGeometry.prototype() if geometry is None else geometry
    rungs = LADDERS["wing"]
    for name in fidelities:
        require(name in rungs, "fidelity", name, "", f"one of {', '.join(rungs)}")
    for panel in panels:
        require(panel in PANELS, "panel", panel, "", "pressure or cables")
    for direction in directions:
        require(direction in DIRECTIONS, "direction", direction, "", "down or up")
    if geometry.rib is None:
        raise InputError("rib = None: must be a rib, at whose tail cables pull")
    if True in skins and geometry.skin_thickness is None:
        raise InputError("skin_thickness = None: must be a length for curves with skin")
    study = Figure7(comm or MPI.COMM_WORLD)
    loads = {"pressure": tuple(pressures), "cables": tuple(tensions)}
    for curve in _curves(fidelities, skins, panels, directions):
        path = _run(curve, loads[curve.panel], geometry, study.comm, begin, wing)
        study.paths[curve] = without_fields(path)
        if done is not None:
            done(study, curve, path)
        del path
        gc.collect()  # at one point on all ranks: a wing's matrices and factors go together
    return study


def _curves(
    fidelities: Sequence[str], skins: Sequence[bool], panels: Sequence[str],
    directions: Sequence[str],
) -> Iterator[Curve]:
    for fidelity in dict.fromkeys(fidelities):
        for skin in dict.fromkeys(map(bool, skins)):
            for panel in dict.fromkeys(panels):
                for direction in dict.fromkeys(directions):
                    yield Curve(panel, skin, direction, fidelity)


def _run(
    curve: Curve, loads: Sequence[float], geometry: WingGeometry, comm: MPI.Comm,
    begin: Callable[[Curve, Wing], Progress] | None, keywords: dict[str, Any],
) -> Path:
    """Return one curve's path."""
    scene = Wing(curve.shape(geometry), fidelity=curve.fidelity, comm=comm, **keywords)
    return actuated(scene, begin and begin(curve, scene), **curve.loads(loads))
