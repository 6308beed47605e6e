"""The wing's cost: iterations, factorisations, seconds and memory of each scene and fidelity.

The prototype of the paper's Section 5.1, with skin, with skin but without contact forces, without
skin, and its spar alone, under pressure in the upper chambers (0 to 40 kPa, 8 points), cables (0 to
0.5 N a rib, 8 points) and both together (to 25 kPa and 0.2 N, 4 points). Each case runs in
processes of its own, one a rank; memory is the sum of their peaks. Seconds leave out the
compilation of the forms, which a small wing sees to. On two cores a case at draft takes seconds to
minutes, at standard up to 25 minutes:

    python bench/wing.py --fidelity draft --out wing.csv
    python bench/wing.py --scene "no skin" --load cables --fidelity standard --ranks 2
"""

import argparse
import time
from pathlib import Path

import numpy as np
import pandas as pd
from child import in_a_child, peak_MB, say
from rich.console import Console
from rich.table import Table

SCENES = {"skin": {}, "no contact": {}, "no skin": {"skin_thickness": None},
          "spar alone": {"skin_thickness": None, "rib": None}}
LOADS = {"pressure": {"upper": np.linspace(0.0, 0.04, 9)[1:]},
         "cables": {"cable": np.linspace(0.0, 0.5, 9)[1:]},
         "both": {"upper": np.linspace(0.0, 0.025, 5)[1:], "cable": np.linspace(0.0, 0.2, 5)[1:]}}
FIDELITIES = ("draft", "standard", "reference")
COLUMNS = {
    "scene": "{}", "load": "{}", "fidelity": "{}", "dofs": "{:,}", "points": "{}",
    "iterations": "{}", "factorisations": "{}", "seconds": "{:.0f}", "peak_MB": "{:.0f}",
    "span_angle_deg": "{:.2f}", "chord_angle_deg": "{:.2f}", "rib_2_rotation_deg": "{:.2f}",
    "touching_from": "{}", "penetration_mm": "{:.4f}",
}


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--scene", nargs="+", default=list(SCENES), choices=SCENES)
    parser.add_argument("--load", nargs="+", default=list(LOADS), choices=LOADS)
    parser.add_argument("--fidelity", nargs="+", default=["draft"], choices=FIDELITIES)
    parser.add_argument("--ranks", type=int, default=2, help="MPI ranks of a case (default: 2)")
    parser.add_argument("--cells", type=int, default=18, metavar="N",
                        help="chambers in a row (default: 18, the prototype's)")
    parser.add_argument("--out", type=Path, metavar="CSV", help="all figures, case by case")
    parser.add_argument("--one", nargs=4, metavar=("SCENE", "LOAD", "FIDELITY", "N"),
                        help="run one case here and print its figures as JSON")
    arguments = parser.parse_args()
    if arguments.one:
        measured(*arguments.one[:3], int(arguments.one[3]))
        return
    rows = []
    for scene in arguments.scene:
        for load in arguments.load:
            if scene == "spar alone" and load != "pressure":
                continue  # cables pull at ribs
            for fidelity in arguments.fidelity:
                found = in_a_child(__file__, scene, load, fidelity, arguments.cells,
                                   ranks=arguments.ranks)
                rows.append({"scene": scene, "load": load, "fidelity": fidelity, **found})
                if arguments.out:
                    pd.DataFrame(rows).to_csv(arguments.out, index=False)
    Console(width=150).print(as_table(rows, arguments.ranks))


def as_table(rows, ranks):
    """Return the figures to print."""
    table = Table(title=f"Wing of Section 5.1, {ranks} rank(s); angles in degrees at the last load")
    for name in COLUMNS:
        heading = name.replace("_deg", "").replace("factorisations", "factors").replace("_", " ")
        table.add_column(heading, justify="right")
    for row in rows:
        table.add_row(*("" if row.get(name) is None else form.format(row[name])
                        for name, form in COLUMNS.items()))
    return table


def measured(scene, load, fidelity, n_cells):
    """Run one case and say its figures."""
    from mpi4py import MPI

    from morphing_wing import Wing
    from morphing_wing.geometry import WingGeometry

    comm, loads, changes = MPI.COMM_WORLD, LOADS[load], SCENES[scene]
    if changes.get("rib", True):
        small = {"rib_positions": (0.5,)} | changes
    else:
        small = changes
    Wing(WingGeometry.prototype(n_cells=2, **small), fidelity=fidelity).actuate(
        **dict.fromkeys(loads, 1e-5))  # compiles
    clock = time.perf_counter()
    wing = Wing(WingGeometry.prototype(n_cells=n_cells, **changes), fidelity=fidelity,
                contact=scene != "no contact")
    path = wing.actuate(**loads)
    seconds = time.perf_counter() - clock
    wanted = len(next(iter(loads.values())))
    touching = [state.load for state in path
                if state.measures.get("touching") or state.measures.get("contact")]
    say(comm, {
        "ranks": comm.size, "dofs": wing.dofs,
        "points": f"{sum(state.requested for state in path)}/{wanted}", "steps": len(path),
        "iterations": sum(state.newton_iterations for state in path),
        "factorisations": wing.newton.factor.factorisations, "seconds": seconds,
        "peak_MB": peak_MB(comm), "reason": path.reason,
        "touching_from": words(touching[0]) if touching else None,
        **(path[-1].measures if len(path) else {}),
    })


def words(load):
    """Return a load as one reads it in a table."""
    found = [f"{1000 * load['upper_MPa']:g} kPa"] if load["upper_MPa"] else []
    return ", ".join(found + ([f"{load['cable_N']:.3g} N"] if load["cable_N"] else []))


if __name__ == "__main__":
    main()
