"""NACA four-digit aerofoils."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from morphing_wing.errors import InputError, require


@dataclass(frozen=True)
class Aerofoil:
    """A NACA four-digit aerofoil (Abbott, von Doenhoff: Theory of Wing Sections, section 6.4).

    The thickness is laid off vertically, not normal to the camber line: a difference of second
    order in the camber, none for symmetric aerofoils.

    Attributes
    ----------
    digits
        E.g. "0012": camber in % of chord, its position in tenths, thickness in %.
    chord
        Chord length in mm.
    """

    digits: str
    chord: float

    def __post_init__(self) -> None:
        """Refuse what is no four-digit aerofoil."""
        ok = isinstance(self.digits, str) and len(self.digits) == 4 and self.digits.isdigit()
        if not ok or int(self.digits[2:]) == 0 or (self.digits[0] != "0") != (
            self.digits[1] != "0"
        ):
            raise InputError(
                f"aerofoil = {self.digits!r}: must be four digits of a NACA aerofoil, like '0012'"
            )
        require(self.chord > 0, "chord", self.chord, "mm", "greater than 0 mm")

    def half_thickness(self, x: np.ndarray | float) -> np.ndarray:
        """Return half the thickness in mm at x in mm from the leading edge (open trailing edge)."""
        s = np.clip(np.asarray(x, dtype=float) / self.chord, 0.0, 1.0)
        polynomial = s * (-0.1260 + s * (-0.3516 + s * (0.2843 - 0.1015 * s)))
        return 5.0 * int(self.digits[2:]) / 100.0 * self.chord * (0.2969 * np.sqrt(s) + polynomial)

    def camber(self, x: np.ndarray | float) -> np.ndarray:
        """Return the height in mm of the mean line at x in mm."""
        s = np.clip(np.asarray(x, dtype=float) / self.chord, 0.0, 1.0)
        m, p = int(self.digits[0]) / 100.0, int(self.digits[1]) / 10.0
        if m == 0.0:
            return np.zeros_like(s)
        front = m / p**2 * (2 * p * s - s**2)
        rear = m / (1 - p) ** 2 * (1 - 2 * p + 2 * p * s - s**2)
        return self.chord * np.where(s < p, front, rear)

    def x_where_half_thickness(self, value: float, front: bool) -> float:
        """Return x in mm, before or behind the thickest point, where half the thickness is so."""
        from scipy.optimize import brentq  # a fifth of a second, which a spar need not wait for

        thickest = 0.3 * self.chord
        bounds = (0.0, thickest) if front else (thickest, self.chord)
        return float(brentq(lambda x: float(self.half_thickness(x)) - value, *bounds))
