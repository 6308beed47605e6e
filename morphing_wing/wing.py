"""The whole wing as a scene: elastomer, ribs, glue and cables in one set of equations."""

from __future__ import annotations

import os
from collections.abc import Callable, Mapping, Sequence
from dataclasses import asdict
from typing import Any

import numpy as np
from dolfinx import fem
from mpi4py import MPI

from .bar_mesh import BarMesh
from .cables import Cables
from .chambers import Chambers
from .drawing import Drawing
from .elastomer import Elastomer
from .elements import element as element_named
from .errors import require
from .forms.gravity import mass_density
from .geometry.rib import RibGeometry
from .geometry.wing import WingGeometry
from .geometry.wing_mesh import WingMeshing, wing_mesh
from .glue import Glue
from .inertia import Regularisation
from .iterate import Iterate
from .ladder import AUTO, Pick, pick
from .materials import DRAGON_SKIN_30, RESIN, Adhesive, Elastic, Yeoh
from .newton import Newton
from .path import Path, State
from .pocket import in_pocket
from .solid_ribs import SolidRibs
from .system import EquilibriumSystem
from .tension import check_tension
from .weight import Weight
from .wing_angles import wing_angles
from .wing_drawing import wing_drawing
from .wing_rungs import FIDELITIES, checked_model, made_ribs
from .wing_trim import TrimmedWing


class Wing(TrimmedWing):
    """A wing clamped at its root section.

    Parameters
    ----------
    geometry
        Dimensions; ``skin_thickness=None`` and ``rib=None`` leave out skin and ribs.
    elastomer, resin
        Materials of spar and skin, and of the ribs.
    fidelity
        "draft" (linear hexahedra, fine mesh, enhanced strains in the skin), "standard" (quadratic
        hexahedra), both with frame ribs, or "reference" (quadratic ones that resolve the walls,
        cell ribs). "auto": the cheapest one that fits the tolerance.
    comm
        Communicator; all ranks of MPI by default.
    meshing, element
        Replace those of the fidelity.
    rib_model
        Of any fidelity "frame" (beams), "cell" (chains of one cell's condensed solid) or "solid" in
        place of its own.
    around
        Elements around a pivot of solid ribs or cells; None: 6 and 18.
    contact
        Whether the pocket's sides and the ribs press against each other. Without, ``contact`` in
        the path's table says from where on they pass through each other.
    adhesive
        Law of the glue; None: elastic with the geometry's ``glue_stiffness``.
    options_prefix
        Prefix of this scene's PETSc options.
    tolerance
        Relative error that "auto" may have, see `morphing_wing.ladder.pick`.

    Examples
    --------
    >>> wing = Wing(WingGeometry.prototype(), fidelity="draft")     # doctest: +SKIP
    >>> wing.actuate(upper=0.025, cable=0.2).save("output")         # doctest: +SKIP
    """

    name = "wing"
    load_names = ("upper_MPa", "lower_MPa", "cable_N", "gravity_g")

    def __init__(
        self,
        geometry: WingGeometry,
        elastomer: Yeoh = DRAGON_SKIN_30,
        resin: Elastic = RESIN,
        fidelity: str = "draft",
        comm: MPI.Comm | None = None,
        meshing: WingMeshing | None = None,
        element: str | None = None,
        options_prefix: str = "wing_",
        contact: bool = True,
        adhesive: Adhesive | None = None,
        tolerance: float | None = None,
        around: int | None = None,
        rib_model: str | None = None,
    ) -> None:
        picked = pick("wing", fidelity, tolerance, geometry.n_cells)
        if any(given is not None for given in (meshing, element, around, rib_model)):
            require(fidelity != AUTO, "fidelity", fidelity, "", "a rung's name with a mesh, an "
                    "element or a rib_model of one's own")
            picked = Pick(picked.fidelity, None)
        rung = FIDELITIES[picked.fidelity]
        model, around = checked_model(rung.rib_model if rib_model is None else rib_model, around)
        prestretch = tuple(geometry.skin_prestretch) if geometry.is_prestretched else None
        if prestretch is not None:
            self.load_names = (*self.load_names, "prestretch_part")
        super().__init__(picked, comm)
        self.geometry, self.elastomer, self.resin = geometry, elastomer, resin
        self._options_prefix = options_prefix
        self.rib_model = model
        self.ribs: BarMesh | SolidRibs | None = None
        self.glue: Glue | None = None
        self.body = Elastomer(
            self.comm, wing_mesh(geometry, meshing or rung.meshing), elastomer,
            element_named(element or rung.element), clamped=("root",), thin=("skin",),
            prestretch=prestretch,
        )
        unknowns = [self.body.block]
        if geometry.rib is not None:
            self.ribs = made_ribs(self.comm, geometry, resin, model, around, options_prefix)
            law = adhesive or Adhesive(geometry.glue_stiffness)
            self.glue = Glue(self.body, self.ribs, geometry, law)
            unknowns += self.ribs.unknowns
        self.pocket = in_pocket(self.body, self.ribs) if self.has_skin else None
        self.contact = self.pocket if contact else None
        local = [part.block for part in self._parts() if part.block.local]
        self.system = EquilibriumSystem(self.comm, unknowns + local)
        for part in (self.ribs, self.glue):
            if part is not None:
                part.join(self.system)

    @property
    def has_skin(self) -> bool:
        """Whether the wing has a skin around its pocket."""
        return self.geometry.skin_thickness is not None

    def actuate(
        self,
        upper: float | Sequence[float] | None = None,
        lower: float | Sequence[float] | None = None,
        cable: float | Sequence[float] | None = None,
        gravity: float | Sequence[float] | None = None,
        on_step: Callable[[State], None] | None = None,
        on_cut: Callable[..., None] | None = None,
        restart: str | os.PathLike | None = None,
        resume: str | os.PathLike | None = None,
    ) -> Path:
        """Inflate chambers, pull cables, let elastomer and ribs weigh.

        Parameters
        ----------
        upper, lower
            Pressures in MPa in the two rows of chambers: numbers, sequences or None.
        cable
            Tension in N in the cable of each rib: a number, a sequence or None.
        gravity
            Weight along -y in multiples of standard gravity: a number, a sequence or None.
        on_step, on_cut, restart, resume
            See `Scene.follow`.

        Returns
        -------
        Path
            All converged steps. A skin with prestretch is built in first, in steps that are not
            among them unless they fail; what that stores is in the energy, not in the external
            work. ``touching``, ``gap_mm``, ``contact_force_N`` and ``penetration_mm`` in the table
            tell of contact; with ``contact=False``, ``contact`` is true from where the skin passes
            through itself or a rib.

        Raises
        ------
        InputError
            If a load is not finite, a tension negative, or cables are pulled in a wing without
            ribs.
        """
        check_tension(cable, ribs=self.ribs is not None)
        loads = {"upper_MPa": upper, "lower_MPa": lower, "cable_N": cable,
                 "gravity_g": gravity}
        if self.body.prestretch is not None:
            loads["prestretch_part"] = 1.0
            if resume is None and self._load["prestretch_part"] == 0.0:
                built_in = self.follow({"prestretch_part": 1.0})
                if not built_in.converged:
                    return built_in
        return self.follow(loads, on_step, on_cut, restart, resume)

    def rib_places(self) -> tuple[RibGeometry, np.ndarray, bool]:
        """Return the ribs, where their roots are, (n, 3) in mm, and whether they are halves."""
        return self.geometry.rib, self.geometry.rib_roots(), False

    # -- for the pictures ---------------------------------------------------------------------

    @property
    def functions(self) -> dict[str, fem.Function]:
        """Displacement in mm by name."""
        found = {"elastomer": self.body.displacement()}
        return found | ({"ribs": self.ribs.function} if self.ribs else {})

    def drawing(self, state: State) -> Drawing:
        """Return how to draw the present state: cuts, bars as tubes, cables as lines."""
        return wing_drawing(self, state)

    def description(self) -> dict[str, Any]:
        """Return all parameters, for `summary.json`."""
        return {
            "geometry": asdict(self.geometry),
            "elastomer": asdict(self.elastomer),
            "resin": asdict(self.resin),
            "adhesive": asdict(self.glue.law) if self.glue is not None else None,
            "contact": self.contact is not None,
            "rib_model": self.rib_model if self.ribs is not None else None,
            "element": self.body.element.name,
        }

    def accept(self) -> None:
        """Take the present state as converged."""
        super().accept()
        if self.glue is not None:
            self.glue.accept()

    def memory(self) -> dict[str, Any]:
        """Return what a next step inherits beside loads and unknowns; the same on all ranks."""
        broken = self.glue is not None and self.glue.law.fails
        return super().memory() | ({"glue": self.glue.history.tolist()} if broken else {})

    def recall(self, memory: Mapping[str, Any]) -> None:
        """Take over what `memory` returned, also in an earlier run."""
        super().recall(memory)
        if "glue" in memory:
            self.glue.recall(memory["glue"])

    # -- what the scene is made of ------------------------------------------------------------

    def _iterates(self) -> list[Iterate]:
        return [part.iterate for part in self._parts() if part.iterate is not None]

    def _newton(self) -> Newton:
        return Newton(
            self.system,
            self._options_prefix,
            regularisation=self._regularisation(),
            expected_negative=self.body.n_pressures(),
            max_iterations=40 if self.has_skin else 25,
            before_tangent=self.before_tangent,
            admissible=self.admissible if self.contact is not None else None,
        )

    def _regularisation(self) -> Regularisation | None:
        if not self.has_skin:
            return None
        n = self.body.block.n_owned
        mass = np.zeros(self.system.n_owned)
        mass[:n] = self.body.lumped_volume("skin")
        displacements = np.zeros(self.system.n_owned, dtype=bool)
        displacements[:n] = self.body.is_displacement()
        return Regularisation(mass, displacements)

    def _functional(self, in_use: tuple[str, ...]) -> tuple[list[Any], Any]:
        self._chambers = Chambers(self.body, in_use)
        self.loads = dict(self._chambers.pressures)
        energies = [part.energy for part in self._parts()] + self._chambers.potentials
        if "cable_N" in in_use:
            self._cables = Cables(self.ribs, self.geometry.cable_guide)
            self.loads["cable_N"] = [self._cables.tension]
            energies.append(self._cables.potential)
        if "prestretch_part" in in_use:
            self.loads["prestretch_part"] = [self.body.prestretch.part]
        if "gravity_g" in in_use:
            self._weight = Weight(self.body, self.ribs)
            self.loads["gravity_g"] = self._weight.multiples
            energies += self._weight.potentials
        return energies, self._corrections(self._parts())

    def _stored(self) -> list[Any]:
        return [getattr(part, "stored", part.energy) for part in self._parts()]

    def _parts(self) -> list[Any]:
        """Return what stores energy."""
        ribs = self.ribs.parts if self.ribs is not None else ()
        return [part for part in (self.body, *ribs, self.glue, self.contact) if part is not None]

    def masses(self) -> list[np.ndarray]:
        """Return the lumped mass in kg on each owned unknown, of the elastomer and the ribs."""
        found = [mass_density(self.elastomer.density) * self.body.lumped_volume()]
        if self.ribs is not None:
            resin = mass_density(self.resin.density)
            found += [resin * part.lumped_volume() for part in self.ribs.parts]
        return found

    def _conjugates(self) -> dict[str, float]:
        found = self._chambers.volumes()
        if "cable_N" in self.loads:
            found["cable_N"] = self._cables.shortening()
        if "gravity_g" in self.loads:
            found["gravity_g"] = self._weight.fall()
        return found

    # -- what is measured ---------------------------------------------------------------------

    def _measures(self) -> dict[str, float]:
        found = wing_angles(self.geometry, self.body, self.ribs)
        if self.glue is not None:
            found |= self.glue.measures()
        if self.contact is not None:
            found |= self.contact.measures()
        elif self.pocket is not None:
            gap = self.pocket.smallest_gap()
            found |= {"gap_mm": gap, "contact": float(gap < 0.0)}
        return found
