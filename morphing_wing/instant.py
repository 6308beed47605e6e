"""Scenes that are the paper's formulas: no mesh, no unknowns, microseconds."""

from __future__ import annotations

import os
import time
from collections.abc import Callable, Mapping, Sequence
from dataclasses import asdict
from typing import Any, NoReturn

import numpy as np
from mpi4py import MPI

from .analytic_rib import rib_compliance
from .analytic_spar import SparFormula
from .arc_line import arc_line
from .errors import InputError, plain
from .geometry.rib import RibGeometry
from .geometry.spar import SparGeometry
from .ladder import AUTO, pick
from .materials import DRAGON_SKIN_30, RESIN, Elastic, Yeoh
from .path import Path, State
from .rib import Rib
from .scene import Scene
from .spar import Spar
from .spar_rungs import pick_of
from .stepping import REACHED
from .targets import load_targets, load_words


class Formula:
    """What scenes without a mesh share: nothing to draw, to vibrate, to resume."""

    dofs = 0
    functions: Mapping[str, Any] = {}
    fidelity: str

    def _set_up(self, asked: str, **left_out: Any) -> None:
        self._asked = asked
        for name, value in left_out.items():
            if value is not None:
                raise InputError(f"{name} = {value!r}: must be left out {self._where}")

    @property
    def _where(self) -> str:
        auto = ', which "auto" took' if self._asked == AUTO else ""
        return f'where fidelity is "{self.fidelity}"{auto}'

    @property
    def system(self) -> NoReturn:
        """There is none."""
        raise InputError(f"fidelity = {self.fidelity!r}: must be another one here, a formula "
                         "without a field of displacements")

    def linearise(self) -> NoReturn:
        """Refuse: there is no tangent of a mesh."""
        return self.system

    def fill(self, *_: Any, **__: Any) -> NoReturn:
        """Refuse: there are no chambers."""
        return self.system

    def _led(
        self,
        targets: Sequence[Mapping[str, float]],
        solved: Callable[[Mapping[str, float]], tuple[dict[str, float], float] | str],
        on_step: Callable[[State], None] | None,
        resume: str | os.PathLike | None,
    ) -> Path:
        """Return the path of measures and stored energies of each load, up to a reason to stop."""
        if resume is not None:
            raise InputError(f"resume = {os.fspath(resume)!r}: must be left out {self._where}; it "
                             "leaves nothing to resume")
        begin, states, reason = time.perf_counter(), [], REACHED
        for load in targets:
            clock = time.perf_counter()
            found = solved(load)
            if isinstance(found, str):
                reason = found
                break
            measures, energy = found
            states.append(State(
                dict(load), measures, newton_iterations=0, energy_Nmm=energy,
                external_work_Nmm=energy, negative_pivots=0,
                step_seconds=time.perf_counter() - clock, requested=True, scene=self))
            if on_step is not None:
                on_step(states[-1])
        return Path(states, self, len(states) == len(targets), reason, time.perf_counter() - begin)


class InstantSpar(Formula, Spar):
    """The spar by Eqs 6-12, see `morphing_wing.analytic_spar`: pressure in one row.

    ``Spar(..., fidelity="instant")`` makes one, with the same options; those that a formula cannot
    have must be left out.
    """

    def __init__(
        self,
        geometry: SparGeometry,
        material: Yeoh = DRAGON_SKIN_30,
        fidelity: str = "instant",
        comm: MPI.Comm | None = None,
        *,
        half: bool = True,
        meshing: Any = None,
        element: str | None = None,
        options_prefix: str = "",
        contact: bool = False,
        filled: str | None = None,
        tolerance: float | None = None,
    ) -> None:
        picked = pick_of(geometry, fidelity, tolerance, half, contact, filled, meshing, element)
        Scene.__init__(self, picked, comm)
        self._set_up(fidelity, meshing=meshing, element=element)
        self.geometry, self.material, self.multiplicity = geometry, material, 1
        self._filled = None
        self._formula = SparFormula(geometry, material)

    def inflate(self, upper=None, lower=None, on_step=None, on_cut=None, restart=None,
                resume=None) -> Path:  # fmt: skip
        """Return the formula's angles; see `Spar.inflate`. Nothing is written for a restart."""
        targets = load_targets(self.load_names, {"upper_MPa": upper, "lower_MPa": lower})
        for load in targets:
            if min(load.values()) < 0.0 or all(load.values()):
                raise InputError(f"{load_words(load)}: must be 0 MPa or more, and in one row only, "
                                 f"{self._where}")
        return self._led(targets, self._solved, on_step, resume)

    def _solved(self, load: Mapping[str, float]) -> tuple[dict[str, float], float] | str:
        pressure = load["upper_MPa"] or load["lower_MPa"]
        turn = self._formula.turn(pressure)
        if np.isnan(turn):
            return (f"the formula goes to {1000 * self._formula.largest_pressure:.4g} kPa at most, "
                    f"{1000 * pressure:.4g} kPa were asked for")
        angle = (-1.0 if load["lower_MPa"] else 1.0) * self.geometry.n_cells * turn
        measures = {"span_angle_deg": np.degrees(angle), "span_line_deg": arc_line(angle)}
        return ({name: float(value) for name, value in measures.items()},
                float(self._formula.energy(turn)))

    def description(self) -> dict[str, Any]:
        """Return all parameters, for `summary.json`."""
        return {"geometry": asdict(self.geometry), "material": asdict(self.material),
                "equations": "6-12"}


class InstantRib(Formula, Rib):
    """The rib by Eqs 13-18, mended, see `morphing_wing.analytic_rib`: moments only.

    ``Rib(..., fidelity="instant")`` makes one.
    """

    def __init__(
        self,
        geometry: RibGeometry,
        material: Elastic = RESIN,
        fidelity: str = "instant",
        comm: MPI.Comm | None = None,
        options_prefix: str = "",
        tolerance: float | None = None,
        around: int | None = None,
    ) -> None:
        picked = pick("rib", fidelity, tolerance, geometry.n_cells)
        Scene.__init__(self, picked, comm)
        self._set_up(fidelity, around=around)
        self.geometry, self.material = geometry, material
        self.primary_load = "torque_Nmm"
        self._compliance = rib_compliance(geometry, material)

    def bend(self, torque, on_step=None, on_cut=None, restart=None, resume=None) -> Path:
        """Return the formula's angles; see `Rib.bend`. Nothing is written for a restart."""
        targets = load_targets(self.load_names, {"torque_Nmm": torque})
        return self._led(targets, self._solved, on_step, resume)

    def pull(self, cable: Any, *_: Any, **__: Any) -> NoReturn:
        """Refuse: the formula is of a moment."""
        raise InputError(f"cable = {plain(cable)} N: must be a torque {self._where}")

    def _solved(self, load: Mapping[str, float]) -> tuple[dict[str, float], float]:
        angle = np.radians(self._compliance * load["torque_Nmm"])
        measures = {"chord_angle_deg": np.degrees(angle), "chord_line_deg": arc_line(angle)}
        return ({name: float(value) for name, value in measures.items()},
                0.5 * load["torque_Nmm"] * float(angle))

    def description(self) -> dict[str, Any]:
        """Return all parameters, for `summary.json`."""
        return {"geometry": asdict(self.geometry), "material": asdict(self.material),
                "equations": "13-18, Eqs 14 and 17.2 with their dimensions mended"}
