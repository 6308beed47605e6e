"""The pantographic rib as a chain of one cell's solid, condensed to its cut sections."""

from __future__ import annotations

import os
import time
from collections.abc import Callable, Mapping, Sequence
from dataclasses import asdict, dataclass
from typing import Any

import numpy as np

from .angles import deflection_line, rotation_about_z
from .condensation import condensed
from .fieldless import Fieldless
from .newton import NewtonResult
from .path import Path, State
from .pulled_chain import Pull, compliance, displacements, equilibrium
from .rib import Rib
from .rib_chain import RibChain
from .stepping import follow
from .targets import load_targets

AROUND = {"cell": 24}
"""Elements around a cylinder: one cell may be finer than a whole rib."""


class CondensedRib(Fieldless, Rib):
    """A rib whose cells are all one, cut out of half a solid, in small strains.

    ``Rib(..., fidelity="cell")`` makes one. As in the solid the root section is clamped and the
    tail section moves as a rigid plate. Root, cell and tail are condensed once in a process for all
    ribs that differ in the number of cells and Young's modulus alone; a load then takes a
    millisecond. There is no field, and nothing is written for a restart.
    """

    kind = "a chain of condensed cells"
    multiplicity = 2
    _around = AROUND

    def _build(self) -> None:
        self._pieces = condensed(self.comm, self.geometry, self.material.nu, self.around,
                                 self._options_prefix + "factor_")
        self.chain = RibChain(self.geometry, self._pieces, self.material.E)
        self._y = np.zeros(len(self.chain.stiffness))

    def _held(self, place: np.ndarray) -> Any:
        return _Place(place)

    @property
    def dofs(self) -> int:
        """Unknowns of the chain."""
        return self.chain.dofs

    def description(self) -> dict[str, Any]:
        """Return all parameters, for `summary.json`."""
        return {
            "geometry": asdict(self.geometry),
            "material": asdict(self.material),
            "element": "root, cell and tail condensed, P2 in curved tetrahedra",
            "mesh_dofs": self._pieces.dofs,
            "guide_mm": [float(x) for x in self._guide.value],
        }

    def follow(
        self,
        loads: Mapping[str, float | Sequence[float] | None],
        on_step: Callable[[State], None] | None = None,
        on_cut: Callable[[Mapping[str, float], str], None] | None = None,
        restart: str | os.PathLike | None = None,
        resume: str | os.PathLike | None = None,
    ) -> Path:
        """Lead the rib from where it is through wanted loads; see `Scene.follow`."""
        self._check_resume(resume)
        targets, clock = load_targets(self.load_names, loads), time.perf_counter()
        in_use = self._wanted(loads, targets)
        if in_use != self._in_use:
            self._in_use = in_use
            self._work.stand(self._load, self._conjugates())
        if not self._work.knows_compliance:
            self._work.learn(self._compliance())
        states, converged, reason = follow(
            self, self._load, targets, self.stepping, on_step, on_cut)
        return Path(states, self, converged, reason, time.perf_counter() - clock)

    # -- for the stepping ---------------------------------------------------------------------

    def set_load(self, load: Mapping[str, float]) -> None:
        """Set all loads."""
        self._load = dict(load)

    def solve(self) -> NewtonResult:
        """Find the equilibrium of the present loads from the present state."""
        self._y, result = equilibrium(self.chain, self._y, self._pull)
        return result

    def unknowns(self) -> list[np.ndarray]:
        """Return a copy of the chain's unknowns."""
        return [self._y.copy()]

    def set_unknowns(self, values: Sequence[np.ndarray]) -> None:
        """Set the chain's unknowns."""
        self._y = values[0].copy()

    def accept(self) -> None:
        """Nothing is remembered of a converged state."""

    def state(
        self, load: Mapping[str, float], result: NewtonResult, seconds: float, requested: bool
    ) -> State:
        """Measure the present state, and add the work on the way to it."""
        self._work.add(load, self._conjugates(), self._compliance())
        state = State(
            load=dict(load),
            measures=self._measures(),
            newton_iterations=result.iterations,
            energy_Nmm=float(0.5 * self._y @ self.chain.stiffness @ self._y),
            external_work_Nmm=self._work.amount,
            negative_pivots=result.negative_pivots,
            step_seconds=seconds,
            requested=requested,
        )
        for measure in self.watch:
            measure(state)
        return state

    # -- internals ----------------------------------------------------------------------------

    @property
    def _tail_place(self) -> np.ndarray:
        return np.array([self.geometry.length, 0.0, 0.0])

    @property
    def _pull(self) -> Pull:
        return Pull(self._load["torque_Nmm"], self._load["cable_N"],
                    self._tail_place + self._guide.value)

    def _compliance(self) -> np.ndarray:
        return compliance(self.chain, self._y, self._pull, self._work.names)

    def _conjugates(self) -> dict[str, float]:
        found = displacements(self.chain, self._y, self._pull)
        return {name: found[name] for name in self._in_use}

    def _measures(self) -> dict[str, float]:
        moved = np.append(self.chain.tail(self._y)[0], 0.0) - self._tail_place
        turn = self._y[-1]
        return {
            "chord_angle_deg": rotation_about_z(np.array([np.cos(turn), np.sin(turn), 0.0])),
            "chord_line_deg": deflection_line(moved, self._tail_place),
        }


@dataclass
class _Place:
    """A place in mm that may change."""

    value: np.ndarray
