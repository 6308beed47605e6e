"""The pantographic rib as a scene: what all its kinds share, and the frame of beams."""

from __future__ import annotations

import os
from collections.abc import Callable, Mapping, Sequence
from dataclasses import asdict, replace
from typing import TYPE_CHECKING, Any

import numpy as np
from dolfinx import fem
from mpi4py import MPI

from . import compat
from .angles import deflection_line, rotation_about_z, turned_x
from .drawing import Drawing, default_drawing, drawn_bars
from .errors import is_count, require
from .forms.beam import displacement
from .forms.cable import cable_potential
from .forms.gravity import mass_density
from .frame import BeamFrame
from .geometry.rib import RibGeometry
from .iterate import Iterate
from .ladder import Pick, pick
from .materials import RESIN, Elastic
from .newton import Newton
from .path import Path, State
from .scene import Scene
from .stepping import Stepping
from .system import EquilibriumSystem
from .tension import check_tension

if TYPE_CHECKING:
    from .solid_ribs import SolidRibs


class Rib(Scene):
    """A rib clamped at its root, bent by a moment or a cable at its tail.

    Parameters
    ----------
    geometry
        Dimensions.
    material
        Resin.
    fidelity
        "instant" (the paper's formula, moments only), "cell" (a chain of one cell's condensed
        solid), "draft" (a frame of beams), "standard" and "reference" (a solid), or "auto": the
        cheapest that fits the tolerance.
    comm
        Communicator; all ranks of MPI by default.
    options_prefix
        Prefix of this scene's PETSc options.
    around
        Elements around a cylinder, of a solid or a cell, in place of the fidelity's.
    tolerance
        Relative error that "auto" may have, see `morphing_wing.ladder.pick`.

    Examples
    --------
    >>> rib = Rib(RibGeometry.validation())                          # doctest: +SKIP
    >>> rib.bend(torque=[0.0, 5.0]).table()                          # doctest: +SKIP
    """

    name = "rib"
    load_names = ("torque_Nmm", "cable_N")
    stepping = Stepping(easy=10)
    _around: Mapping[str, int] = {}
    _element = "Simo-Reissner beam, quadratic, 2 Gauss points"

    def __new__(
        cls, geometry: RibGeometry, material: Elastic = RESIN, fidelity: str = "draft",
        *_: Any, tolerance: float | None = None, **__: Any,
    ) -> Rib:
        """Return a scene of the kind that the fidelity is of."""
        kind = cls
        if cls is Rib:
            picked = pick("rib", fidelity, tolerance, geometry.n_cells).fidelity
            if picked == "instant":
                from .instant import InstantRib as kind
            elif picked == "cell":
                from .condensed_rib import CondensedRib as kind
            elif picked in ("standard", "reference"):
                from .solid_rib import SolidRib as kind
        return super().__new__(kind)

    def __init__(
        self,
        geometry: RibGeometry,
        material: Elastic = RESIN,
        fidelity: str = "draft",
        comm: MPI.Comm | None = None,
        options_prefix: str = "rib_",
        tolerance: float | None = None,
        around: int | None = None,
    ) -> None:
        picked = pick("rib", fidelity, tolerance, geometry.n_cells)
        if around is not None:
            meshed = picked.fidelity in self._around
            require(meshed and is_count(around) and around >= 4, "around", around, "",
                    "a whole number of at least 4, of a fidelity with tetrahedra")
            picked = Pick(picked.fidelity, None)
        super().__init__(picked, comm)
        self.around = around or self._around.get(picked.fidelity)
        self.geometry, self.material = geometry, material
        self.primary_load = "torque_Nmm"
        self._options_prefix = options_prefix
        self._build()
        self._guide = self._held(np.array([0.0, -100.0, 0.0]))

    def _build(self) -> None:
        """Make the ribs and the system."""
        self.ribs = ribs = self._made()
        local = [part.block for part in ribs.parts if part.block.local]
        self.system = EquilibriumSystem(self.comm, [*ribs.unknowns, *local])
        ribs.join(self.system)

    def _made(self) -> BeamFrame | SolidRibs:
        return BeamFrame(self.comm, self.geometry.frame(), self.material, clamped=True)

    def _held(self, place: np.ndarray) -> Any:
        """Return a place whose ``value`` may change, as the tail's potentials take it."""
        return compat.constant(self.ribs.motion_mesh, place)

    def bend(
        self,
        torque: float | Sequence[float],
        on_step: Callable[[State], None] | None = None,
        on_cut: Callable[..., None] | None = None,
        restart: str | os.PathLike | None = None,
        resume: str | os.PathLike | None = None,
    ) -> Path:
        """Bend by a moment about z at the tail, positive when it turns the tail down.

        Its potential is M theta_z with the rotation vector's third component: exact while the
        tail turns about z alone, as a rib does that is symmetric in z.

        Parameters
        ----------
        torque
            Moment in N mm: a number or a sequence of them.
        on_step, on_cut, restart, resume
            See `Scene.follow`.
        """
        self.primary_load = "torque_Nmm"
        return self.follow({"torque_Nmm": torque}, on_step, on_cut, restart, resume)

    def pull(
        self,
        cable: float | Sequence[float],
        guide: Sequence[float] = (0.0, -100.0, 0.0),
        on_step: Callable[[State], None] | None = None,
        on_cut: Callable[..., None] | None = None,
        restart: str | os.PathLike | None = None,
        resume: str | os.PathLike | None = None,
    ) -> Path:
        """Pull by a cable of constant tension from the tail to a fixed guide point.

        Parameters
        ----------
        cable
            Tension in N: a number or a sequence of them.
        guide
            The guide point, seen from the undeformed tail, mm.
        on_step, on_cut, restart, resume
            See `Scene.follow`.
        """
        check_tension(cable)
        place = _guide(guide)
        if not np.array_equal(place, self._guide.value):
            self._guide.value = place
            self._in_use = None  # to be taken up anew: work counts from the new guide on
        self.primary_load = "cable_N"
        return self.follow({"cable_N": cable}, on_step, on_cut, restart, resume)

    def rib_places(self) -> tuple[RibGeometry, np.ndarray, bool]:
        """Return the rib, where its root is, (1, 3) in mm, and whether it is a half."""
        return self.geometry, np.zeros((1, 3)), self.multiplicity == 2

    # -- for the pictures ---------------------------------------------------------------------

    @property
    def functions(self) -> dict[str, fem.Function]:
        """Displacement in mm (and rotation vector) by name."""
        return {"ribs": self.ribs.function}

    def drawing(self, state: State) -> Drawing:
        """Return how to draw the present state: bars as tubes."""
        return replace(default_drawing(self),
                       **drawn_bars("ribs", self.ribs.frame, self.ribs.carried))

    def description(self) -> dict[str, Any]:
        """Return all parameters, for `summary.json`."""
        return {
            "geometry": asdict(self.geometry),
            "material": asdict(self.material),
            "element": self._element,
            "guide_mm": [float(x) for x in self._guide.value],
        }

    # -- what the scene is made of ------------------------------------------------------------

    def _iterates(self) -> list[Iterate]:
        return [part.iterate for part in self.ribs.parts]

    def _newton(self) -> Newton:
        return Newton(self.system, self._options_prefix, before_tangent=self.before_tangent)

    def _functional(self, in_use: tuple[str, ...]) -> tuple[list[Any], Any]:
        ribs = self.ribs
        potentials = {
            "torque_Nmm": lambda torque: torque * ribs.motion[5],
            "cable_N": lambda tension: cable_potential(
                tension, displacement(ribs.motion), self._guide),
        }
        energies = self._stored()
        self.loads, self._shortenings = {}, {}
        for name in in_use:
            load, part = compat.constant(ribs.motion_mesh, 0.0), 1.0 / self.multiplicity
            energies.append(ribs.at_ends("tail", potentials[name](part * load)))
            self._shortenings[name] = compat.form(ribs.at_ends("tail", -potentials[name](part)))
            self.loads[name] = [load]
        return energies, self._corrections(ribs.parts)

    def _stored(self) -> list[Any]:
        return [part.energy for part in self.ribs.parts]

    def masses(self) -> list[np.ndarray]:
        """Return the lumped mass in kg on each owned unknown."""
        density = mass_density(self.material.density)
        return [density * part.lumped_volume() for part in self.ribs.parts]

    def _conjugates(self) -> dict[str, float]:
        return {name: compat.assemble_scalar(self.comm, form)
                for name, form in self._shortenings.items()}

    def _measures(self) -> dict[str, float]:
        tail = self.ribs.end_values("tail", 0)
        return {
            "chord_angle_deg": rotation_about_z(turned_x(tail[3:])),
            "chord_line_deg": deflection_line(tail[:3], np.array([self.geometry.length, 0.0, 0.0])),
        }


def _guide(guide: Sequence[float]) -> np.ndarray:
    try:
        point = np.asarray(guide, dtype=float)
    except (TypeError, ValueError):
        point = np.empty(0)
    ok = point.shape == (3,) and bool(np.isfinite(point).all()) and bool(np.any(point != 0.0))
    require(ok, "guide", guide, "mm", "three finite numbers, not all of them 0")
    return point
