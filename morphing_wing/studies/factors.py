"""A factor of a study: a name, and the values that it may take."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import asdict, dataclass
from typing import Any

import numpy as np

from morphing_wing.errors import InputError, is_count, is_number, plain, require

__all__ = ["Factor"]


@dataclass(frozen=True)
class Factor:
    """What is varied: between two numbers, or from level to level.

    Parameters
    ----------
    key
        Its name: of scenes a key as in scene files, ``geometry.top_thickness``; of a function of
        one's own whatever it calls it.
    low, high
        Both ends of its range, in the package's units; or
    levels
        at least two different values: numbers, words, True and False.
    whole
        Whether only whole numbers of the range are meant.
    column
        Name of its column in tables; the key if not given.
    unit
        For pictures.

    Examples
    --------
    >>> Factor("thickness", low=1.0, high=2.0).at([0.0, 0.25, 1.0])
    [1.0, 1.25, 2.0]
    >>> Factor("n", low=2, high=4, whole=True).at([0.0, 0.5, 1.0])
    [2, 3, 4]
    """

    key: str
    low: float | None = None
    high: float | None = None
    levels: tuple[Any, ...] | None = None
    whole: bool = False
    column: str = ""
    unit: str = ""

    def __post_init__(self) -> None:
        """Refuse ranges and levels that vary nothing."""
        object.__setattr__(self, "column", self.column or self.key)
        if self.levels is not None:
            if self.low is not None or self.high is not None:
                raise InputError(f"{self.key}: must have levels, or low and high, not both")
            levels = tuple(self.levels)
            texts = ", ".join(map(plain, levels))
            if len(levels) < 2 or len(set(levels)) < len(levels):
                raise InputError(f"{self.key}: levels = [{texts}]: must be two or more different "
                                 "values")
            object.__setattr__(self, "levels", levels)
            return
        for name in ("low", "high"):
            if getattr(self, name) is None:
                raise InputError(f"{self.key}: {name} is missing, must have levels, or low and "
                                 "high")
            require(is_number(getattr(self, name)), f"{self.key}: {name}", getattr(self, name),
                    self.unit, "a finite number")
        above = plain(self.low) + (f" {self.unit}" if self.unit else "")
        require(self.high > self.low, f"{self.key}: high", self.high, self.unit,
                f"more than low = {above}")
        if self.whole:
            for name in ("low", "high"):
                value = float(getattr(self, name))
                require(value.is_integer(), f"{self.key}: {name}", value, self.unit,
                        "a whole number")
                object.__setattr__(self, name, int(value))

    @property
    def is_range(self) -> bool:
        """Whether it goes through numbers, and not from word to word."""
        return self.levels is None or all(map(is_number, self.levels))

    def at(self, parts: Sequence[float] | np.ndarray) -> list[Any]:
        """Return the values at parts of the way, 0 to 1; levels take equal parts of it."""
        parts = np.asarray(parts, dtype=float)
        if self.levels is not None:
            return [self.levels[i] for i in _place(parts, len(self.levels))]
        assert self.low is not None and self.high is not None
        if self.whole:
            steps = _place(parts, int(self.high) - int(self.low) + 1)
            return [int(self.low) + int(step) for step in steps]
        return [float(x) for x in self.low + (self.high - self.low) * parts]

    def chosen(self, count: int | None) -> tuple[Any, ...]:
        """Return its levels; of a range ``count`` even ones, both ends included.

        Raises
        ------
        InputError
            If it is a range, and there is no count, or fewer whole numbers than that.
        """
        if self.levels is not None:
            return self.levels
        if not is_count(count) or count < 2:
            raise InputError(f"{self.key}: must have levels, or design.levels must say how many "
                             "its range has, 2 or more")
        values = np.linspace(self.low, self.high, count)
        if not self.whole:
            return tuple(float(value) for value in values)
        whole = tuple(dict.fromkeys(int(value) for value in np.rint(values)))
        if len(whole) < count:
            raise InputError(f"{self.key}: must have {count} whole numbers from {self.low} to "
                             f"{self.high} for as many levels")
        return whole

    def description(self) -> dict[str, Any]:
        """Return all parameters that are given."""
        return {name: value for name, value in asdict(self).items() if value not in (None, "")}


def _place(parts: np.ndarray, count: int) -> np.ndarray:
    return np.minimum((parts * count).astype(int), count - 1)
