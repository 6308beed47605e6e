"""What ends the use of a wing: torn rubber, yielding resin; measured beside a path's angles."""

from __future__ import annotations

from typing import Any

from .beam_stress import BeamStress
from .fields import scene_grids
from .path import Path, State
from .progress import Progress
from .wing import Wing

__all__ = ["Limits", "actuated"]


class Limits:
    """Adds ``largest_stretch`` and ``rib_stress_MPa`` to the measures of each state.

    The first is the largest principal stretch at the elastomer's nodes, which at the chambers'
    re-entrant corners grows as the mesh is refined; the second, von Mises' stress in the ribs'
    bars, is there where the wing has ribs.

    Parameters
    ----------
    wing
        The wing; call the object with each of its states while it is the present one, as
        ``on_step`` does. Collective.

    Examples
    --------
    >>> path = wing.actuate(cable=0.1, on_step=Limits(wing))        # doctest: +SKIP
    >>> path[-1].measures["rib_stress_MPa"]                         # doctest: +SKIP
    """

    def __init__(self, wing: Wing) -> None:
        self._wing = wing
        self._stress = BeamStress(wing.ribs, wing.resin) if wing.ribs is not None else None

    def __call__(self, state: State) -> None:
        """Measure the present state."""
        grid: Any = scene_grids(self._wing, state)["elastomer"]
        stretch = None if grid is None else float(grid.point_data["stretch"].max())
        state.measures["largest_stretch"] = self._wing.comm.bcast(stretch)
        if self._stress is not None:
            state.measures["rib_stress_MPa"] = self._stress.largest()


def actuated(
    wing: Wing, progress: Progress | None, keep_fields: bool = True, **loads: Any
) -> Path:
    """Return the path of `Wing.actuate` with its limits measured and its steps told.

    Parameters
    ----------
    wing, loads
        The wing, and what it is actuated by.
    progress
        Told of each step, of each one that was cut, and of the end; or None.
    keep_fields
        Whether states keep their fields.
    """
    limits = Limits(wing)

    def on_step(state: State) -> None:
        limits(state)
        if not keep_fields:
            state.fields = {}
        if progress:
            progress(state)

    path = wing.actuate(**loads, on_step=on_step, on_cut=progress.cut if progress else None)
    if progress:
        progress.end(path.converged, path.reason)
    return path
