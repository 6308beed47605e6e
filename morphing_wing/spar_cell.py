"""The spar as one cell that repeats itself: no ends, and few unknowns."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING, Any, NoReturn

import numpy as np
from mpi4py import MPI

from .angles import deflection_line
from .chambers import ROWS
from .drawing import Drawing, default_drawing
from .elastomer import Elastomer
from .elements import element as element_named
from .errors import InputError
from .geometry.spar import SparGeometry, SparMeshing
from .materials import DRAGON_SKIN_30, Yeoh
from .scene import Scene
from .spar import Spar
from .spar_rungs import CELL, fitted, pick_of
from .system import EquilibriumSystem
from .turning_plane import TurningPlane

if TYPE_CHECKING:
    from .path import State


class SparCell(Spar):
    r"""A quarter of one cell of a long spar, bounded by mirror planes.

    Where all chambers of a row have one pressure, each cell of a long spar is its neighbour turned:
    the middles of walls and of chambers stay plane, and one turn :math:`\theta` from the middle of
    a wall to that of a chamber gives :math:`\varphi_1 = 2 N \theta`. What the two ends do
    differently is left out. ``Spar(..., fidelity="cell")`` makes one.

    Parameters
    ----------
    geometry, material, fidelity, comm, meshing, element, options_prefix, tolerance
        As `Spar` has them.
    half, contact, filled
        Must have their defaults.
    """

    def __init__(
        self,
        geometry: SparGeometry,
        material: Yeoh = DRAGON_SKIN_30,
        fidelity: str = "cell",
        comm: MPI.Comm | None = None,
        *,
        half: bool = True,
        meshing: SparMeshing | None = None,
        element: str | None = None,
        options_prefix: str = "spar_",
        contact: bool = False,
        filled: str | None = None,
        tolerance: float | None = None,
    ) -> None:
        picked = pick_of(geometry, fidelity, tolerance, half, contact, filled, meshing, element)
        if picked.fidelity != "cell":
            raise InputError(f"fidelity = {fidelity!r}: must be 'cell' for a SparCell")
        Scene.__init__(self, picked, comm)
        self.geometry, self.material = geometry, material
        self.multiplicity = 4 * geometry.n_cells
        self.body = Elastomer(
            self.comm,
            geometry.cell_mesh(meshing or fitted(geometry, CELL, self.fidelity, self.comm)),
            material,
            element_named(element or CELL.element),
            symmetry={"symmetry": 0, "wall_middle": 2},
            pinned=(1, np.array([0.0, -geometry.middle_thickness / 2, 0.0])),
        )
        self.contact = self._filled = None
        self._plane = TurningPlane(
            self.body, "chamber_middle", geometry.pitch / 2, tuple(ROWS.values()))
        self._cut = self._plane.cut
        self.system = EquilibriumSystem(
            self.comm, [self.body.block, *self._plane.own_blocks, *self._plane.seen_blocks])
        self._plane.number(self.system)
        self._options_prefix = options_prefix

    def fill(self, *_: Any, **__: Any) -> NoReturn:
        """Refuse: how unequally chambers grow is not one cell's to tell."""
        raise InputError("fidelity = 'cell': must be a whole spar's to be filled with volumes")

    def description(self) -> dict[str, Any]:
        """Return all parameters, for `summary.json`."""
        return super().description() | {"half_model": True, "model": "a quarter of one cell"}

    def drawing(self, state: State) -> Drawing:
        """Return how to draw the present state: what is seen is no whole spar."""
        return replace(default_drawing(self), what="a quarter of one cell")

    # -- what the scene is made of ------------------------------------------------------------

    def masses(self) -> NoReturn:
        """Refuse: a spar's modes are not those of one of its cells."""
        raise InputError("fidelity = 'cell': must be a whole spar's for modes of vibration")

    def _functional(self, in_use: tuple[str, ...]) -> tuple[list[Any], Any]:
        energies, corrections = super()._functional(in_use)
        return [*energies, self._plane.energy], corrections

    def _measures(self) -> dict[str, float]:
        n, turn = self.geometry.n_cells, self._plane.turn
        tip = np.array([0.0, -self._sunk(n, turn), 0.0])
        return {
            "span_angle_deg": float(np.degrees(2 * n * turn)),
            "span_line_deg": deflection_line(tip, np.array([0.0, 0.0, self.geometry.length])),
        }

    def _sunk(self, n: int, turn: float) -> float:
        """Return how far the tip's middle sinks in mm: n chords, each 2 theta steeper, and a wall.

        A chord joins the middles of two walls, which mirror each other in the chamber's plane.
        """
        middle = self.body.mean_displacement("wall_middle")[1]
        chord = 2.0 * (self._plane.distance + middle * np.sin(turn))
        steps = np.sin((2 * np.arange(n) + 1) * turn).sum()
        return chord * steps + 0.5 * self.geometry.wall_length * np.sin(2 * n * turn)
