"""Where each fidelity of the spar breaks: extremes of material, geometry, load and steps.

Each case is asked for in one load step. It ends there, or says after which load it stopped and why;
"refused" means one sentence of bad input before any meshing. What must agree with the case above
it, scaled, is compared ("error").

    python bench/extremes.py                      # draft: a minute or two
    python bench/extremes.py --fidelity standard --out extremes.csv
"""

import argparse
import math
import time
from dataclasses import replace
from pathlib import Path

import numpy as np
import pandas as pd
from mpi4py import MPI
from rich.console import Console
from rich.table import Table

from morphing_wing import Spar
from morphing_wing.errors import InputError
from morphing_wing.geometry import SparGeometry
from morphing_wing.materials import DRAGON_SKIN_30, Yeoh

BASE = SparGeometry.validation(2)
MU, C = DRAGON_SKIN_30.shear_modulus, DRAGON_SKIN_30.coefficients


def walls(thickness):
    """Return the base spar with all walls as thick as that, in mm."""
    return replace(BASE, wall_length=thickness, top_thickness=thickness,
                   middle_thickness=thickness, side_thickness=thickness)


# Name -> geometry, material, pressure in MPa, load steps.
CASES = {"as it is, 20 kPa": (BASE, DRAGON_SKIN_30, 0.02, 1)}
CASES |= {f"kappa/mu = {ratio:g}": (BASE, Yeoh(C, bulk=ratio * MU), 0.02, 1)
          for ratio in (1e2, 1e4, 1e6, 1e8, 1e10, math.inf)}
CASES |= {f"C10, pressure x {scale:g}": (
    BASE, Yeoh(tuple(scale * c for c in C)), scale * 0.02, 1) for scale in (1e-3, 1e3)}
CASES |= {f"in {steps} steps": (BASE, DRAGON_SKIN_30, 0.02, steps) for steps in (3, 10, 100)}
CASES |= {f"{1000 * p:g} kPa": (BASE, DRAGON_SKIN_30, p, 1) for p in (0.04, 0.06, 0.2, -0.05)}
CASES |= {f"walls of {t:g} mm, {1000 * p:g} kPa": (walls(t), DRAGON_SKIN_30, p, 1)
          for t, p in ((0.2, 0.001), (0.2, 0.02), (0.5, 0.005), (3.0, 0.02), (6.0, 0.02))}
CASES |= {f"chambers {length:g} mm long": (
    replace(BASE, cavity_length=length), DRAGON_SKIN_30, 0.02, 1) for length in (0.5, 8.0, 20.0)}
CASES |= {f"chambers {width:g} mm wide": (
    replace(BASE, cavity_width=width), DRAGON_SKIN_30, 0.02, 1) for width in (2.0, 140.0)}
CASES |= {f"{n} cells": (replace(BASE, n_cells=n), DRAGON_SKIN_30, 0.02, 1) for n in (1, 60)}
CASES["a wall 10 times thinner than its neighbours"] = (
    replace(BASE, wall_lengths=(2.2, 0.22, 2.2)), DRAGON_SKIN_30, 0.02, 1)
LIKE_THE_FIRST = ("C10, pressure", "in ")


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--fidelity", default="draft", choices=["draft", "standard"])
    parser.add_argument("--case", nargs="+", default=list(CASES), choices=CASES, metavar="NAME")
    parser.add_argument("--out", type=Path, metavar="CSV", help="the table as a file")
    arguments = parser.parse_args()
    rows, console = [], Console(width=170)
    for name in arguments.case:
        rows.append({"case": name} | solved(arguments.fidelity, *CASES[name]))
        if name.startswith(LIKE_THE_FIRST) and rows[0]["case"] == "as it is, 20 kPa":
            rows[-1]["error"] = rows[-1]["angle_deg"] / rows[0]["angle_deg"] - 1.0
        console.print(", ".join(f"{k} {v:.6g}" if isinstance(v, float) else f"{v}"
                                for k, v in rows[-1].items()))
    frame = pd.DataFrame(rows)
    table = Table(title=f"Extremes of the spar, {arguments.fidelity}, one core")
    for column in frame:
        table.add_column(column)
    for row in frame.itertuples(index=False):
        table.add_row(*("" if isinstance(v, float) and math.isnan(v) else
                        f"{v:.6g}" if isinstance(v, float) else str(v) for v in row))
    console.print(table)
    if arguments.out:
        frame.to_csv(arguments.out, index=False)


def solved(fidelity, geometry, material, pressure, steps):
    """Run a case and return its figures."""
    clock = time.perf_counter()
    try:
        spar = Spar(geometry, material, fidelity=fidelity, comm=MPI.COMM_SELF)
        path = spar.inflate(upper=pressure * np.arange(1, steps + 1) / steps)
    except InputError as refusal:
        return {"ends": f"refused: {refusal}"}
    last = path[-1] if len(path) else None
    return {
        "dofs": spar.dofs, "states": len(path),
        "iterations": sum(state.newton_iterations for state in path),
        "reached_kPa": 1000.0 * last.load["upper_MPa"] if last else 0.0,
        "angle_deg": last.measures["span_angle_deg"] if last else 0.0,
        "negative_pivots": max((state.negative_pivots for state in path), default=0),
        "seconds": time.perf_counter() - clock,
        "ends": "there" if path.converged else path.reason,
    }


if __name__ == "__main__":
    main()
