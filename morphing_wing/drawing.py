"""How a scene wants to be drawn: from where, cut where, and how thick its bars are."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from morphing_wing.geometry.frame import Frame

__all__ = ["Cut", "Drawing", "bar_radii", "default_drawing", "drawn_bars"]

# From where each kind of scene is seen (x chordwise, y up, z along the span): spar and wing from
# the front with the root at the left and the tip at the right, the rib from the tip's side.
_EYES = {"spar": (-1.0, 0.55, 0.6), "wing": (-0.6, 0.7, 1.0), "rib": (0.25, 0.35, 1.0)}
_BARS = ("shaft", "pivot", "centre_pivot")  # kinds with the section that one would measure


@dataclass(frozen=True)
class Cut:
    """A plane that takes away what lies before it.

    Attributes
    ----------
    axis
        ``"x"`` (along the span: what lies at smaller x is taken away) or ``"z"`` (across the span:
        what lies at larger z is taken away).
    level
        Where, mm in the undeformed structure.
    """

    axis: str
    level: float


@dataclass(frozen=True)
class Drawing:
    """How a scene wants to be drawn; a scene's ``drawing(state)`` may return one.

    The scene is in that state when its ``drawing`` is called, on all ranks.

    Attributes
    ----------
    eye
        Direction from the structure to the viewer.
    mirror_x
        Plane x = constant (mm, undeformed) in which a half model is mirrored; None: whole model.
    cuts
        At most two cuts, each drawn beside the whole; None: one along the span, in the mirror plane
        or in the middle.
    radius
        Radius in mm of each function on intervals by name: one number, or one for each cell.
    bars
        Of a function that is the motion of axes alone, the frame that they carry: drawn in their
        place, see `morphing_wing.carried_bars`; ``radius`` is then its bars'.
    cables
        Deformed polylines of the cables, each of shape (n, 3) in mm; needed on rank 0 only.
    colour_by
        ``"stretch"``, ``"displacement"`` or ``"mode"``; solids are coloured by it.
    what
        What is seen without a cut, in words.
    """

    eye: tuple[float, float, float] = _EYES["spar"]
    mirror_x: float | None = None
    cuts: Sequence[Cut] | None = None
    radius: Mapping[str, float | np.ndarray] = field(default_factory=dict)
    bars: Mapping[str, Frame] = field(default_factory=dict)
    cables: Sequence[np.ndarray] = ()
    colour_by: str = "stretch"
    what: str = "whole"


def default_drawing(scene: Any) -> Drawing:
    """Return the drawing of a scene that says nothing: by its name and its multiplicity."""
    mirror = 0.0 if getattr(scene, "multiplicity", 1) == 2 else None
    return Drawing(eye=_EYES.get(scene.name, _EYES["spar"]), mirror_x=mirror)


def drawn_bars(name: str, frame: Frame, carried: Frame | None) -> dict[str, Any]:
    """Return ``radius`` and ``bars`` of a `Drawing` of a frame, or of one that axes carry."""
    return {"radius": {name: bar_radii(carried or frame)},
            "bars": {name: carried} if carried else {}}


def bar_radii(frame: Frame) -> np.ndarray:
    """Return each bar's radius in mm for `Drawing.radius`: the round bar of the same section area.

    What only joins (bosses and sockets, arms, root and tail) may be stiff without being thick: it
    is drawn as thin as the thinnest bar.
    """
    radius = np.sqrt(frame.areas() / np.pi)
    bars = np.isin(frame.kinds, [i for i, name in enumerate(frame.names) if name in _BARS])
    return np.where(bars, radius, radius[bars].min())
