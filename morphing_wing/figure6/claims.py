"""What the paper's Section 4 says of Figure 6, tested on a series of its points."""

from __future__ import annotations

from typing import Any

import pandas as pd

from .points import Panel
from .sensitivities import sensitivities

__all__ = ["LITTLE", "claims"]

LITTLE = 0.25
"""Part of the largest effect below which another one is called little; the paper has no measure."""

DRAMATIC = 2.0
"""Times the slope at the other end from which on a change is called dramatic."""


def claims(part: pd.DataFrame, panel: Panel) -> list[dict[str, Any]]:
    """Return of each claim its words, whether it holds, and the figures it is judged by.

    Effects are compared over the levels of the paper's tables, the only ones that it names; the
    figures tell them over all points too. A claim whose points are missing is left out.
    """
    facts = {fact["factor"]: fact for fact in sensitivities(part, panel)}
    if any(pd.isna(fact["table_range_deg"]) for fact in facts.values()):
        return []
    return (_of_spar if panel.letter == "A" else _of_rib)(facts, part)


def _of_spar(facts: dict[str, dict[str, Any]], part: pd.DataFrame) -> list[dict[str, Any]]:
    top = facts["h_t"]
    parts = {name: facts[name]["table_range_deg"] / top["table_range_deg"]
             for name in ("l_s1", "l_c")}
    found = [
        _claim("l_s1 and l_c nearly have little effect", max(parts.values()) < LITTLE,
               f"{_ranges(facts)}; l_s1 has {parts['l_s1']:.0%} of h_t's effect, l_c "
               f"{parts['l_c']:.0%} (little: below {LITTLE:.0%})"),
        _claim("the effect of h_t is quite prominent, the angle increases as h_t reduces",
               max(parts.values()) < 1.0 and top["trend"] == "falls",
               f"phi_1 {top['trend']} with h_t, as its power {top['power']:.2f}; "
               f"{_elasticities(facts)}"),
    ]
    if "bulge_mm" in part:
        rows = part[(part["factor"] == "h_t") & part["bulge_mm"].notna()]
        thin, thick = (rows.loc[getattr(rows["value"], end)()] for end in ("idxmin", "idxmax"))
        bulge, angle = (thin[name] / thick[name] for name in ("bulge_mm", "span_angle_deg"))
        found.append(_claim(
            "a small h_t results in ballooning locally", bulge > angle,
            f"the wall over a chamber stands out by {thin['bulge_mm']:.3f} mm at h_t = "
            f"{thin['value']:g} mm ({thin['bulge_mm'] / thin['value']:.0%} of it), by "
            f"{thick['bulge_mm']:.3f} mm at {thick['value']:g} mm "
            f"({thick['bulge_mm'] / thick['value']:.0%}): {bulge:.1f} times as far, where phi_1 is "
            f"{angle:.1f} times as large"))
    return found


def _of_rib(facts: dict[str, dict[str, Any]], _: pd.DataFrame) -> list[dict[str, Any]]:
    bars, least = facts["T_rs/l_cs"], facts["D_cs/l_rs"]["table_range_deg"]
    times = bars["first_slope"] / bars["last_slope"]
    return [
        _claim("alpha and T_rs/l_cs have greater influences than D_cs/l_rs",
               min(facts["alpha"]["table_range_deg"], bars["table_range_deg"]) > least,
               f"{_ranges(facts)}; {_elasticities(facts)}"),
        _claim("the behaviour is nonlinear, the angle changes dramatically as T_rs/l_cs decreases",
               bars["trend"] == "falls" and times > DRAMATIC,
               f"phi_2 {bars['trend']} with T_rs/l_cs, as its power {bars['power']:.2f}; the first "
               f"step is {times:.1f} times as steep as the last (dramatic: above {DRAMATIC:g})"),
    ]


def _ranges(facts: dict[str, dict[str, Any]]) -> str:
    """Return the effects in words, over the table's levels and over all points."""
    over = {"the table's levels": "table_range_deg", "all points": "range_deg"}
    return "; ".join(
        f"over {what} " + ", ".join(
            f"{name} {fact[column]:.2f} deg" for name, fact in facts.items())
        for what, column in over.items())


def _elasticities(facts: dict[str, dict[str, Any]]) -> str:
    """Return in words what one per cent of each factor is worth at the middle."""
    return "1 % more of each is worth " + ", ".join(
        f"{name} {fact['elasticity']:+.2f} %" for name, fact in facts.items())


def _claim(claim: str, holds: bool, figures: str) -> dict[str, Any]:
    return {"claim": claim, "holds": bool(holds), "figures": figures}
