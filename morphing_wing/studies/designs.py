"""Designs of experiments: which values the factors take together."""

from __future__ import annotations

import itertools
import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import asdict, dataclass
from typing import Any

import numpy as np
import pandas as pd
from scipy.stats import qmc

from morphing_wing.errors import InputError, is_count, plain, require

from .factors import Factor
from .orthogonal_arrays import orthogonal_array

__all__ = ["KINDS", "VARIED", "Design"]

VARIED = "varied"
"""Column that says, one factor at a time, which one."""

MOST_CASES = 1_000_000


@dataclass(frozen=True)
class Design:
    """How factors are varied together.

    Parameters
    ----------
    kind
        ``"orthogonal"`` (an orthogonal array), ``"full_factorial"``, ``"one_at_a_time"``,
        ``"latin_hypercube"`` or ``"sobol"`` (Saltelli's sample for Sobol' indices).
    points
        Of a Latin hypercube its points; of "sobol" the base sample N, a power of two: the study has
        N (d + 2) cases of d factors, N (2 d + 2) for second order.
    levels
        Into how many levels ranges are divided, for the first three kinds.
    array
        Name of an orthogonal array, such as "L9"; None: the shortest that fits.
    seed
        Of the random numbers: the same seed gives the same points.
    second_order
        Whether "sobol" is for indices of pairs too.
    """

    kind: str
    points: int | None = None
    levels: int | None = None
    array: str | None = None
    seed: int = 0
    second_order: bool = False

    def __post_init__(self) -> None:
        """Refuse what does not belong to the kind."""
        require(self.kind in KINDS, "design.kind", self.kind, "", f"one of {', '.join(KINDS)}")
        belongs = KINDS[self.kind][1]
        for name, usual in (("points", None), ("levels", None), ("array", None), ("seed", 0),
                            ("second_order", False)):
            value = getattr(self, name)
            if value != usual and name not in belongs:
                raise InputError(f"design.{name} = {plain(value)}: must be left out where kind is "
                                 f"{self.kind!r}")
        seed = self.seed
        require(isinstance(seed, int) and seed >= 0, "design.seed", seed, "", "a whole number, 0 "
                "or more")
        if "points" in belongs:
            require(is_count(self.points), "design.points", self.points, "", "a whole number of at "
                    "least 1")
            if self.kind == "sobol":
                power = self.points >= 2 and math.log2(self.points).is_integer()
                require(power, "design.points", self.points, "", "a power of two, such as 256")
            else:
                require(self.points >= 2, "design.points", self.points, "", "2 or more")

    def table(self, factors: Sequence[Factor], base: Mapping[str, Any]) -> pd.DataFrame:
        """Return the values of all cases, one row a case, one column a factor.

        Parameters
        ----------
        factors
            What is varied.
        base
            By column the value that a factor has while another one is varied.

        Raises
        ------
        InputError
            If the factors do not go with the design, or there are more than a million cases.
        """
        size = self.size(factors)
        require(size <= MOST_CASES, "number of cases", size, "", f"at most {MOST_CASES}")
        return KINDS[self.kind][0](self, factors, base)

    def size(self, factors: Sequence[Factor]) -> int:
        """Return at least how many cases there are, without making them."""
        if self.kind == "full_factorial":
            return math.prod(len(factor.chosen(self.levels)) for factor in factors)
        if self.kind == "sobol":
            return self.points * ((2 if self.second_order else 1) * len(factors) + 2)
        return self.points or 1

    def description(self) -> dict[str, Any]:
        """Return the parameters that matter to the kind."""
        given = {name: value for name, value in asdict(self).items()
                 if name == "kind" or name in KINDS[self.kind][1]}
        return {name: value for name, value in given.items() if value is not None}


def problem(factors: Sequence[Factor]) -> dict[str, Any]:
    """Return the factors as SALib has them, each between 0 and 1."""
    # An array: what SALib 1.5 makes of a list, pandas 3 refuses.
    return {"num_vars": len(factors), "names": np.array([f.column for f in factors]),
            "bounds": [[0.0, 1.0]] * len(factors)}


def _orthogonal(design: Design, factors: Sequence[Factor], _: Mapping[str, Any]) -> pd.DataFrame:
    levels = [factor.chosen(design.levels) for factor in factors]
    places = orthogonal_array([len(each) for each in levels], design.array)
    return _frame(factors, [[each[i] for i in column]
                            for each, column in zip(levels, places.T, strict=True)])


def _full(design: Design, factors: Sequence[Factor], _: Mapping[str, Any]) -> pd.DataFrame:
    rows = itertools.product(*(factor.chosen(design.levels) for factor in factors))
    return _frame(factors, list(zip(*rows, strict=True)))


def _one_at_a_time(
    design: Design, factors: Sequence[Factor], base: Mapping[str, Any]
) -> pd.DataFrame:
    rest = {factor.column: base[factor.column] for factor in factors}
    rows = [{VARIED: "none", **rest}]
    for factor in factors:
        rows += [{VARIED: factor.column, **rest, factor.column: value}
                 for value in factor.chosen(design.levels) if value != rest[factor.column]]
    return pd.DataFrame(rows)


def _latin_hypercube(
    design: Design, factors: Sequence[Factor], _: Mapping[str, Any]
) -> pd.DataFrame:
    sample = qmc.LatinHypercube(len(factors), seed=design.seed).random(design.points)
    return _at(factors, sample)


def _sobol(design: Design, factors: Sequence[Factor], _: Mapping[str, Any]) -> pd.DataFrame:
    from SALib.sample import sobol  # takes a second

    return _at(factors, sobol.sample(problem(factors), design.points, seed=design.seed,
                                     calc_second_order=design.second_order))


def _at(factors: Sequence[Factor], sample: np.ndarray) -> pd.DataFrame:
    return _frame(factors, [f.at(x) for f, x in zip(factors, sample.T, strict=True)])


def _frame(factors: Sequence[Factor], columns: Sequence[Sequence[Any]]) -> pd.DataFrame:
    names = [factor.column for factor in factors]
    return pd.DataFrame({n: list(c) for n, c in zip(names, columns, strict=True)})


KINDS: dict[str, tuple[Callable[..., pd.DataFrame], tuple[str, ...]]] = {
    "orthogonal": (_orthogonal, ("levels", "array")),
    "full_factorial": (_full, ("levels",)),
    "one_at_a_time": (_one_at_a_time, ("levels",)),
    "latin_hypercube": (_latin_hypercube, ("points", "seed")),
    "sobol": (_sobol, ("points", "seed", "second_order")),
}
"""Of each kind what makes its table, and which parameters it has."""
