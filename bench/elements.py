"""Elements and locking: the spar's angle against unknowns, of every element.

Four chambers of Section 3.3, upper row at 20 kPa in one step, half model, on three sequences: the
plain mesh and its uniform refinements, and the meshes graded at the chambers' corners. Beside the
elements that the package offers stand some that it does not, to show what they would do: two plain
displacement elements, and (DOLFINx 0.5 alone) serendipity displacements, S2. Each case runs in a
process of its own, on one core. The error is against the angle that the finest case of the default
element has, so that its own last row says nothing.

    python bench/elements.py --out elements.csv --picture elements.png
"""

import argparse
import time
from pathlib import Path

import pandas as pd
from child import in_a_child, peak_MB, say
from rich.console import Console
from rich.table import Table

PRESSURE, N_CELLS = 0.02, 4
MESHES = ("plain", "plain / 2", "plain / 3", "plain / 4", "graded 1", "graded 2", "graded 3")
CASES = {
    "Q2/P1disc": ("plain", "plain / 2", "plain / 3", "graded 1", "graded 2", "graded 3"),
    "Q2/Q1": ("plain", "plain / 2", "graded 1", "graded 2"),
    "Q2 reduced": ("plain", "plain / 2", "plain / 3", "graded 1", "graded 2"),
    "Q1/P0": ("plain", "plain / 2", "plain / 4", "graded 1", "graded 2", "graded 3"),
    "Q1 reduced": ("plain", "plain / 2", "plain / 4", "graded 1", "graded 2", "graded 3"),
    "Q2 displacement": ("plain", "plain / 2", "graded 1", "graded 2"),
    "Q1 displacement": ("plain", "plain / 2", "plain / 4", "graded 1", "graded 2"),
    "S2/P1disc": ("plain", "plain / 2", "graded 1", "graded 2"),
    "S2/Q1": ("plain", "plain / 2", "graded 1", "graded 2"),
}
REFERENCE = ("Q2/P1disc", "graded 3")


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--element", nargs="+", default=[e for e in CASES if e[0] != "S"],
                        choices=CASES, metavar="E")
    parser.add_argument("--out", type=Path, metavar="CSV", help="the table as a file")
    parser.add_argument("--picture", type=Path, metavar="PNG", help="angle against unknowns")
    parser.add_argument("--one", nargs=2, metavar=("ELEMENT", "MESH"),
                        help="run one case here and print its figures as JSON")
    arguments = parser.parse_args()
    if arguments.one:
        measured(*arguments.one)
        return
    rows = []
    for name in arguments.element:
        for mesh in CASES[name]:
            rows.append({"element": name, "mesh": mesh, **in_a_child(__file__, name, mesh)})
    table = pd.DataFrame(rows)
    is_reference = (table["element"] == REFERENCE[0]) & (table["mesh"] == REFERENCE[1])
    if is_reference.any():
        converged = table.loc[is_reference, "angle_deg"].iloc[0]
        table["error_percent"] = 100.0 * (table["angle_deg"] / converged - 1.0)
    shown(table)
    if arguments.out:
        table.to_csv(arguments.out, index=False)
    if arguments.picture:
        drawn(table, arguments.picture)


def measured(name, mesh):
    """Run one case and say its figures."""
    from mpi4py import MPI

    from morphing_wing import compat
    from morphing_wing.elements import ELEMENTS, Element
    from morphing_wing.geometry.spar import SparGeometry, SparMeshing
    from morphing_wing.spar import Spar

    ELEMENTS["Q2 displacement"] = Element("Q2 displacement", 2, None, 5, 5)
    ELEMENTS["Q1 displacement"] = Element("Q1 displacement", 1, None, 3, 3)
    ELEMENTS["S2/P1disc"] = Element("S2/P1disc", 2, ("DPC", 1), 5, 5)
    ELEMENTS["S2/Q1"] = Element("S2/Q1", 2, ("Lagrange", 1), 5, 5)
    if name.startswith("S2"):
        compat._with_displacement = with_serendipity
    kind, level = (*mesh.replace("/", " ").split(), "1")[:2]
    meshing = (SparMeshing.plain().split(int(level)) if kind == "plain"
               else SparMeshing.graded(int(level)))

    def spar(n, meshing):
        return Spar(SparGeometry.validation(n), element=name, meshing=meshing, comm=MPI.COMM_SELF)

    spar(1, SparMeshing.plain()).inflate(upper=1e-3)  # compiles
    clock = time.perf_counter()
    scene = spar(N_CELLS, meshing)
    path = scene.inflate(upper=PRESSURE)
    say(MPI.COMM_SELF, {
        "dofs": scene.dofs, "angle_deg": path[-1].measures["span_angle_deg"] if path.converged
        else float("nan"), "steps": len(path),
        "iterations": sum(state.newton_iterations for state in path),
        "seconds": time.perf_counter() - clock, "peak_MB": peak_MB(MPI.COMM_SELF)})


def with_serendipity(mesh, degree, other):
    """Return the mixed space of a serendipity displacement (20 nodes) and another element.

    Its unknowns on edges are moments; where those of a face are zero, so is the displacement.
    """
    import ufl
    from dolfinx import fem

    u = ufl.VectorElement("S", mesh.ufl_cell(), degree)
    return fem.FunctionSpace(mesh, ufl.MixedElement([u, other]))


def shown(table):
    """Print the table."""
    printed = Table(title="Spar of Section 3.3, N = 4, 20 kPa, one core")
    for column in table:
        printed.add_column(column, justify="left" if column in ("element", "mesh") else "right")
    for row in table.itertuples(index=False):
        printed.add_row(*(f"{v:,.4g}" if isinstance(v, float) else f"{v:,}" if isinstance(v, int)
                          else str(v) for v in row))
    Console(width=110).print(printed)


def drawn(table, file):
    """Draw the angle against unknowns: full lines graded meshes, dashed ones plain."""
    from matplotlib.figure import Figure

    figure = Figure(figsize=(7.5, 5.0), layout="constrained")
    axes = figure.add_subplot()
    for i, (name, rows) in enumerate(table.groupby("element", sort=False)):
        for graded, line in ((True, "-"), (False, "--")):
            part = rows[rows["mesh"].str.startswith("graded") == graded].sort_values("dofs")
            axes.plot(part["dofs"], part["angle_deg"], line, color=f"C{i}", marker="o",
                      markersize=4, label=name if graded else None)
    axes.set(xscale="log", xlabel="unknowns", ylabel=r"$\varphi_1$ at 20 kPa, degrees",
             title="spar of four chambers; full: graded at the corners, dashed: plain")
    axes.grid(alpha=0.3, which="both")
    axes.legend(ncols=2, fontsize=8)
    figure.savefig(file, dpi=150)


if __name__ == "__main__":
    main()
