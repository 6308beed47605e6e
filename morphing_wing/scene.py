"""What all scenes share: loads by name, the equations, stepping, and the path that comes out."""

from __future__ import annotations

import os
import time
from abc import ABC, abstractmethod
from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from functools import cached_property
from typing import Any

import numpy as np
from mpi4py import MPI
from petsc4py import PETSc

from . import compat
from . import restart as restart_files
from .blocks import Block
from .contact import Contact
from .errors import InputError
from .inertia import InertiaCholesky
from .iterate import Iterate
from .ladder import Pick
from .load_force import load_force
from .newton import Newton, NewtonResult
from .path import Path, State
from .sensitivity import compliance
from .stepping import Standing, Stepping, follow
from .system import EquilibriumSystem
from .targets import load_targets
from .work import ExternalWork

MOST_ROUNDS = 6
"""Solves of one load step between which the pairs in contact may change."""


class Scene(ABC):
    """A structure with named loads that can be led along a path of equilibria.

    A subclass builds ``system``, returns its solver from ``_newton``, and says in ``_functional``
    which energies the loads in use require, in ``_measures`` what is measured, in ``_conjugates``
    the displacement that each load works on.

    Attributes
    ----------
    name, fidelity, comm
        What, how finely, and on which ranks.
    error_estimate
        Relative error of the angle that was measured of this fidelity; None: it was not.
    multiplicity
        How often the modelled part stands in the whole: 2 for a half model.
    contact
        What may touch; None: nothing does, or its forces are left out.
    watch
        Called with each new state, to add to its measures; see `morphing_wing.limits.Limits`.
    """

    name = "scene"
    primary_load = "pressure_MPa"
    load_names: tuple[str, ...] = ()
    stepping = Stepping()
    multiplicity = 1
    led = False  # whether loads are volumes, and pressures unknowns

    system: EquilibriumSystem
    contact: Contact | None = None

    def __init__(self, rung: Pick, comm: MPI.Comm | None) -> None:
        self.fidelity, self.error_estimate = rung.fidelity, rung.error
        self.comm = comm or MPI.COMM_WORLD
        self.loads: dict[str, Any] = {}
        self.watch: list[Callable[[State], None]] = []
        self._in_use: tuple[str, ...] | None = None
        self._load = dict.fromkeys(self.load_names, 0.0)
        self._work = ExternalWork(self.led)
        self._largest_force = 0.0

    # -- for users ----------------------------------------------------------------------------

    @property
    def dofs(self) -> int:
        """Global number of unknowns."""
        return self.system.size

    @property
    def kept_blocks(self) -> list[Block]:
        """Blocks whose functions are kept with a state; those of the others follow from them."""
        return [block for block in self.system.blocks if not block.local]

    @cached_property
    def newton(self) -> Newton:
        """The solver, made when it is first needed. Collective then."""
        return self._newton()

    def follow(
        self,
        loads: Mapping[str, float | Sequence[float] | None],
        on_step: Callable[[State], None] | None = None,
        on_cut: Callable[[Mapping[str, float], str], None] | None = None,
        restart: str | os.PathLike | None = None,
        resume: str | os.PathLike | None = None,
    ) -> Path:
        """Lead the scene from where it is through wanted loads.

        Parameters
        ----------
        loads
            Of each load by name a number, a sequence of them, or None for none; broadcast together.
        on_step, on_cut
            Called on every rank after each converged step, and after each step that was cut.
        restart
            Folder (or .npz file) in which each converged step leaves what it takes to resume.
        resume
            Such a folder or file: go on after the last step in it, on any number of ranks. The
            path begins with its states, without the fields of all but the last.
        """
        targets = load_targets(self.load_names, loads)
        clock = time.perf_counter()
        earlier = None if resume is None else restart_files.read(resume, self)
        if earlier is not None:
            earlier.check(targets)
            self._stand_at(earlier)
        done, spent = ([], 0.0) if earlier is None else (earlier.states, earlier.seconds)

        def keep(standing: Standing, states: list[State]) -> None:
            if restart is not None:
                seconds = spent + time.perf_counter() - clock
                restart_files.write(restart, self, done + states, standing, seconds)

        in_use = self._wanted(loads, targets)
        if in_use != self._in_use:
            self._use(in_use)
        if earlier is not None:
            self.recall(earlier.memory)
        if not self._work.knows_compliance:
            self._work.learn(compliance(self, self.linearise(), self._work.names))
        elif earlier is not None and self.newton.reuses:
            self.linearise()  # there is no factor yet to begin with
        states, converged, reason = follow(
            self, self._load, targets, self.stepping, on_step, on_cut, keep,
            earlier and earlier.standing,
        )
        if states:
            self._load = dict(states[-1].load)
        seconds = spent + time.perf_counter() - clock
        return Path(done + states, self, converged, reason, seconds)

    def _wanted(
        self, loads: Mapping[str, Any], targets: Sequence[Mapping[str, float]]
    ) -> tuple[str, ...]:
        """Return the loads to bring into use: those that are or become other than zero."""
        return tuple(n for n in self.load_names
                     if self._load[n] != 0.0 or any(t[n] != 0.0 for t in targets))

    def stiffness_left(self, loads: Sequence[str]) -> float:
        """Return the stiffness against loads in use over that at rest: 0 at a limit point."""
        return self._work.stiffness_left(loads)

    # -- for the stepping ---------------------------------------------------------------------

    def set_load(self, load: Mapping[str, float]) -> None:
        """Set all loads."""
        for name, constants in self.loads.items():
            for constant in constants:
                constant.value = load[name]

    def solve(self) -> NewtonResult:
        """Find the equilibrium of the present loads from the present state."""
        self._take_up_contact()
        self._largest_force = max(self._largest_force, load_force(self.system, self.loads))
        result = self.newton.solve(self._largest_force)
        iterations, rounds = result.iterations, 1
        while result.converged and self.contact is not None and self.contact.review(self.system):
            self.newton.renew()
            if rounds == MOST_ROUNDS:
                reason = f"what touches what still changed after {rounds} solves"
                return replace(result, converged=False, reason=reason, iterations=iterations)
            result = self.newton.solve(self._largest_force)
            iterations, rounds = iterations + result.iterations, rounds + 1
        return replace(result, iterations=iterations)

    def unknowns(self) -> list[np.ndarray]:
        """Return copies of the rank-local values of all functions."""
        return [block.function.x.array.copy() for block in self.system.blocks]

    def set_unknowns(self, values: Sequence[np.ndarray]) -> None:
        """Set the rank-local values of all functions."""
        for block, array in zip(self.system.blocks, values, strict=True):
            block.function.x.array[:] = array
        self.system.share()
        if self.contact is not None:
            self.contact.iterate.accept()

    def accept(self) -> None:
        """Take the present state as converged."""
        for iterate in self._iterates():
            iterate.accept()

    def admissible(self, x: PETSc.Vec, step: PETSc.Vec) -> float:
        """Return which part of a Newton step, from x to x - step, to take."""
        return self.contact.admissible(self.system, x, step)

    def before_tangent(self, iteration: int) -> None:
        """Tell all iterates that a tangent is about to be assembled."""
        for iterate in self._iterates():
            iterate.before_tangent(iteration)

    def state(
        self, load: Mapping[str, float], result: NewtonResult, seconds: float, requested: bool
    ) -> State:
        """Measure the present state, and add the work on the way to it."""
        factor = self.newton.factor if self.newton.factor.exists else self.linearise()
        self._work.add(load, self._conjugates(), compliance(self, factor, self._work.names))
        return self._measured(load, result, seconds, requested)

    def _measured(
        self, load: Mapping[str, float], result: NewtonResult, seconds: float, requested: bool
    ) -> State:
        state = State(
            load=dict(load),
            measures=self._measures(),
            newton_iterations=result.iterations,
            energy_Nmm=self.multiplicity * sum(self._stored_energies()),
            external_work_Nmm=self.multiplicity * self._work.amount,
            negative_pivots=result.negative_pivots,
            step_seconds=seconds,
            requested=requested,
            fields={b.function.name: b.function.x.array.copy() for b in self.kept_blocks},
        )
        for measure in self.watch:
            measure(state)
        return state

    def present(self) -> State:
        """Return the state in which the scene stands, converged before."""
        as_it_is = NewtonResult(True, "converged", 0, 0.0, self.newton.factor.surplus)
        return self._measured(self._load, as_it_is, 0.0, requested=True)

    def show(self, state: State) -> None:
        """Copy a state's fields into the functions."""
        for block in self.kept_blocks:
            block.function.x.array[:] = state.fields[block.function.name]
        self.system.share()

    # -- for sensitivities and modes ----------------------------------------------------------

    def linearise(self) -> InertiaCholesky:
        """Return the factor of the tangent where the scene stands, converged before."""
        if self._in_use is None:
            raise InputError(f"{self.name}: must have been led to a load first")
        self._take_up_contact()  # a step that failed since has left other pairs
        return self.newton.linearise()

    def take_into_use(self, loads: Sequence[str]) -> None:
        """Bring more loads into use, beside those that are."""
        self._use(tuple(n for n in self.load_names if n in self.loads or n in loads))

    def angles(self) -> dict[str, float]:
        """Return the angles of the present state in degrees, the same bits on all ranks."""
        found = {n: value for n, value in self._measures().items() if n.endswith("_deg")}
        return self.comm.bcast(found)

    # -- for restarts -------------------------------------------------------------------------

    def memory(self) -> dict[str, Any]:
        """Return what a next step inherits beside loads and unknowns; the same on all ranks."""
        own: dict[str, Any] = {
            "work": self._work.memory(), "largest_force_N": self._largest_force}
        if self.contact is not None:
            own["facet_of_node"] = self.contact.memory()
        return own | self.newton.factor.memory()

    def recall(self, memory: Mapping[str, Any]) -> None:
        """Take over what `memory` returned, also in an earlier run."""
        if self.contact is not None:
            self.contact.recall(self.system, memory["facet_of_node"])
            self.newton.renew()
        self._work.recall(memory["work"])
        self._largest_force = memory["largest_force_N"]
        self.newton.factor.recall(memory)

    # -- for subclasses -----------------------------------------------------------------------

    @abstractmethod
    def _newton(self) -> Newton:
        """Return the solver of this scene."""

    @abstractmethod
    def _functional(self, in_use: tuple[str, ...]) -> tuple[list[Any], Any]:
        """Return energies (UFL functionals) and tangent corrections, see `set_energies`.

        Sets ``self.loads``: of each load in use the constants that carry it.
        """

    def _corrections(self, parts: Sequence[Any]) -> dict[int, Any]:
        """Return what makes the tangents of parts robust, by their blocks' places in the system."""
        return {i: part.tangent_correction for i, block in enumerate(self.system.blocks)
                for part in parts if part.block is block}

    def _iterates(self) -> list[Iterate]:
        """Return what mixed-point tangents need of earlier iterates."""
        return []

    @abstractmethod
    def _stored(self) -> list[Any]:
        """Return the stored energies, UFL functionals without the loads' potentials."""

    @abstractmethod
    def masses(self) -> list[np.ndarray]:
        """Return the lumped mass in kg on each owned unknown, of each kept block."""

    @abstractmethod
    def _measures(self) -> dict[str, float]:
        """Return what is measured in the present state."""

    @abstractmethod
    def _conjugates(self) -> dict[str, float]:
        """Return, of each load in use, the displacement on which it does work."""

    # -- internals ----------------------------------------------------------------------------

    def _take_up_contact(self) -> None:
        if self.contact is not None and self.contact.prepare(self.system):
            self.newton.renew()

    def _stand_at(self, earlier: restart_files.Restart) -> None:
        self.show(earlier.states[-1])
        self.accept()
        self._load = dict(earlier.standing.load)
        self._in_use = None  # whatever it was: `_use` sets the load and takes it as the last one

    def _use(self, in_use: tuple[str, ...]) -> None:
        energies, corrections = self._functional(in_use)
        self.system.set_energies(energies, corrections)
        self._stored_forms = [compat.form(energy) for energy in self._stored()]
        self._in_use = in_use
        self.set_load(self._load)
        self._work.stand(self._load, self._conjugates())

    def _stored_energies(self) -> list[float]:
        return [compat.assemble_scalar(self.comm, form) for form in self._stored_forms]
