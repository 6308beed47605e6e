"""What steers an angle to a wanted value: a load with its limit, or two that pull opposite ways."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

from .errors import InputError, is_number, require
from .geometry.wing import WingGeometry
from .targets import UNITS

__all__ = ["Steering", "wing_steerings"]


@dataclass(frozen=True)
class Steering:
    """One angle and the loads that steer it, seen as one signed number.

    Attributes
    ----------
    angle
        Name of the measure, e.g. ``span_angle_deg``.
    wanted
        Its wanted value in degrees.
    load
        Load of the positive numbers, e.g. ``upper_MPa``.
    limit
        Largest value of each load, in its own unit.
    limit_name
        The parameter by which the user sets this limit.
    opposite
        Load of the negative numbers, e.g. ``lower_MPa``; None: the number is never negative.
    """

    angle: str
    wanted: float
    load: str
    limit: float
    limit_name: str
    opposite: str | None = None

    @property
    def lowest(self) -> float:
        """The smallest signed number."""
        return 0.0 if self.opposite is None else -self.limit

    def number(self, loads: Mapping[str, float]) -> float:
        """Return the signed number of some loads, within the limits."""
        value = loads[self.load] - (loads[self.opposite] if self.opposite else 0.0)
        return min(max(value, self.lowest), self.limit)

    def loads(self, number: float) -> dict[str, float]:
        """Return the loads of a signed number: one of two is always zero."""
        found = {self.load: max(number, 0.0)}
        return found | ({self.opposite: max(-number, 0.0)} if self.opposite else {})

    def active(self, number: float) -> tuple[str, float]:
        """Return the load that a change of the number changes, and the sign by which it does."""
        backwards = number < 0.0 or (number == 0.0 and self.wanted < 0.0)
        return (self.opposite, -1.0) if self.opposite and backwards else (self.load, 1.0)

    def at_limit(self, number: float) -> str:
        """Return in words which limit a number is at, empty if none."""
        name, _ = self.active(number)
        word, unit = name.rsplit("_", 1)
        if abs(number) >= self.limit * (1.0 - 1e-9):
            return f"{word} is at {self.limit_name} = {self.limit:g} {UNITS[unit]}"
        if number <= self.lowest:
            return f"{word} is at 0 {UNITS[unit]}"
        return ""


def wing_steerings(
    geometry: WingGeometry,
    span: float | None,
    chord: float | None,
    max_pressure: float,
    max_cable: float,
    pressed: bool,
) -> list[Steering]:
    """Return what steers a wing to wanted angles; see `Wing.trim` for the parameters.

    ``pressed`` says whether chambers are under pressure: it too turns the chord, either way.

    Raises
    ------
    InputError
        If no angle is wanted, one is no angle, or cables cannot pull towards it.
    """
    if span is None and chord is None:
        raise InputError("span and chord are both None: one or both must be an angle in deg")
    for name, value in (("span", span), ("chord", chord)):
        if value is not None:
            require(is_number(value) and abs(value) < 180.0, name, value, "deg",
                    "an angle between -180 and 180 deg, or None")
    for name, value, unit in (("max_pressure", max_pressure, "MPa"), ("max_cable", max_cable, "N")):
        require(is_number(value) and value > 0.0, name, value, unit, f"greater than 0 {unit}")
    found = []
    if span is not None:
        found.append(Steering("span_angle_deg", float(span), "upper_MPa", float(max_pressure),
                              "max_pressure", opposite="lower_MPa"))
    if chord is not None:
        require(geometry.rib is not None, "chord", chord, "deg",
                "left out in a wing without ribs, at whose tails cables pull")
        down = geometry.cable_guide[1] <= 0.0
        ok = pressed or span is not None or (chord >= 0.0 if down else chord <= 0.0)
        require(ok, "chord", chord, "deg",
                f"0 deg or {'more' if down else 'less'}: that way the cables pull")
        found.append(Steering("chord_angle_deg", float(chord), "cable_N", float(max_cable),
                              "max_cable"))
    return found
