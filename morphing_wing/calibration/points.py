"""The points of all tests together, each with its weight."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from .laws import Law
from .material_test import MaterialTest

__all__ = ["Points"]


@dataclass(frozen=True, eq=False)
class Points:
    """All points that are used, of all tests, each with its weight.

    Attributes
    ----------
    parts
        Of each test its mode and its stretches.
    stress
        Nominal stress in MPa, all tests one after another.
    weights
        omega of each point.
    """

    parts: tuple[tuple[str, np.ndarray], ...]
    stress: np.ndarray
    weights: np.ndarray

    @classmethod
    def of(cls, tests: Sequence[MaterialTest]) -> Points:
        """Gather the used points of tests."""
        points = [test.points for test in tests]
        sizes = [stress.size for _, stress in points]
        whole = sum(sizes) / sum(test.weight for test in tests)
        weights = [np.full(n, test.weight * whole / n)
                   for n, test in zip(sizes, tests, strict=True)]
        parts = tuple((test.mode, stretch)
                      for test, (stretch, _) in zip(tests, points, strict=True))
        return cls(parts, np.concatenate([stress for _, stress in points]),
                   np.concatenate(weights))

    def thinned(self, most: int) -> Points:
        """Return data of about so many points of each test, evenly taken."""
        steps = [-(-stretch.size // most) for _, stretch in self.parts]
        ends = np.cumsum([0, *(stretch.size for _, stretch in self.parts)])
        kept = np.concatenate([np.arange(ends[i], ends[i + 1], step)
                               for i, step in enumerate(steps)])
        parts = tuple((mode, stretch[::step])
                      for (mode, stretch), step in zip(self.parts, steps, strict=True))
        return Points(parts, self.stress[kept], self.weights[kept])

    def computed(self, law: Law, values: Any) -> np.ndarray:
        """Return a law's nominal stresses in MPa at all points."""
        return np.concatenate([law.stress(values, *part) for part in self.parts])

    def slopes(self, law: Law, values: Any) -> np.ndarray:
        """Return their derivatives by the constants, of shape (points, constants)."""
        return np.concatenate([law.stress_slopes(values, *part) for part in self.parts])
