"""The cuboid pneumatic spar as a scene."""

from __future__ import annotations

import os
from collections.abc import Callable, Mapping, Sequence
from dataclasses import asdict
from typing import Any

import numpy as np
from dolfinx import fem
from mpi4py import MPI

from .angles import deflection_line, rotation_about_x
from .chamber_contact import in_chambers
from .chambers import Chambers
from .elastomer import Elastomer
from .elements import element as element_named
from .errors import InputError
from .filled import FILLINGS, FilledChambers
from .forms.gravity import mass_density
from .geometry.spar import SparGeometry, SparMeshing
from .iterate import Iterate
from .materials import DRAGON_SKIN_30, Yeoh
from .newton import Newton
from .path import Path, State
from .scene import Scene
from .spar_rungs import FIDELITIES, fitted, pick_of
from .system import EquilibriumSystem


class Spar(Scene):
    """A cantilevered spar of two rows of sealed chambers.

    Parameters
    ----------
    geometry
        Dimensions.
    material
        Yeoh elastomer.
    fidelity
        "instant" (the paper's formula), "cell" (one cell that repeats itself: no ends), "draft"
        (Q1/P0), "standard" (Q2/P1disc), "reference" (the same on a fine mesh), the last four graded
        at the chamber corners; or "auto": the cheapest that fits the tolerance.
    comm
        Communicator; all ranks of MPI by default.
    half
        Model one half, by symmetry at mid-width (every load of a spar is symmetric).
    meshing, element
        Replace those of the fidelity.
    options_prefix
        Prefix of this scene's PETSc options.
    contact
        Whether the ceiling and the floor of a chamber press against each other, as they may under
        suction. Without, nothing is told of it.
    filled
        None: pressures are given. "shared" or "separate": volumes are, by one supply for all
        chambers of a row or an equal part for each; see `fill`.
    tolerance
        Relative error that "auto" may have, see `morphing_wing.ladder.pick`.

    Examples
    --------
    >>> spar = Spar(SparGeometry.validation(), DRAGON_SKIN_30)      # doctest: +SKIP
    >>> spar.inflate(upper=[0.01, 0.02]).table()                    # doctest: +SKIP
    """

    name = "spar"
    load_names = ("upper_MPa", "lower_MPa")
    _cut: tuple[Any, Any] | None = None  # of a plane that cuts chambers open, see `Chambers`

    def __new__(
        cls, geometry: SparGeometry, material: Yeoh = DRAGON_SKIN_30, fidelity: str = "standard",
        comm: MPI.Comm | None = None, *, options_prefix: str = "", **options: Any,
    ) -> Spar:
        """Return a scene of the kind that the fidelity is of."""
        kind = cls
        if cls is Spar:
            picked = pick_of(geometry, fidelity, **options).fidelity
            if picked == "cell":
                from .spar_cell import SparCell as kind
            elif picked == "instant":
                from .instant import InstantSpar as kind
        return super().__new__(kind)

    def __init__(
        self,
        geometry: SparGeometry,
        material: Yeoh = DRAGON_SKIN_30,
        fidelity: str = "standard",
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
        self.led = filled is not None
        if self.led:
            self.load_names, self.primary_load = ("upper_mm3", "lower_mm3"), "upper_mm3"
        picked = pick_of(geometry, fidelity, tolerance, half, contact, filled, meshing, element)
        if picked.fidelity not in FIDELITIES:
            raise InputError(f"fidelity = {fidelity!r}: must be one of {', '.join(FIDELITIES)} for "
                             f"a {type(self).__name__}")
        rung = FIDELITIES[picked.fidelity]
        super().__init__(picked, comm)
        self.geometry, self.material = geometry, material
        self.multiplicity = 2 if half else 1
        self.body = Elastomer(
            self.comm,
            geometry.mesh(meshing or fitted(geometry, rung, self.fidelity, self.comm), half),
            material,
            element_named(element or rung.element),
            clamped=("root",),
            symmetry={"symmetry": 0} if half else None,
        )
        self.contact = in_chambers(self.body) if contact else None
        blocks = [part.block for part in self._parts()]
        self._filled = None
        if filled is not None:
            self._filled = FilledChambers(
                self.body, geometry.chamber_of, filled, 1.0 / self.multiplicity)
            # Unknowns before what stands for others'.
            blocks[1:1] = self._filled.own_blocks
            blocks += self._filled.seen_blocks
        self.system = EquilibriumSystem(self.comm, blocks)
        if self._filled is not None:
            self._filled.number(self.system)
        self._options_prefix = options_prefix

    def inflate(
        self,
        upper: float | Sequence[float] | None = None,
        lower: float | Sequence[float] | None = None,
        on_step: Callable[[State], None] | None = None,
        on_cut: Callable[..., None] | None = None,
        restart: str | os.PathLike | None = None,
        resume: str | os.PathLike | None = None,
    ) -> Path:
        """Inflate the chambers of the upper and the lower row.

        Parameters
        ----------
        upper, lower
            Pressures in MPa: a number, a sequence of them, or None (no pressure, and no cost).
        on_step, on_cut, restart, resume
            See `Scene.follow`.

        Returns
        -------
        Path
            All converged steps; ``path.converged`` tells whether the last pressure was reached.

        Raises
        ------
        InputError
            If a pressure is not a finite number.
        """
        if self._filled is not None:
            raise InputError(
                f"filled = {self._filled.filling!r}: must be None where pressures are given")
        loads = {"upper_MPa": upper, "lower_MPa": lower}
        return self.follow(loads, on_step, on_cut, restart, resume)

    def fill(
        self,
        upper: float | Sequence[float] | None = None,
        lower: float | Sequence[float] | None = None,
        on_step: Callable[[State], None] | None = None,
        on_cut: Callable[..., None] | None = None,
        restart: str | os.PathLike | None = None,
        resume: str | os.PathLike | None = None,
    ) -> Path:
        """Fill the chambers of the upper and the lower row with volumes, past limit points.

        The pressure is found: ``pressure_MPa`` in the table, with what tells of one chamber that
        balloons alone, see `morphing_wing.filled.FilledChambers.measures`. A state is stable under
        a given volume if it has no surplus negative pivots; under a given pressure it is not where
        the pressure falls.

        Parameters
        ----------
        upper, lower
            Volumes in mm^3 beyond those at rest, of a whole row: a number, a sequence of them, or
            None: an open row, without pressure. What is open or filled at first remains so.
        on_step, on_cut, restart, resume
            See `Scene.follow`.

        Raises
        ------
        InputError
            If the spar was not made with ``filled``, a volume is not a finite number, or a row was
            open before that is to be filled now, or the other way round.
        """
        if self._filled is None:
            raise InputError(f"filled = None: must be one of {', '.join(FILLINGS)} to fill a spar")
        loads = {"upper_mm3": upper, "lower_mm3": lower}
        self.primary_load = next((n for n, v in loads.items() if v is not None), "upper_mm3")
        path = self.follow(loads, on_step, on_cut, restart, resume)
        if len(path) and not path.converged:
            path.reason += self._filled.localised(path[-1].measures)
        return path

    # -- for the pictures ---------------------------------------------------------------------

    @property
    def functions(self) -> dict[str, fem.Function]:
        """Displacement in mm by name."""
        return {"elastomer": self.body.displacement()}

    def description(self) -> dict[str, Any]:
        """Return all parameters, for `summary.json`."""
        return {
            "geometry": asdict(self.geometry),
            "material": asdict(self.material),
            "element": self.body.element.name,
            "half_model": self.multiplicity == 2,
            "contact": self.contact is not None,
        } | ({} if self._filled is None else {"filled": self._filled.filling})

    def _wanted(
        self, loads: Mapping[str, Any], targets: Sequence[Mapping[str, float]]
    ) -> tuple[str, ...]:
        if self._filled is None:
            return super()._wanted(loads, targets)
        return tuple(name for name in self.load_names if loads[name] is not None)

    # -- what the scene is made of ------------------------------------------------------------

    def _iterates(self) -> list[Iterate]:
        return [part.iterate for part in self._parts() if part.iterate is not None]

    def _newton(self) -> Newton:
        return Newton(
            self.system,
            self._options_prefix,
            expected_negative=self.body.n_pressures() + (self._filled.count if self._filled else 0),
            max_iterations=25 if self.contact is None else 60,
            before_tangent=self.before_tangent,
            admissible=self.admissible if self.contact is not None else None,
        )

    def _functional(self, in_use: tuple[str, ...]) -> tuple[list[Any], Any]:
        if self._filled is None:
            self._chambers = Chambers(self.body, in_use, self._cut)
            self.loads, potentials = self._chambers.pressures, self._chambers.potentials
        else:
            self.loads, potentials = self._filled.use(in_use)
        corrections = {self.system.blocks.index(part.block): part.tangent_correction
                       for part in self._parts()}
        return [part.energy for part in self._parts()] + potentials, corrections

    def _stored(self) -> list[Any]:
        return [part.energy for part in self._parts()]

    def _parts(self) -> list[Any]:
        """Return what stores energy, in the order of the blocks."""
        return [self.body] if self.contact is None else [self.body, self.contact]

    def masses(self) -> list[np.ndarray]:
        """Return the lumped mass in kg on each owned unknown."""
        weightless = [np.zeros(block.n_owned) for block in self.kept_blocks[1:]]
        return [mass_density(self.material.density) * self.body.lumped_volume(), *weightless]

    def _conjugates(self) -> dict[str, float]:
        return self._chambers.volumes() if self._filled is None else self._filled.conjugates()

    def _measures(self) -> dict[str, float]:
        tip = self.body.mean_displacement("tip")
        found = {
            "span_angle_deg": rotation_about_x(self.body.mean_normal("tip")),
            "span_line_deg": deflection_line(tip, np.array([0.0, 0.0, self.geometry.length])),
        }
        if self.contact is not None:
            found |= self.contact.measures()
            found["contact_force_N"] *= self.multiplicity
        if self._filled is not None:
            found |= self._filled.measures()
        return found
