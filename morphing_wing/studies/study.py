"""A study: factors varied by a design, each case computed, all results in one table.

What is computed is a scene file with changes (`Case`), or any function of one's own of the factors.
"""

from __future__ import annotations

import os
import pathlib
import time
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import partial
from typing import Any

import pandas as pd

from morphing_wing.errors import InputError, is_number, one_line
from morphing_wing.scene_dimensions import kind_of
from morphing_wing.scene_file import located

from .case import ALWAYS, Case, run_case
from .case_outputs import check_outputs
from .case_pool import by_mpi, here, in_processes
from .case_record import CaseRecord
from .designs import VARIED, Design
from .factors import Factor
from .result import StudyResult

__all__ = ["Study"]

Told = Callable[[int, int, Mapping[str, Any]], None]


@dataclass(frozen=True)
class Study:
    """Factors, their design, and what is computed of each case.

    Parameters
    ----------
    case
        A `Case`, whose keys the factors are; or a function that gets a dict of the factors' values
        by key, and returns a number, or a dict of numbers by output. To be computed in other
        processes it must be a function of a module.
    factors
        What is varied.
    design
        How.
    outputs
        Names of what is wanted: of a `Case` see `run_case`.
    name
        For files and pictures.

    Examples
    --------
    >>> study = Study(lambda x: x["a"] + 2 * x["b"],
    ...               [Factor("a", low=0, high=1), Factor("b", low=0, high=1)],
    ...               Design("sobol", points=64), ["sum"])
    >>> study.run().table.shape
    (256, 6)
    """

    case: Case | Callable[[dict[str, Any]], float | Mapping[str, float]]
    factors: Sequence[Factor]
    design: Design
    outputs: Sequence[str]
    name: str = "study"

    def __post_init__(self) -> None:
        """Refuse what does not go together, before anything is computed."""
        object.__setattr__(self, "factors", tuple(self.factors))
        object.__setattr__(self, "outputs", tuple(self.outputs))
        columns = [factor.column for factor in self.factors]
        if not columns:
            raise InputError("factors: is empty, must have at least one")
        if not self.outputs:
            raise InputError("outputs: is empty, must have at least one")
        for names, what in ((columns, "factor"), (self.outputs, "output")):
            for name in names:
                if list(names).count(name) > 1:
                    raise InputError(f"{what} {name!r}: is given twice, must be given once")
        for name in self.outputs:
            if name in columns or name in ("case", VARIED):
                raise InputError(f"output {name!r}: must be left out, it is a column of the "
                                 "factors' own")
        if isinstance(self.case, Case):
            with located(self.case.name):
                for factor in self.factors:
                    if factor.key == "scene":
                        raise InputError(f"factor 'scene': must be another key, it is "
                                         f"{self.case.scene!r} in all cases")
                    kind_of(self.case.scene, factor.key)
                check_outputs(self.case.file, self.outputs)

    def inputs(self) -> pd.DataFrame:
        """Return the factors' values of all cases, one row a case, columns with units."""
        base = {}
        if self.design.kind == "one_at_a_time":
            base = {factor.column: self._base(factor) for factor in self.factors}
        table = self.design.table(self.factors, base)
        table.index.name = "case"
        return table

    def run(
        self,
        workers: int = 1,
        folder: str | os.PathLike | None = None,
        resume: bool = False,
        told: Told | None = None,
        pool: Any = None,
    ) -> StudyResult:
        """Compute all cases.

        What goes wrong in a case is recorded in its row and ends nothing.

        Parameters
        ----------
        workers
            Processes on this machine; 1: all in this one. A script that asks for more must begin
            its own work under ``if __name__ == "__main__":``.
        folder
            Where each case is recorded as soon as it is done; None: nowhere.
        resume
            Whether to go on with what the folder holds.
        told
            Called after each case with how many are done, how many there are, and its row.
        pool
            An executor of mpi4py.futures that has so many ``workers``, in place of processes.

        Returns
        -------
        StudyResult
            The table, in the order of the design, however the cases ended.

        Raises
        ------
        InputError
            See `CaseRecord`.
        """
        begin = time.perf_counter()
        rows = self.inputs().to_dict("records")
        if folder is None:
            done: dict[int, dict[str, Any]] = {}
            self._compute_all(rows, done, lambda number, result: None, workers, told, pool)
            return self._result(rows, done, time.perf_counter() - begin)
        what = {key: value for key, value in self.description().items() if key != "name"}
        with CaseRecord(pathlib.Path(folder), what, len(rows), resume) as record:
            record.check_inputs(rows)
            self._compute_all(
                rows, record.done, lambda number, result: record.add(number, rows[number], result),
                workers, told, pool)
            return self._result(rows, record.done, time.perf_counter() - begin)

    def description(self) -> dict[str, Any]:
        """Return what decides the results, in plain values."""
        of = {"name": self.name}
        if isinstance(self.case, Case):
            scene = {**self.case.table}
            of |= {"scene": scene, "base": dict(self.case.changes)}
        else:
            of["function"] = getattr(self.case, "__qualname__", repr(self.case))
        return of | {"factors": [factor.description() for factor in self.factors],
                     "design": self.design.description(), "outputs": list(self.outputs)}

    def _base(self, factor: Factor) -> Any:
        if isinstance(self.case, Case):
            return self.case.value(factor.key)
        if factor.levels is not None:
            return factor.levels[0]
        return factor.at([0.5])[0]

    def _compute_all(
        self, rows: Sequence[Mapping[str, Any]], done: dict[int, dict[str, Any]],
        keep: Callable[[int, Mapping[str, Any]], None], workers: int, told: Told | None, pool: Any,
    ) -> None:
        compute = partial(_computed, self.case, self.outputs)
        tasks = [(number, {factor.key: row[factor.column] for factor in self.factors})
                 for number, row in enumerate(rows) if number not in done]
        ended: Iterator[tuple[int, dict[str, Any]]]
        if pool is not None:
            ended = by_mpi(compute, tasks, pool, workers)
        elif workers > 1 and len(tasks) > 1:
            ended = in_processes(compute, tasks, min(workers, len(tasks)))
        else:
            ended = here(compute, tasks)
        for number, result in ended:
            done[number] = result
            keep(number, result)
            if told is not None:
                told(len(done), len(rows), {**rows[number], **result})

    def _result(
        self, rows: Sequence[Mapping[str, Any]], done: Mapping[int, Mapping[str, Any]],
        seconds: float,
    ) -> StudyResult:
        empty = dict.fromkeys(self.outputs, float("nan")) | (
            dict.fromkeys(ALWAYS, "") if isinstance(self.case, Case) else {})
        results = pd.DataFrame([
            {**empty, "seconds": float("nan"), "refused": "", "stopped": "", **done[number]}
            for number in range(len(rows))])
        for name in self.outputs:
            results[name] = pd.to_numeric(results[name])
        table = pd.concat([pd.DataFrame(rows), results], axis=1)
        table.index.name = "case"
        return StudyResult(self, table, seconds)


def _computed(case: Any, outputs: Sequence[str], values: Mapping[str, Any]) -> dict[str, Any]:
    """Return the result of one case, in whatever process this is."""
    if isinstance(case, Case):
        return run_case(case.changed(values), outputs)
    found: dict[str, Any] = dict.fromkeys(outputs, float("nan"))
    begin, refused, stopped = time.perf_counter(), "", ""
    try:
        given = case(dict(values))
        if is_number(given) and len(outputs) == 1:
            given = {outputs[0]: given}
        found |= {name: float(given[name]) for name in outputs}
    except InputError as problem:
        refused = one_line(problem)
    except Exception as problem:  # one bad case must not end a thousand others
        stopped = f"unexpected {type(problem).__name__}: {one_line(problem)}"
    return found | {"seconds": time.perf_counter() - begin, "refused": refused, "stopped": stopped}


