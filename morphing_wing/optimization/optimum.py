"""An optimisation: rung by rung the best design, and all that was computed for it."""

from __future__ import annotations

import os
import pathlib
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass, field
from typing import Any

import numpy as np
import pandas as pd
import tomli_w
from mpi4py import MPI

from morphing_wing.errors import InputError
from morphing_wing.interrupts import interrupts_noticed
from morphing_wing.ladder import LADDERS
from morphing_wing.root import on_root, write_whole
from morphing_wing.studies.case import ALWAYS, Case, run_case
from morphing_wing.study_files import write_study
from morphing_wing.summary import plain

from .picture import draw
from .problem import Constraint, Problem
from .rung_search import climb
from .seen_designs import Found, Request

__all__ = ["Optimum", "optimize"]

Row = dict[str, Any]


@dataclass
class Optimum:
    """What an optimisation has computed and found, complete or not.

    Attributes
    ----------
    problem
        What was asked.
    rows
        Every design that was computed, in order.
    found
        Of each rung that was searched to its end.
    limits
        Of each rung, the limits of the constraints.
    complete
        Whether all rungs were searched to their end.
    """

    problem: Problem
    rows: list[Row] = field(default_factory=list)
    found: list[Found] = field(default_factory=list)
    limits: dict[str, dict[Constraint, float]] = field(default_factory=dict)
    complete: bool = False

    def table(self) -> pd.DataFrame:
        """Return all designs: rung, role, variables, outputs, feasible, predicted, cost."""
        return pd.DataFrame(self.rows)

    def best(self, rung: str | None = None) -> Row | None:
        """Return the best design that holds all constraints; None: none does.

        Of a rung, by default of the finest one that was searched.
        """
        # Of a rung that was only begun nothing is known but the start.
        searched = [row["rung"] for row in self.rows if row["role"] != "start"]
        rung = rung or [self.rows[0]["rung"], *searched][-1]
        goal = self.problem.goal
        rows = [row for row in self.rows if row["rung"] == rung and row["feasible"]]
        return min(rows, key=lambda row: goal.cost(row[goal.output], 1.0), default=None)

    def start(self, rung: str) -> Row:
        """Return the starting design as a rung computes it."""
        return next(row for row in self.rows if row["rung"] == rung)

    def rungs(self) -> pd.DataFrame:
        """Return of each rung what it has cost, and the goal at the start and at its best."""
        output, facts = self.problem.goal.output, []
        for rung in dict.fromkeys(row["rung"] for row in self.rows):
            rows = [row for row in self.rows if row["rung"] == rung]
            best, start = self.best(rung), self.start(rung)[output]
            end = next((f for f in self.found if f.rung == rung), None)
            facts.append({
                "rung": rung, "evaluations": len(rows), "seconds": sum(r["seconds"] for r in rows),
                f"start_{output}": start, f"best_{output}": best[output] if best else np.nan,
                "settled": bool(end and end.settled),
                "reason": end.reason if end else "was not searched to its end",
                "kkt_residual": end.residual if end else np.nan})
        return pd.DataFrame(facts)

    def design(self) -> Case | None:
        """Return the best design of the finest rung that was searched, as a case of that rung."""
        best = self.best()
        if best is None:
            return None
        return self.problem.case(np.array([best[v.column] for v in self.problem.variables]),
                                 best["rung"])

    @property
    def converged(self) -> bool:
        """Whether all rungs ended with a design and nothing more to gain."""
        return self.complete and self.best() is not None and all(f.settled for f in self.found)

    def reason(self) -> str:
        """Return in words why it ended, or that it was stopped."""
        if not self.complete:
            return "stopped before all rungs were searched"
        if self.best() is None:
            return "no design that holds all constraints was found"
        return "; ".join(f"{f.rung}: {f.reason}" for f in self.found)

    def summary(self) -> dict[str, Any]:
        """Return what ``summary.json`` tells; arrays have one entry an evaluation."""
        problem, table, best = self.problem, self.table(), self.best()
        prices = self.found[-1].prices if self.found else {}
        return {
            "study": "optimize", "scene": problem.start.scene, "goal": str(problem.goal),
            "fidelity": (best or self.rows[-1])["rung"],
            "fidelities": list(dict.fromkeys(table["rung"])),
            "dofs": table["dofs"].max(), "seconds": table["seconds"].sum(),
            "converged": self.converged, "reason": self.reason(),
            "best": best, "start": self.start((best or self.rows[-1])["rung"]), "prices": prices,
            "rungs": self.rungs().to_dict("records"),
            "limits": [{"rung": rung, "output": c.output, "side": c.side, "limit": limit}
                       for rung, limits in self.limits.items() for c, limit in limits.items()],
            "problem": described(problem),
            **{name: list(table[name]) for name in table if name not in ("dofs", "seconds")},
        }

    def save(self, directory: str | os.PathLike, picture: bool = True) -> None:
        """Write ``table.csv``, ``summary.json``, ``design.toml`` and ``optimum.png``.

        Call on one rank.
        """
        folder = pathlib.Path(directory)
        write_study(folder, self.summary(), {"table": self.table()})
        design = self.design()
        if design is not None:
            text = (f"# Found by optimisation: {self.problem.goal}, on the rung "
                    f"{self.best()['rung']!r}.\n{tomli_w.dumps(design.changed_table)}")
            write_whole(folder / "design.toml", lambda file: file.write_text(text))
        if picture:
            draw(self, folder / "optimum.png")


def optimize(
    problem: Problem,
    comm: MPI.Comm | None = None,
    told: Callable[[Row], None] | None = None,
    done: Callable[[Optimum], None] | None = None,
    known: Iterable[Mapping[str, Any]] = (),
) -> Optimum:
    """Search a problem's rungs, cheapest first. Collective.

    Parameters
    ----------
    problem
        See `morphing_wing.optimization.problem_file.read_problem`.
    comm
        Communicator of the scenes; this process alone by default.
    told
        Called on all ranks with each design as soon as it is computed.
    done
        Called on rank 0 after each design with all that is there.
    known
        Rows of an earlier table of the same problem: designs that need not be computed again.

    Raises
    ------
    InputError
        If the starting design cannot be computed.
    """
    comm = comm or MPI.COMM_SELF
    earlier = {_design(problem, row): row for row in known}
    optimum = Optimum(problem)
    search = climb(problem, optimum.found)  # of rank 0
    sent: np.ndarray | None = None
    while True:
        with interrupts_noticed():
            request = comm.bcast(on_root(comm, lambda s=sent: _advance(search, s)), root=0)
        if request is None:
            optimum.found, optimum.complete = comm.bcast(optimum.found, root=0), True
            return optimum
        with interrupts_noticed():
            row = _computed(problem, request, earlier, comm)
        if request.role == "start":
            optimum.limits[request.rung] = problem.limits(request.rung, row)
        row["feasible"] = problem.feasible(row, optimum.limits[request.rung])
        optimum.rows.append(row)
        if told is not None:
            told(row)
        if done is not None:
            on_root(comm, lambda: done(optimum))
        if request.role == "start" and (row["refused"] or row["stopped"]):
            raise InputError(f"base: must be a design that can be computed on the rung "
                             f"{request.rung!r}: {row['refused'] or row['stopped']}")
        sent = None if row["refused"] or row["stopped"] else np.array(
            [row[name] for name in problem.outputs])


def _advance(search: Any, sent: np.ndarray | None) -> Request | None:
    try:
        return search.send(sent)
    except StopIteration:
        return None


def _computed(
    problem: Problem, request: Request, earlier: Mapping[Any, Row], comm: MPI.Comm
) -> Row:
    """Return the row of a design: computed, or known from before."""
    values = {v.column: float(x) for v, x in zip(problem.variables, request.values, strict=True)}
    row = {"rung": request.rung, "role": request.role, **values}
    found = earlier.get(_design(problem, row))
    if found is None:
        case = problem.case(request.values, request.rung)
        found = comm.bcast(run_case(case, problem.told(request.rung), comm), root=0)
    return row | {name: found.get(name, np.nan) for name in problem.outputs} | {
        "feasible": False, "predicted": request.predicted,
        **{name: found[name] for name in ALWAYS}}


def _design(problem: Problem, row: Mapping[str, Any]) -> tuple[Any, ...]:
    return (row["rung"], *(float(row[v.column]) for v in problem.variables))


def described(problem: Problem) -> dict[str, Any]:
    """Return a problem in plain types: equal problems have equal descriptions."""
    return plain({
        "scene": dict(problem.start.table), "start": dict(problem.start.changes),
        "goal": problem.goal.kind, "output": problem.goal.output, "target": problem.goal.target,
        "variables": [[v.key, v.lowest, v.highest, v.unit] for v in problem.variables],
        "constraints": [[c.output, c.side, c.limit] for c in problem.constraints],
        "rungs": [rung for rung in LADDERS[problem.start.scene] if rung in problem.rungs],
        "evaluations": problem.evaluations, "tolerance": problem.tolerance,
        "own_slopes": problem.own_slopes,
    })
