"""What is to be optimised: a goal, variables between bounds, constraints, rungs to compute on."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from morphing_wing.errors import InputError, require
from morphing_wing.ladder import LADDERS
from morphing_wing.scene_dimensions import column_of, unit_of
from morphing_wing.scene_file import SceneFile
from morphing_wing.studies.case import Case
from morphing_wing.studies.case_outputs import check_outputs

__all__ = ["HOLDS", "Constraint", "Goal", "Problem", "Variable"]

HOLDS = 1e-9
"""Part of a limit by which rounding may pass it."""


@dataclass(frozen=True)
class Goal:
    """What to do with one output: "maximize", "minimize", or "match" a target."""

    kind: str
    output: str
    target: float | None = None

    def cost(self, value: np.ndarray, scale: float) -> np.ndarray:
        """Return what is to be minimised, without unit: the output over a scale of it.

        Of a match the distance to the target squared.
        """
        if self.kind == "match":
            return ((value - self.target) / scale) ** 2
        return (-1.0 if self.kind == "maximize" else 1.0) * value / scale

    def __str__(self) -> str:
        """Return the goal in words."""
        target = "" if self.target is None else f" = {self.target:.6g}"
        return f"{self.kind} {self.output}{target}"


@dataclass(frozen=True)
class Variable:
    """A key of the scene and the bounds of its value, in the package's unit."""

    key: str
    lowest: float
    highest: float
    column: str = ""
    unit: str = ""

    @property
    def name(self) -> str:
        """Last word of the key."""
        return self.key.removeprefix("geometry.").removeprefix("loads.")


@dataclass(frozen=True)
class Constraint:
    """An output that must be at most ("max") or at least ("min") a limit.

    ``limit`` is None where that is what the starting design has, on the same rung.
    """

    output: str
    side: str
    limit: float | None = None

    def __str__(self) -> str:
        """Return the constraint in words."""
        limit = "as of the base" if self.limit is None else f"{self.limit:.6g}"
        return f"{self.output} {'<=' if self.side == 'max' else '>='} {limit}"

    def violation(self, value: np.ndarray, limit: float) -> np.ndarray:
        """Return by which part of the limit (of 1 where that is 0) it is passed, if positive."""
        over = (value - limit) / (abs(limit) or 1.0)
        return over if self.side == "max" else -over


@dataclass(frozen=True)
class Problem:
    """A problem of optimisation, checked.

    Parameters
    ----------
    start
        The design to begin with, which "as of the base" refers to.
    goal, variables, constraints
        What is sought, where, and subject to what.
    rungs
        Fidelities, cheapest first: each one corrects what the ones before have found.
    evaluations
        Most evaluations on each rung after the first.
    tolerance
        Gain of the goal, relative to its scale, that is not worth another evaluation.
    own_slopes
        Whether every rung after the formula finds its own slopes, which takes a design a variable;
        False: one after the first takes those of the rung before until a promise fails.

    Raises
    ------
    InputError
        Where names, bounds or rungs do not fit the scene.
    """

    start: Case
    goal: Goal
    variables: tuple[Variable, ...]
    constraints: tuple[Constraint, ...] = ()
    rungs: tuple[str, ...] = ("instant",)
    evaluations: int = 40
    tolerance: float = 1e-3
    own_slopes: bool = False

    def __post_init__(self) -> None:
        """Check what a file can get wrong, and give the variables columns and units."""
        scene, ladder = self.start.scene, LADDERS[self.start.scene]
        if not self.variables:
            raise InputError("variables: is empty, must have at least one key of the scene")
        for rung in self.rungs:
            require(rung in ladder, "rungs", rung, "", f"of {', '.join(ladder)}")
        if sorted(set(self.rungs), key=ladder.index) != list(self.rungs):
            raise InputError(f"rungs = {', '.join(self.rungs)}: must be in the order of "
                             f"{', '.join(ladder)}, each once")
        object.__setattr__(self, "variables", tuple(
            Variable(v.key, v.lowest, v.highest, column_of(scene, v.key), unit_of(scene, v.key))
            for v in self.variables))
        for v in self.variables:
            self._check(v)
        for rung in self.rungs:  # what a formula does not know the next rung adds
            if rung != "instant" or rung == self.rungs[-1]:
                check_outputs(self.start.changed({"fidelity": rung}).file, self.outputs)
        check_outputs(self.start.changed({"fidelity": self.rungs[0]}).file, [self.goal.output])

    @property
    def outputs(self) -> tuple[str, ...]:
        """All outputs that goal and constraints are about, the goal's first."""
        return tuple(dict.fromkeys([self.goal.output, *(c.output for c in self.constraints)]))

    @property
    def least_gain(self) -> float:
        """Least gain of the cost that is worth an evaluation: that of a match is squared."""
        return self.tolerance**2 if self.goal.kind == "match" else self.tolerance

    @property
    def lowest(self) -> np.ndarray:
        """Lower bounds of all variables."""
        return np.array([v.lowest for v in self.variables])

    @property
    def highest(self) -> np.ndarray:
        """Upper bounds of all variables."""
        return np.array([v.highest for v in self.variables])

    @property
    def first(self) -> np.ndarray:
        """The variables' values at the start."""
        return np.array([float(self.start.value(v.key)) for v in self.variables])

    def case(self, values: np.ndarray, rung: str) -> Case:
        """Return the case of the variables' values on a rung."""
        return self.start.changed(
            {"fidelity": rung}
            | {v.key: float(x) for v, x in zip(self.variables, values, strict=True)})

    def told(self, rung: str) -> tuple[str, ...]:
        """Return the outputs that a rung tells: the formulas do not know them all."""
        file = self.start.changed({"fidelity": rung}).file
        return tuple(name for name in self.outputs if is_told(file, name))

    def limits(self, rung: str, start: Mapping[str, float]) -> dict[Constraint, float]:
        """Return the limits of the constraints that a rung tells, by its starting design."""
        told = self.told(rung)
        return {c: c.limit if c.limit is not None else start[c.output]
                for c in self.constraints if c.output in told}

    @staticmethod
    def feasible(outputs: Mapping[str, float], limits: Mapping[Constraint, float]) -> bool:
        """Whether no limit is passed, but for rounding; what is not a number passes it."""
        return all(c.violation(outputs[c.output], limit) <= HOLDS for c, limit in limits.items())

    def _check(self, v: Variable) -> None:
        where, unit = f"variables.{v.key}", v.unit
        value = self.start.value(v.key)
        if isinstance(value, bool) or not isinstance(value, float):
            raise InputError(f"{where}: must be a key whose value is a number that can change "
                             f"continuously, of the base it is {value!r}")
        require(v.lowest < v.highest, f"{where}: low", v.lowest, unit,
                f"less than high = {v.highest:.6g} {unit}".rstrip())
        require(v.lowest <= value <= v.highest, f"{where} of the base", value, unit,
                f"between low = {v.lowest:.6g} and high = {v.highest:.6g} {unit}".rstrip())


def is_told(file: SceneFile, output: str) -> bool:
    """Whether a scene at its fidelity tells of an output."""
    try:
        check_outputs(file, [output])
    except InputError:
        return False
    return True
