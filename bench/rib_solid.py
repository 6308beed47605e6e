"""The solid rib's convergence: degrees per N mm of end moment against unknowns, and where it leads.

Six cells, half by symmetry, E = 2500 MPa, nu = 0.35, four meshes each, from 8 to 18 elements around
a cylinder; the angle is fitted by a - c around^-q, a is the limit. Beside it frame and condensed
cell. Ten minutes in all, 4 GB; ``--ranks 2`` and four coarser ``--around`` for less.
"""

import argparse
import time
from pathlib import Path

from child import in_a_child, peak_MB, say
from rich.console import Console
from rich.table import Table

from morphing_wing.tradeoff.limit import limit as fitted

CASES = {"3.3 square, bosses": ("validation", "square", True),
         "3.3 flush": ("validation", "flush", False),
         "5.1 square, bosses": ("prototype", "square", True),
         "5.1 flush": ("prototype", "flush", False)}
AROUND = (8, 12, 15, 18)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--case", nargs="+", default=list(CASES), choices=CASES)
    parser.add_argument("--around", nargs="+", type=int, default=list(AROUND), metavar="N")
    parser.add_argument("--ranks", type=int, default=1)
    parser.add_argument("--out", type=Path, metavar="PNG", help="picture of the convergence")
    parser.add_argument("--one", nargs=2, metavar=("CASE", "AROUND"),
                        help="run one case here and print its figures as JSON")
    arguments = parser.parse_args()
    if arguments.one:
        measured(arguments.one[0], arguments.one[1])
        return
    table = Table(title=f"Solid rib of six cells, {arguments.ranks} rank(s)")
    for column in ("rib", "around", "unknowns", "mesh, s", "solve, s", "iterations", "peak, MB",
                   "deg per N mm", "to the limit"):
        table.add_column(column, justify="right", no_wrap=True)
    found = {}
    for case in arguments.case:
        rows = [in_a_child(__file__, case, str(n), ranks=arguments.ranks) for n in arguments.around]
        limit, order = fitted(arguments.around, [row["angle"] for row in rows])
        rows += [in_a_child(__file__, case, name) for name in ("cell", "draft")]
        found[case] = rows, limit
        table.add_section()
        for row in rows:
            table.add_row(case, row["around"], f"{row['dofs']:,}", f"{row['mesh']:.1f}",
                          f"{row['solve']:.1f}", str(row["iterations"]), f"{row['peak_MB']:.0f}",
                          f"{row['angle']:.4f}", f"{row['angle'] / limit - 1:+.2%}")
        table.add_row(case, "limit", "", "", "", "", "", f"{limit:.4f}", f"order {order:.1f}")
    Console(width=130).print(table)
    if arguments.out:
        draw(found, arguments.out)


def measured(case, around):
    """Run one case and say its figures."""
    from dataclasses import replace

    from mpi4py import MPI

    from morphing_wing import Rib
    from morphing_wing.geometry import RibGeometry
    from morphing_wing.materials import Elastic

    comm = MPI.COMM_WORLD
    preset, section, bosses = CASES[case]
    geometry = replace(getattr(RibGeometry, preset)(section=section, bosses=bosses), n_cells=6)
    resin, kind = Elastic(2500.0, 0.35), {"comm": comm, "fidelity": around}
    if around.isdigit():
        kind |= {"fidelity": "standard", "around": int(around)}
    Rib(replace(geometry, n_cells=2, shaft_length=7.0), resin, **kind).bend(torque=1e-3)  # compiles
    clock = time.perf_counter()
    rib = Rib(geometry, resin, **kind)
    made = time.perf_counter()
    state = rib.bend(torque=1.0)[-1]
    say(comm, {"around": around, "dofs": rib.dofs, "mesh": made - clock,
               "solve": time.perf_counter() - made, "iterations": state.newton_iterations,
               "angle": state.measures["chord_angle_deg"], "peak_MB": peak_MB(comm)})


def draw(found, file):
    """Draw the distance from the limit against unknowns."""
    from matplotlib.figure import Figure

    figure = Figure(figsize=(7.0, 4.5), layout="constrained")
    axes = figure.add_subplot()
    for i, (case, (rows, limit)) in enumerate(found.items()):
        solids = [row for row in rows if row["around"].isdigit()]
        off = [100 * (row["angle"] / limit - 1) for row in solids]
        axes.plot([row["dofs"] for row in solids], off, "o-", color=f"C{i}", label=case)
        for row, marker in zip(rows[len(solids):], "sD", strict=True):
            axes.plot(row["dofs"], 100 * (row["angle"] / limit - 1), marker, color=f"C{i}",
                      mfc="white")
    axes.plot([], [], "ks", mfc="white", label="condensed cell")
    axes.plot([], [], "kD", mfc="white", label="frame")
    axes.axhline(0.0, color="0.5", lw=0.8)
    axes.set(xscale="log", xlabel="unknowns", ylabel="degrees per N mm, % off the solid's limit",
             title="Rib of six cells under an end moment")
    axes.grid(alpha=0.3, which="both")
    axes.legend(fontsize=8)
    figure.savefig(file, dpi=150)


if __name__ == "__main__":
    main()
