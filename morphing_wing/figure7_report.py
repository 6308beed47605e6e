"""The facts of Figure 7 as tables for a terminal."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

from rich.table import Table

from morphing_wing.figure7_facts import PANELS, words
from morphing_wing.terminal_tables import text_table

__all__ = ["report"]


def report(facts: dict[str, list[dict[str, Any]]]) -> Iterator[Table]:
    """Yield tables: each curve, and where there are such, the skin and the fidelities.

    Parameters
    ----------
    facts
        See `figure7_facts.facts`.
    """
    yield text_table(
        "Figure 7: where the paper's angle is reached, and the coupling at the last load",
        ["curve", "by the end face", "the same in space", "by the deflection line", "coupling",
         "resin yields at", "skin touches from", "unstable from"],
        [[_name(f), words(f), words(f, "space_"), words(f, "line_"), _coupling(f),
          _load(f, f["resin_yields_at"]), _touching(f), _load(f, f["unstable_from"])]
         for f in facts["curves"]])
    if facts["skin"]:
        yield text_table(
            "What the skin takes away, at the last load",
            ["curve", "load", "with skin, deg", "without, deg", "without / with"],
            [[_name(f), _load(f, f["load"]), f"{f['with_deg']:.2f}", f"{f['without_deg']:.2f}",
              f"{f['without_over_with']:.2f}"] for f in facts["skin"]])
    if facts["fidelities"]:
        yield text_table(
            "Fidelities: largest relative difference of the angle",
            ["curve", "against", "difference", "at"],
            [[_name(f), f["against"], f"{100 * f['largest_difference']:.1f} %",
              _load(f, f["at_load"])] for f in facts["fidelities"]])


def _touching(fact: dict[str, Any]) -> str:
    found = fact["touching_from"]
    return _load(fact, fact["contact_from"] if found is None else found)


def _name(fact: dict[str, Any]) -> str:
    skin = {True: "with skin", False: "no skin"}.get(fact.get("skin"))
    return ", ".join(filter(None, [fact["panel"], skin, fact["direction"], fact["fidelity"]]))


def _coupling(fact: dict[str, Any]) -> str:
    if fact["coupling"] is None:
        return "-"
    return f"{fact['coupling_deg']:.2f} deg, {100 * fact['coupling']:.1f} %"


def _load(fact: dict[str, Any], load: float | None) -> str:
    return "-" if load is None else PANELS[fact["panel"]].words(load)
