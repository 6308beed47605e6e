"""A test of a rubber: nominal stress against stretch, and which part of the curve is used."""

from __future__ import annotations

import dataclasses
from dataclasses import dataclass
from typing import Any

import numpy as np

from morphing_wing.errors import InputError, is_number, require

from .deformation import MODES

__all__ = ["MaterialTest"]

FALL = 0.01
"""Share of the curve's range of stretch by which it may go back: what an extensometer shakes."""


@dataclass(frozen=True, eq=False)
class MaterialTest:
    """Nominal stress against stretch in one mode, in the order in which it was measured.

    Parameters
    ----------
    stretch
        Length over length at rest, greater than 0, below 1 in compression; at least two points.
    stress
        Nominal stress in MPa, force over the area at rest, negative in compression.
    mode
        ``"uniaxial"``, ``"planar"`` (pure shear) or ``"equibiaxial"``.
    weight
        How much the test counts beside others, greater than 0, however many points it has.
    name
        What it is called in results and sentences.
    lines
        Line of its file that each point comes from; None where there is no file.
    remarks
        Sentences on how it was read.

    Attributes
    ----------
    used
        Which points are fitted: all, until `cut` is called.

    Raises
    ------
    InputError
        Where a number is not finite, a stretch is not greater than 0, or lengths differ.
    """

    stretch: np.ndarray
    stress: np.ndarray
    mode: str = "uniaxial"
    weight: float = 1.0
    name: str = "test"
    lines: np.ndarray | None = None
    remarks: tuple[str, ...] = ()
    used: np.ndarray = None  # type: ignore[assignment]

    def __post_init__(self) -> None:
        """Check the numbers."""
        for what in ("stretch", "stress"):
            try:
                values = np.array(getattr(self, what), dtype=float)
            except (TypeError, ValueError):
                raise InputError(f"{self.name}: {what} must be numbers") from None
            require(values.ndim == 1 and values.size >= 2, f"{self.name}: points of {what}",
                    values.size, "", "at least 2, in one row")
            for i in np.flatnonzero(~np.isfinite(values))[:1]:
                raise InputError(f"{self.name}: {what} = {values[i]}{self._where(i)}: must be a "
                                 "finite number")
            object.__setattr__(self, what, values)
        sizes = self.stretch.size, self.stress.size
        require(sizes[0] == sizes[1], f"{self.name}: points of stretch and stress", list(sizes), "",
                "equally many")
        for i in np.flatnonzero(self.stretch <= 0.0)[:1]:
            raise InputError(f"{self.name}: stretch = {self.stretch[i]:.6g}{self._where(i)}: must "
                             "be greater than 0 (a nominal strain greater than -1)")
        require(self.mode in MODES, f"{self.name}: mode", self.mode, "",
                f"one of {', '.join(MODES)}")
        require(is_number(self.weight) and self.weight > 0.0, f"{self.name}: weight", self.weight,
                "", "greater than 0")
        if self.used is None:
            object.__setattr__(self, "used", np.ones(self.stretch.size, dtype=bool))

    @property
    def largest(self) -> float:
        """Largest stretch that is used."""
        return float(self.stretch[self.used].max())

    @property
    def points(self) -> tuple[np.ndarray, np.ndarray]:
        """Stretch and stress of the points that are used."""
        return self.stretch[self.used], self.stress[self.used]

    def until_failure(self, whole: bool = False) -> MaterialTest:
        """Return the test without what follows its largest stress in tension.

        There a specimen has torn, or is unloaded. What is left must be one loading curve.

        Parameters
        ----------
        whole
            Keep what follows: a law that softens may be fitted to it.

        Raises
        ------
        InputError
            Where the stretch goes back on the way.
        """
        peak = int(np.argmax(self.stress))
        used, remarks = self.used.copy(), self.remarks
        after = self.stress.size - 1 - peak
        if after and self.stretch[peak] > 1.0 and not whole:
            used[peak + 1:] = False
            remarks += (f"cut at its largest nominal stress, {self.stress[peak]:.4g} MPa at "
                        f"stretch {self.stretch[peak]:.4g}, where it fails or is unloaded: "
                        f"{after} of {self.stress.size} points come after it (whole keeps them)",)
        cut = dataclasses.replace(self, used=used, remarks=remarks)
        cut._check_one_way()
        return cut

    def up_to(self, max_stretch: float) -> MaterialTest:
        """Return the test up to a stretch; compression is kept as it is."""
        used = self.used & (self.stretch <= max_stretch * (1.0 + 1e-12))
        left = int(self.used.sum() - used.sum())
        remark = (f"used up to stretch {max_stretch:g}: {used.sum()} points, {left} left out",)
        return dataclasses.replace(self, used=used, remarks=self.remarks + remark * (left > 0))

    def _check_one_way(self) -> None:
        """Refuse curves that are loaded and unloaded several times."""
        place = np.flatnonzero(self.used)
        way = self.stretch[place]
        falling = way[0] - way[-1] > 0.5 * np.ptp(way)  # in compression
        reached = (np.minimum if falling else np.maximum).accumulate(way)
        for i in np.flatnonzero(np.abs(way - reached) > FALL * np.ptp(way))[:1]:
            raise InputError(
                f"{self.name}: stretch goes back from {reached[i]:.4g} to {way[i]:.4g}"
                f"{self._where(place[i])}: must be one curve of loading, without cycles")

    def _where(self, point: Any) -> str:
        return (f" in point {point + 1}" if self.lines is None
                else f" in line {self.lines[point]}")
