"""What a study found: its table, the analysis that its design is made for, its files."""

from __future__ import annotations

import os
import pathlib
from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, Any

import pandas as pd

from morphing_wing.errors import InputError
from morphing_wing.range_analysis import range_analysis
from morphing_wing.study_files import write_study

from .correlations import correlations
from .one_at_a_time import effects
from .sobol_indices import sobol_indices
from .variance_analysis import variance_analysis

if TYPE_CHECKING:
    from .study import Study

__all__ = ["StudyResult"]

_BAD = ("refused", "stopped")
_MOST_REASONS = 5


@dataclass(frozen=True)
class StudyResult:
    """The cases of a study and what they tell.

    Attributes
    ----------
    study
        What was studied.
    table
        One row a case, in the order of the design: the factors' values (columns with units), the
        outputs (not a number where a case went wrong), and of a scene ``dofs``,
        ``newton_iterations``, ``seconds``, ``refused``, ``stopped`` and ``warned``, see `run_case`.
    seconds
        Wall time of this run.
    """

    study: Study
    table: pd.DataFrame
    seconds: float

    @property
    def bad(self) -> pd.DataFrame:
        """The cases that were refused, or stopped before their last load."""
        return self.table[(self.table[list(_BAD)] != "").any(axis=1)]

    @cached_property
    def analyses(self) -> dict[str, pd.DataFrame]:
        """The analyses of the design by name, each output's below the other; see `analysis_of`.

        ``levels`` and ``variance`` of orthogonal arrays and full factorials, ``effects`` of one
        factor at a time, ``correlations`` of a Latin hypercube, ``indices`` of "sobol". What cannot
        be analysed is left out, and told in `sentences`.
        """
        return self._analysed[0]

    @cached_property
    def _analysed(self) -> tuple[dict[str, pd.DataFrame], list[str]]:
        parts: dict[str, list[pd.DataFrame]] = {}
        said: list[str] = []
        for output in self.study.outputs:
            for name, analyse in _ANALYSES[self.study.design.kind].items():
                try:
                    part = analyse(self, output, said)
                except InputError as problem:
                    sentence = f"{output}: not analysed: {problem}"
                    said += [] if sentence in said else [sentence]
                    continue
                part.insert(0, "output", output)
                parts.setdefault(name, []).append(part)
        return {name: pd.concat(each, ignore_index=True) for name, each in parts.items()}, said

    def analysis_of(self, name: str, output: str) -> pd.DataFrame:
        """Return an analysis of one output; empty where there is none."""
        if name not in self.analyses:
            return pd.DataFrame()
        whole = self.analyses[name]
        return whole[whole["output"] == output].drop(columns="output").reset_index(drop=True)

    def sentences(self) -> list[str]:
        """Return what is to be told of cases that went wrong, and of what was not analysed."""
        found = []
        for word in _BAD:
            reasons = self.table.loc[self.table[word] != "", word]
            # Reasons tell of each case's own figures: the first ones stand for their like.
            for number, reason in list(reasons.items())[:_MOST_REASONS]:
                found.append(f"case {number} {word}: {reason}")
            if len(reasons) > _MOST_REASONS:
                found.append(f"{len(reasons) - _MOST_REASONS} more cases {word}, see table.csv")
        return found + self._analysed[1]

    def summary(self) -> dict[str, Any]:
        """Return what ``summary.json`` tells."""
        bad = len(self.bad)
        counts = {word: int((self.table[word] != "").sum()) for word in _BAD}
        return {
            "study": self.study.name, "kind": self.study.design.kind, "cases": len(self.table),
            **counts, "seconds": self.seconds, "case_seconds": self.table["seconds"].sum(),
            "converged": bad == 0,
            "reason": f"{bad} of {len(self.table)} cases went wrong" if bad
                      else "every case was computed",
            **{name: table.to_dict("records") for name, table in self.analyses.items()},
            "sentences": self.sentences(), "parameters": self.study.description(),
        }

    def save(self, folder: str | os.PathLike) -> None:
        """Write ``table.csv``, ``summary.json``, each analysis as a table, and the pictures."""
        from .pictures import draw

        folder = pathlib.Path(folder)
        write_study(folder, self.summary(), {"table": self.table.reset_index(), **self.analyses})
        draw(self, folder)


def _levels(result: StudyResult, output: str, _: list[str]) -> pd.DataFrame:
    columns = [factor.column for factor in result.study.factors]
    return range_analysis(result.table, columns, output)


def _variance(result: StudyResult, output: str, said: list[str]) -> pd.DataFrame:
    columns = [factor.column for factor in result.study.factors]
    pairs = result.study.design.kind == "full_factorial" and len(columns) > 2
    found = variance_analysis(result.table, columns, output, interactions=pairs)
    if found["degrees_of_freedom"].iloc[-1] == 0:
        said.append(f"{output}: the factors take all degrees of freedom, nothing is left to "
                    "compare them with (F, p)")
    return found


def _indices(result: StudyResult, output: str, said: list[str]) -> pd.DataFrame:
    study = result.study
    found, left_out = sobol_indices(study.factors, result.table[output].tolist(),
                                    study.design.second_order)
    if left_out:
        said.append(f"{output}: {left_out} blocks of cases with bad ones among them are left out "
                    "of the indices, which are of the rest of the space")
    return found


def _effects(result: StudyResult, output: str, _: list[str]) -> pd.DataFrame:
    return effects(result.table, result.study.factors, output)


def _correlations(result: StudyResult, output: str, _: list[str]) -> pd.DataFrame:
    return correlations(result.table, result.study.factors, output)


_BALANCED = {"levels": _levels, "variance": _variance}
_ANALYSES: dict[str, dict[str, Callable[[StudyResult, str, list[str]], pd.DataFrame]]] = {
    "orthogonal": _BALANCED, "full_factorial": _BALANCED,
    "one_at_a_time": {"effects": _effects}, "latin_hypercube": {"correlations": _correlations},
    "sobol": {"indices": _indices},
}
