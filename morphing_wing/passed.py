"""Which limits a path has passed, in words: where, by what, from which load on."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from typing import TYPE_CHECKING

from .materials import FRACTURE_STRETCH, YIELD_MPA
from .targets import load_words

if TYPE_CHECKING:
    from .path import State

__all__ = ["passed"]

_Measures = Mapping[str, float]


def passed(states: Sequence[State]) -> list[str]:
    """Return a sentence for each limit that states have passed, at the first load beyond it.

    Parameters
    ----------
    states
        Of a path whose limits were measured, see `morphing_wing.limits.Limits`; others pass none.
    """
    found = []
    for name, beyond, sentence in _LIMITS:
        for state in states:
            if name in state.measures and beyond(state.measures[name]):
                found.append(f"from {load_words(state.load)} on {sentence(state.measures)}")
                break
    return found


def _place(measures: _Measures) -> str:
    place = (measures[f"largest_stretch_{axis}_mm"] for axis in "xyz")
    where = ", ".join(f"{round(x, 3) + 0.0:.6g}" for x in place)
    return f"{measures['largest_stretch']:.3g} at ({where}) mm"


_LIMITS: tuple[tuple[str, Callable[[float], bool], Callable[[_Measures], str]], ...] = (
    ("largest_stretch", lambda stretch: stretch > FRACTURE_STRETCH,
     lambda m: f"the paper's silicone would tear (stretch {FRACTURE_STRETCH:g}): the stretch is "
               f"{_place(m)}"),
    ("material_stability", lambda stability: stability <= 0.0,
     lambda m: "the material's law gives way (its force falls while it is stretched): the largest "
               f"stretch is {_place(m)}"),
    ("rib_stress_MPa", lambda stress: stress > YIELD_MPA,
     lambda m: f"the resin yields ({YIELD_MPA:g} MPa): its stress is "
               f"{m['rib_stress_MPa']:.3g} MPa"),
    ("shaft_gap_mm", lambda gap: gap < 0.0,
     lambda m: f"neighbouring shafts of a rib pass through each other, by "
               f"{-m['shaft_gap_mm']:.2g} mm"),
)
