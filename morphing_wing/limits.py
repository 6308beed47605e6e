"""What ends the use of a scene: torn rubber, a law that gives way, yielding resin."""

from __future__ import annotations

import weakref
from typing import Any

import numpy as np

from .beam_stress import BeamStress
from .fields import scene_grids
from .frame import BeamFrame
from .path import Path, State
from .progress import Progress
from .resin_stress import ResinStress
from .scene import Scene
from .shaft_gap import ShaftGap
from .solid_ribs import SolidRibs
from .wing import Wing

__all__ = ["Limits", "actuated"]


class Limits:
    """Adds to the measures of each state what tells of the end of use.

    ``largest_stretch`` is the largest principal stretch at the elastomer's nodes, which at the
    chambers' re-entrant corners grows as the mesh is refined, and ``largest_stretch_x_mm``, ``y``,
    ``z`` where that is before the deformation. ``material_stability`` is the least of
    `Yeoh.stability` at the nodes: at 0 and below the material's law gives way. Where a skin is
    built in stretched, stretches count from there on and the law is not judged. ``rib_stress_MPa``,
    von Mises' stress in the resin, is there where a scene has ribs that are frames or solids, and
    ``shaft_gap_mm``, how far apart neighbouring shafts of a layer are. `passed.passed`
    says in words from which load on a limit is passed.

    Parameters
    ----------
    scene
        Put the object into the scene's ``watch``, or call it with each state while it is the
        present one, as ``on_step`` does. Collective.

    Examples
    --------
    >>> wing.watch.append(Limits(wing))                             # doctest: +SKIP
    >>> wing.actuate(cable=0.1)[-1].measures["rib_stress_MPa"]      # doctest: +SKIP
    """

    def __init__(self, scene: Scene) -> None:
        self._scene = weakref.proxy(scene)  # which may hold this object
        ribs, self._stress = getattr(scene, "ribs", None), None
        if isinstance(ribs, BeamFrame):
            self._stress = BeamStress(ribs, ribs.material)
        elif isinstance(ribs, SolidRibs):
            self._stress = ResinStress(ribs.body)
        if self._stress is not None:
            self._gap = ShaftGap(ribs, *scene.rib_places())

    def __call__(self, state: State) -> None:
        """Measure the present state."""
        scene = self._scene
        if "elastomer" in scene.functions:
            state.measures.update(scene.comm.bcast(self._stretches(state)))
        if self._stress is not None:
            state.measures["rib_stress_MPa"] = self._stress.largest()
            state.measures["shaft_gap_mm"] = self._gap.smallest()

    def _stretches(self, state: State) -> dict[str, float] | None:
        """Return what the stretches tell, on rank 0."""
        grid: Any = scene_grids(self._scene, state)["elastomer"]
        if grid is None:
            return None
        first, second = grid.point_data["stretch"], grid.point_data["second_stretch"]
        found = {"largest_stretch": float(first.max())}
        # Of places that differ by rounding, one that does not depend on it.
        most = np.round(grid.points[first >= first.max() - 1e-9], 6)
        place = most[np.lexsort(most.T)[0]]
        found |= {f"largest_stretch_{axis}_mm": float(x)
                  for axis, x in zip("xyz", place, strict=True)}
        if self._scene.body.prestretch is None:
            stability = self._scene.body.material.stability(first, second)
            found["material_stability"] = float(stability.min())
        return found


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
    if not any(isinstance(measure, Limits) for measure in wing.watch):
        wing.watch.append(Limits(wing))

    def on_step(state: State) -> None:
        if not keep_fields:
            state.fields = {}
        if progress:
            progress(state)

    path = wing.actuate(**loads, on_step=on_step, on_cut=progress.cut if progress else None)
    if progress:
        progress.end(path.converged, path.reason)
    return path
