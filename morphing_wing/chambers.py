"""Pressure in the rows of chambers: only rows with a load cost anything."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from . import compat
from .elastomer import Elastomer

ROWS = {"upper_MPa": "upper_chambers", "lower_MPa": "lower_chambers"}


class Chambers:
    """Uniform pressure in each row of chambers in use.

    Parameters
    ----------
    body, in_use
        The elastomer, and the loads in use; those that are no rows' are left alone.
    cut
        Normal and distance in UFL of a plane that cuts the chambers open; None: they are closed.

    Attributes
    ----------
    pressures
        Of each load name the constants in MPa that carry it.
    potentials
        Minus the work ``P V`` of each row in use, UFL functionals.
    """

    def __init__(
        self, body: Elastomer, in_use: Sequence[str], cut: tuple[Any, Any] | None = None
    ) -> None:
        self._comm = body.comm
        self.pressures: dict[str, list[Any]] = {}
        self.potentials: list[Any] = []
        self._volumes = {}
        for name in (name for name in in_use if name in ROWS):
            pressure = compat.constant(body.mesh, 0.0)
            volume = body.chamber_volume(ROWS[name], cut=cut)
            self.potentials.append(-pressure * volume)
            self.pressures[name] = [pressure]
            self._volumes[name] = compat.form(volume)

    def volumes(self) -> dict[str, float]:
        """Return the enclosed volume in mm^3 of each row in use."""
        return {name: compat.assemble_scalar(self._comm, volume)
                for name, volume in self._volumes.items()}
