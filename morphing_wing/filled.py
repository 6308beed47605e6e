"""Chambers filled with a given volume: the pressure is an unknown, past any limit point."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from typing import Any

import numpy as np

from . import compat
from .chambers import ROWS
from .elastomer import Elastomer
from .errors import InputError
from .led import LedLoad
from .system import EquilibriumSystem

__all__ = ["FILLINGS", "FilledChambers"]

FILLINGS = ("shared", "separate")
"""One supply for all chambers of a row, or a part of its own for each chamber, as if sealed."""

KILOPASCAL = 1e-3  # MPa: the unknown's unit

ALONE = 1.25
"""Part of the mean volume from which on a chamber is said to balloon alone."""


class FilledChambers:
    r"""Rows of chambers into which a volume is filled, mm^3 beyond that at rest.

    With one supply all chambers of a row have one pressure and the sum of their volumes is given;
    filled apart, each has a pressure of its own and takes an equal part of the volume,

    .. math:: \Pi = E(u) - \sum_k p_k \, (V_k(u) - V_{k,0} - \Delta V_k) .

    Parameters
    ----------
    body
        The elastomer.
    chamber_of
        From places along the span to numbers of chambers.
    filling
        One of `FILLINGS`.
    part
        Part of the whole that the body is: 1/2 of a half model.

    Attributes
    ----------
    own_blocks, seen_blocks
        The pressures, and what stands for them on the body: see `LedLoad`.
    """

    def __init__(
        self,
        body: Elastomer,
        chamber_of: Callable[[np.ndarray], np.ndarray],
        filling: str,
        part: float,
    ) -> None:
        if filling not in FILLINGS:
            raise InputError(f"filled = {filling!r}: must be None or one of {', '.join(FILLINGS)}")
        self.filling, self._body, self._part = filling, body, part
        self._in_use: list[str] | None = None
        self._led: dict[str, list[LedLoad]] = {}
        self._supplied: dict[str, list[np.ndarray]] = {}
        self._volumes: dict[str, list[Any]] = {}
        self._at_rest: dict[str, np.ndarray] = {}
        for load, face in ROWS.items():
            row = load.removesuffix("_MPa")
            pairs, chamber = body.grid.facets[face], chamber_of(body.grid.beyond(face)[:, 2])
            single = [pairs[chamber == i] for i in range(chamber.max() + 1)]
            self._supplied[row] = [pairs] if filling == "shared" else single
            self._led[row] = [
                LedLoad(body.mesh, body.faces.cells_at(own), f"{row}_{i + 1}_kPa", KILOPASCAL)
                for i, own in enumerate(self._supplied[row])]
            self._volumes[row] = [compat.form(body.cavity_volume(own)) for own in single]
            self._at_rest[row] = self._volumes_now(row)
        self.own_blocks = [led.blocks[0] for led in self._all()]
        self.seen_blocks = [led.blocks[1] for led in self._all()]

    @property
    def count(self) -> int:
        """Number of pressures, each of which brings a negative pivot."""
        return len(self._all())

    def number(self, system: EquilibriumSystem) -> None:
        """Let the body see the pressures, once a system has numbered them."""
        for led in self._all():
            led.number(system)

    def use(self, in_use: Sequence[str]) -> tuple[dict[str, list[Any]], list[Any]]:
        """Return of each load in use its constants, and the potentials of all pressures.

        A row that is not in use is open: there is no pressure in it.

        Raises
        ------
        InputError
            If other rows were in use before.
        """
        rows = [name.removesuffix("_mm3") for name in in_use]
        if self._in_use not in (None, rows):
            raise InputError(
                f"rows filled = {', '.join(rows) or 'none'}: must be {', '.join(self._in_use)} "
                "as in the first filling of this spar (0 mm^3 seals a row as it is)")
        self._in_use = rows
        loads: dict[str, list[Any]] = {}
        potentials: list[Any] = []
        for row, leds in self._led.items():
            if row not in self._in_use:
                potentials += [led.none() for led in leds]
                continue
            loads[f"{row}_mm3"] = [led.given for led in leds]
            at_rest = self._at_rest[row]
            parts = [at_rest.sum()] if len(leds) == 1 else at_rest
            for led, pairs, volume in zip(leds, self._supplied[row], parts, strict=True):
                potentials += [led.potential(volume, self._part / len(leds)),
                               -self._body.cavity_volume(pairs, led.seen)]
        return loads, potentials

    def conjugates(self) -> dict[str, float]:
        """Return of each load in use minus the mean pressure in MPa, over the parts."""
        return {f"{row}_mm3": -self._part * float(np.mean(self._pressures(row)))
                for row in self._in_use}

    def measures(self) -> dict[str, float]:
        """Return pressures, and how unequally the chambers of a row have grown.

        ``upper_MPa`` is the (mean) pressure of the row. Filled apart, ``upper_lowest_MPa`` and
        ``upper_highest_MPa`` are those of single chambers. From one supply,
        ``upper_largest_chamber`` has taken most volume, counted from 1 at the root, and
        ``upper_largest_share`` times the mean: far above one where one chamber balloons alone. (Of
        an empty row 0 and 1.)
        """
        found = {}
        for row in self._in_use:
            pressures = self._pressures(row)
            found[f"{row}_MPa"] = float(np.mean(pressures))
            if self.filling == "separate":
                found |= {f"{row}_lowest_MPa": min(pressures), f"{row}_highest_MPa": max(pressures)}
                continue
            grown = self._volumes_now(row) - self._at_rest[row]
            mean = float(grown.mean())
            filled = abs(mean) > 1e-6 * self._at_rest[row].mean()
            found[f"{row}_largest_chamber"] = float((grown / mean).argmax() + 1) if filled else 0.0
            found[f"{row}_largest_share"] = float((grown / mean).max()) if filled else 1.0
        return found

    def localised(self, measures: Mapping[str, float]) -> str:
        """Return the end of a sentence that names a chamber which balloons alone, if one does."""
        said = ""
        for row in self._in_use if self.filling == "shared" else ():
            number, share = (measures[f"{row}_largest_{what}"] for what in ("chamber", "share"))
            if share > ALONE:
                said += (f"; chamber {number:.0f} of the {row} row balloons alone, "
                         f"it took {share:.2f} times the mean volume")
        return said

    # -- internals ----------------------------------------------------------------------------

    def _all(self) -> list[LedLoad]:
        return [led for leds in self._led.values() for led in leds]

    def _pressures(self, row: str) -> list[float]:
        return [led.value for led in self._led[row]]

    def _volumes_now(self, row: str) -> np.ndarray:
        return np.array([compat.assemble_scalar(self._body.comm, form)
                         for form in self._volumes[row]])
