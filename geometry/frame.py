"""Frames: straight bars between points, each with a named kind, local axes and a section."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from .section import Circle, Rectangle, Section


@dataclass(frozen=True)
class Frame:
    """Bars between points, of one or several ribs.

    Attributes
    ----------
    points : (n, 3) array
        Coordinates in mm.
    bars : (m, 2) int array
        First and last point of each bar.
    kinds : (m,) int array
        Index of each bar's kind in ``names``.
    names : tuple of str
        ``shaft``, ``boss``, ``pivot``, ``centre_pivot``, ``socket``, ``arm``, ``root``, ``tail``.
    axes : (m, 3, 3) array
        Rows e1 (along the bar), e2, e3 of each bar's local axes.
    sections : tuple of mappings, one a rib
        Section of each kind.
    ribs : (m,) int array
        Which rib a bar belongs to.
    roots, tails : (n_ribs,) int arrays
        The points by which each rib is held and pulled; each ends exactly one bar, of kind
        ``root`` or ``tail``.
    """

    points: np.ndarray
    bars: np.ndarray
    kinds: np.ndarray
    names: tuple[str, ...]
    axes: np.ndarray
    sections: tuple[Mapping[str, Section], ...]
    ribs: np.ndarray
    roots: np.ndarray
    tails: np.ndarray

    def volume(self, *names: str) -> float:
        """Return the volume in mm^3 of the bars of some kinds, each by its whole length."""
        chosen = np.isin(self.kinds, [self.names.index(name) for name in names])
        return float((self.areas() * self.lengths())[chosen].sum())

    def of_kind(self, name: str) -> np.ndarray:
        """Return the bars of a kind, as indices."""
        return np.flatnonzero(self.kinds == self.names.index(name))

    def placed(self, origin: Sequence[float]) -> Frame:
        """Return the frame moved so that what was at (0, 0, 0) is at ``origin`` (mm)."""
        return replace(self, points=self.points + np.asarray(origin, dtype=float))

    def stiffness(self, E: float, nu: float) -> np.ndarray:
        """Return EA, GA2, GA3 (N), GJ, EI2, EI3 (N mm^2) of each bar, shape (m, 6)."""
        return self._of_each_bar(lambda section: section.stiffness(E, nu))

    def areas(self) -> np.ndarray:
        """Return the area in mm^2 of each bar's cross-section, shape (m,)."""
        return self._of_each_bar(lambda section: section.area)

    def _of_each_bar(self, value: Callable[[Section], Any]) -> np.ndarray:
        of = [
            {name: value(section) for name, section in sections.items()}
            for sections in self.sections
        ]
        pairs = zip(self.ribs, self.kinds, strict=True)
        return np.array([of[rib][self.names[kind]] for rib, kind in pairs])

    def half_heights(self) -> np.ndarray:
        """Return half the height in mm of each bar, shape (m,); NaN where a bar only stiffens."""
        half = {Rectangle: lambda s: s.width / 2.0, Circle: lambda s: s.diameter / 2.0}
        return self._of_each_bar(lambda s: half.get(type(s), lambda _: np.nan)(s))

    def lengths(self) -> np.ndarray:
        """Return the length in mm of each bar, shape (m,)."""
        return np.linalg.norm(np.diff(self.points[self.bars], axis=1)[:, 0], axis=1)


def join(frames: Sequence[Frame]) -> Frame:
    """Return several frames as one, unconnected; roots and tails in the order given."""
    first_point = np.cumsum([0] + [len(frame.points) for frame in frames])
    first_rib = np.cumsum([0] + [len(frame.sections) for frame in frames])
    each = list(enumerate(frames))
    return Frame(
        points=np.concatenate([frame.points for frame in frames]),
        bars=np.concatenate([frame.bars + first_point[i] for i, frame in each]),
        kinds=np.concatenate([frame.kinds for frame in frames]),
        names=frames[0].names,
        axes=np.concatenate([frame.axes for frame in frames]),
        sections=tuple(section for frame in frames for section in frame.sections),
        ribs=np.concatenate([frame.ribs + first_rib[i] for i, frame in each]),
        roots=np.concatenate([frame.roots + first_point[i] for i, frame in each]),
        tails=np.concatenate([frame.tails + first_point[i] for i, frame in each]),
    )


def local_axes(points: np.ndarray, bars: np.ndarray) -> np.ndarray:
    """Return each bar's axes: e1 along it, e3 next to z, or e2 next to x for a bar along z.

    Parameters
    ----------
    points : (n, 3) array
        Coordinates in mm.
    bars : (m, 2) int array
        First and last point of each bar.

    Returns
    -------
    (m, 3, 3) array
        Rows e1, e2, e3: a right-handed orthonormal triad.
    """
    e1 = points[bars[:, 1]] - points[bars[:, 0]]
    e1 /= np.linalg.norm(e1, axis=1, keepdims=True)
    along_z = np.abs(e1[:, 2:]) > 0.9
    e2 = np.where(along_z, [1.0, 0.0, 0.0], np.cross([0.0, 0.0, 1.0], e1))
    e2 -= np.sum(e2 * e1, axis=1, keepdims=True) * e1
    e2 /= np.linalg.norm(e2, axis=1, keepdims=True)
    return np.stack([e1, e2, np.cross(e1, e2)], axis=1)
