"""An optimisation told in tables: rungs, variables, limits."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
from rich.table import Table

from morphing_wing.terminal_tables import text_table

from .optimum import Optimum, Row
from .problem import Problem

__all__ = ["in_a_line", "report"]


def in_a_line(problem: Problem, number: int, row: Row) -> str:
    """Return a design that was computed as one line, with the limits that its rung cannot tell."""
    output, found = problem.goal.output, row["refused"] or row["stopped"]
    if not found:
        promised = "" if row["predicted"] is None else f" (promised {row['predicted']:.5g})"
        unknown = dict.fromkeys(c.output for c in problem.constraints if np.isnan(row[c.output]))
        holds = f"holds the limits it knows, not {', '.join(unknown)}" if unknown else (
            "holds all limits")
        found = (f"{output} {row[output]:.6g}{promised}, "
                 + (holds if row["feasible"] else "passes a limit"))
    return f"{row['rung']} {number}, {row['role']}: {found}, {row['seconds']:.1f} s"


def report(optimum: Optimum) -> list[Table | str]:
    """Return tables and sentences of what was found."""
    best = optimum.best()
    parts: list[Table | str] = [_rungs(optimum)]
    if best is None:
        return [*parts, optimum.reason()]
    start = optimum.start(best["rung"])
    prices = optimum.found[-1].prices if optimum.found else {}
    parts.append(_variables(optimum, start, best, prices))
    if optimum.problem.constraints:
        parts.append(_limits(optimum, start, best, prices))
    return parts


def _rungs(optimum: Optimum) -> Table:
    output, rows = optimum.problem.goal.output, []
    for fact in optimum.rungs().to_dict("records"):
        first, last = fact[f"start_{output}"], fact[f"best_{output}"]
        known = np.isfinite(last)
        rows.append((fact["rung"], str(fact["evaluations"]), f"{fact['seconds']:.3g}",
                     f"{first:.5g}", f"{last:.5g}" if known else "none",
                     f"{100 * (last / first - 1):+.2f} %" if known and first else "",
                     fact["reason"]))
    return text_table(f"{optimum.problem.goal}", ("rung", "designs", "seconds", "start", "best",
                                                  "change", "ended"), rows)


def _variables(optimum: Optimum, start: Row, best: Row, prices: Mapping[str, float]) -> Table:
    rows = []
    for v in optimum.problem.variables:
        held = [f"{side}: {prices[f'{v.key} {side}']:.3g}" for side in ("min", "max")
                if f"{v.key} {side}" in prices]
        rows.append((v.key, f"{v.lowest:.5g}", f"{start[v.column]:.6g}", f"{best[v.column]:.6g}",
                     f"{v.highest:.5g}", v.unit, ", ".join(held)))
    return text_table(
        f"Variables, on the rung {best['rung']!r}",
        ("key", "low", "start", "best", "high", "unit", "a unit of the bound is worth"), rows)


def _limits(optimum: Optimum, start: Row, best: Row, prices: Mapping[str, float]) -> Table:
    rows = []
    for c, limit in optimum.limits[best["rung"]].items():
        price = prices.get(f"{c.output} {c.side}")
        rows.append((c.output, f"{start[c.output]:.6g}", f"{best[c.output]:.6g}",
                     f"{'<=' if c.side == 'max' else '>='} {limit:.6g}",
                     "" if price is None else f"{np.round(price, 6):.3g}"))
    return text_table(f"Limits, on the rung {best['rung']!r}",
                      ("output", "start", "best", "limit", "a unit is worth"), rows)
