"""What both angles owe to each assumption about the wing: a ranked table.

The paper calls the skin's effect on the chordwise angle small. Here each assumption on which it is
silent, and each dimension that a mould may miss, is changed alone (or as named), and the prototype
is bent by 20 and 35 kPa alone and by 0.2 N in each cable alone, with contact. Changes are against
the prototype as it is, and the last ratio says what part of the angle without a skin is left. Every
line goes to the CSV file as it comes; a case takes one to three minutes at draft on two ranks.

    mpirun -n 2 python bench/assumptions.py --out assumptions.csv
    mpirun -n 2 python bench/assumptions.py --case "as it is" "skin_root = free"
"""

import argparse
import time
from dataclasses import replace
from pathlib import Path

import pandas as pd
from mpi4py import MPI
from rich.console import Console
from rich.table import Table

from morphing_wing import Wing
from morphing_wing.geometry import RibGeometry, WingGeometry
from morphing_wing.materials import DRAGON_SKIN_30, Yeoh

PRESSURES, TENSIONS = (0.010, 0.020, 0.030, 0.035), (0.05, 0.1, 0.2)  # MPa; N in each cable
SQUARE = {"section": "square", "bosses": True}
C10, C20 = DRAGON_SKIN_30.coefficients
GEOMETRY = {
    "as it is": {},
    "no skin": {"skin_thickness": None},
    "skin_root = free": {"skin_root": "free"},
    "skin_slit = lower": {"skin_slit": "lower"},
    "skin_slit = trailing_edge": {"skin_slit": "trailing_edge"},
    "skin free at the root, slit below": {"skin_root": "free", "skin_slit": "lower"},
    "skin free at the root, tip wall": {"skin_root": "free", "tip_wall": True},
    "skin_thickness = 0.5 mm": {"skin_thickness": 0.5},
    "tip_wall": {"tip_wall": True},
    "skin_over_spar": {"skin_over_spar": True},
    "rib flush": {"rib": RibGeometry.prototype()},
    "rib square without bosses": {"rib": RibGeometry.prototype(section="square")},
    "rib with 16 cells": {"rib": RibGeometry.prototype(n_cells=16, **SQUARE)},
    "rib with alpha = 80": {"rib": replace(
        RibGeometry.prototype(n_cells=16, **SQUARE), crossing_angle=80.0)},
    "cable along the chord, to the spar's lower edge": {"cable_guide": (-55.7, -7.9, 0.0)},
    "tail_bond_length = 2 mm": {"tail_bond_length": 2.0},
    "tail_bond_length = 12 mm": {"tail_bond_length": 12.0},
    "glue_stiffness = 5 N/mm^3": {"glue_stiffness": 5.0},
    "top_thickness - 0.1 mm": {"top_thickness": 1.9},
    "wall_length - 0.1 mm": {"wall_length": 1.9},
    "middle_thickness - 0.1 mm": {"middle_thickness": 1.4},
    "side_thickness - 0.1 mm": {"side_thickness": 1.9},
    "chord - 5 %": {"chord": 142.5, "rib": RibGeometry.prototype(n_cells=16, **SQUARE)},
}
OTHERS = {
    "contact left out": {"contact": False},
    "C10 - 10 %": {"elastomer": Yeoh((0.9 * C10, C20))},
}
CASES = {name: (changes, {}) for name, changes in GEOMETRY.items()} | {
    name: ({}, options) for name, options in OTHERS.items()}
# Column -> load, which of its points, measure.
MEASURED = {
    "phi_1, 20 kPa": ("upper", 1, "span_angle_deg"),
    "phi_1, 35 kPa": ("upper", 3, "span_angle_deg"),
    "phi_2": ("cable", 2, "chord_angle_deg"),
    "in space": ("cable", 2, "trailing_edge_deg"),
    "middle rib": ("cable", 2, "rib_2_rotation_deg"),
}
CHANGES = ("phi_1, 20 kPa", "phi_1, 35 kPa", "middle rib")


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--case", nargs="+", default=list(CASES), choices=CASES, metavar="NAME")
    parser.add_argument("--fidelity", default="draft", choices=["draft", "standard"])
    parser.add_argument("--cells", type=int, default=18, metavar="N", help="chambers in a row")
    parser.add_argument("--out", type=Path, default=Path("assumptions.csv"), metavar="CSV")
    arguments = parser.parse_args()
    rows = []
    for name in arguments.case:
        rows.append({"case": name, **measured(*CASES[name], arguments)})
        if MPI.COMM_WORLD.rank == 0:
            pd.DataFrame(rows).to_csv(arguments.out, index=False)
    if MPI.COMM_WORLD.rank == 0:
        Console(width=150).print(ranked(pd.DataFrame(rows)))


def measured(changes, options, arguments):
    """Return the angles of one case; a path that stops before its load gives none."""
    clock, reached = time.perf_counter(), {}
    geometry = WingGeometry.prototype(n_cells=arguments.cells, **changes)
    for name, values in (("upper", PRESSURES), ("cable", TENSIONS)):
        path = Wing(geometry, fidelity=arguments.fidelity, **options).actuate(**{name: values})
        reached[name] = [state.measures for state in path if state.requested]
    found = {column: reached[load][i].get(measure) if i < len(reached[load]) else None
             for column, (load, i, measure) in MEASURED.items()}
    return found | {"seconds": time.perf_counter() - clock}


def ranked(rows):
    """Return the table to print, those first that leave most of the angle without a skin."""
    cases = rows.set_index("case")
    rows = cases.sort_values("middle rib", ascending=False)
    formats = dict.fromkeys(MEASURED, "{:.2f}")
    if "as it is" in cases.index:
        for name in CHANGES:
            rows[f"{name}: %"] = 100.0 * (rows[name] / cases.loc["as it is", name] - 1.0)
            formats[f"{name}: %"] = "{:+.1f}"
    if "no skin" in cases.index:
        rows["of no skin, %"] = 100.0 * rows["middle rib"] / cases.loc["no skin", "middle rib"]
        formats["of no skin, %"] = "{:.0f}"
    formats["seconds"] = "{:.0f}"
    table = Table(title=f"Section 5.1 under pressure, or at {TENSIONS[-1]:g} N in each cable; "
                        "angles in degrees")
    table.add_column("changed")
    for name in formats:
        table.add_column(name, justify="right")
    for name, row in rows.iterrows():
        table.add_row(str(name), *("" if pd.isna(row[c]) else form.format(row[c])
                                   for c, form in formats.items()))
    return table


if __name__ == "__main__":
    main()
