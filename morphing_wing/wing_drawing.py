"""How a wing is drawn: cut along the span and beside its middle rib, bars as tubes, cables."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from .bar_mesh import BarMesh
from .drawing import Cut, Drawing, default_drawing, drawn_bars

if TYPE_CHECKING:
    from .path import State
    from .wing import Wing

__all__ = ["wing_drawing"]


def wing_drawing(scene: Wing, state: State) -> Drawing:
    """Return how to draw a wing that stands in a state. Collective."""
    wing, cuts, cables, bars = scene.geometry, [Cut("x", 0.25 * scene.geometry.chord)], [], {}
    if scene.ribs is not None:
        if isinstance(scene.ribs, BarMesh):
            bars = drawn_bars("ribs", scene.ribs.frame, scene.ribs.carried)
        roots = wing.rib_roots()
        tails = roots + np.array([wing.rib.length, 0.0, 0.0])
        cuts.append(Cut("z", roots[len(roots) // 2, 2] + 0.5 * wing.cavity_length + 3.0))
        for i, tail in enumerate(tails if state.load.get("cable_N") else ()):
            start = tail + scene.ribs.end_values("tail", i)[:3]
            way = tail + np.array(wing.cable_guide) - start
            cables.append(np.array([start, start + 40.0 * way / np.linalg.norm(way)]))
    return replace(default_drawing(scene), cuts=cuts, cables=cables, **bars)
