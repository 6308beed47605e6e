"""Linear solvers: seconds, memory and accuracy of each on one tangent, the spar's and the wing's.

The half spar of Section 3.3 at rest under 20 kPa in its upper chambers (Q2/P1disc), refined as it
grows: about 40, 200 and, with ``--large``, 800 thousand unknowns; with ``--wing`` also the wing of
Section 5.1 at standard. A process of its own makes the matrix and leaves it in a folder, so that
what a solver's process takes is the matrix and the solver. ``--newton`` solves the spar of 200
thousand unknowns from 0 to 20 kPa on one rank and on two. A threaded OpenBLAS needs not be the
system's, it may lie in a folder:

    apt-get download libopenblas0-pthread && dpkg -x libopenblas0-pthread_*.deb folder
    python bench/solvers.py --wing --newton \
        --threaded-blas folder/usr/lib/x86_64-linux-gnu/openblas-pthread
"""

import argparse
import math
import os
import tempfile
import time
from pathlib import Path

import pandas as pd
from child import in_a_child, peak_MB, say
from rich.console import Console
from rich.table import Table
from tangents import PRESSURE, SPARS, WINGS, loaded, spar, wing, written

import morphing_wing  # noqa: F401  (before PETSc: it names the BLAS's kernel)

MUMPS = {"mat_mumps_icntl_13": 1}  # as the package has it
BLR = MUMPS | {"mat_mumps_icntl_35": 2}
SOLVERS = {
    "LDL'": MUMPS,
    "LDL', AMD": MUMPS | {"mat_mumps_icntl_7": 0},
    "LDL', AMF": MUMPS | {"mat_mumps_icntl_7": 2},
    "LDL', SCOTCH": MUMPS | {"mat_mumps_icntl_7": 3},
    "LDL', PORD": MUMPS | {"mat_mumps_icntl_7": 4},
    "LDL', METIS": MUMPS | {"mat_mumps_icntl_7": 5},
    "LDL', QAMD": MUMPS | {"mat_mumps_icntl_7": 6},
    "LDL', BLR 1e-10": BLR | {"mat_mumps_cntl_7": 1e-10},
    "LDL', BLR 1e-6": BLR | {"mat_mumps_cntl_7": 1e-6},
    "LU": MUMPS | {"pc_type": "lu", "pc_factor_mat_solver_type": "mumps"},
    "SuperLU_DIST": {"pc_type": "lu", "pc_factor_mat_solver_type": "superlu_dist"},
    "iterative": {},
}
DEFAULT, ITERATIVE = "LDL'", "iterative"  # the package's own and the other kind
ORDERINGS = {0: "AMD", 2: "AMF", 3: "SCOTCH", 4: "PORD", 5: "METIS", 6: "QAMD"}
RUNS = [(name, 1, 1) for name in SOLVERS] + [(DEFAULT, 2, 1), (DEFAULT, 1, 2),
                                             ("SuperLU_DIST", 2, 1)]
LARGE = [(DEFAULT, 2, 1), (ITERATIVE, 1, 1)]
COLUMNS = {"solver": "{}", "unknowns": "{:,}", "ranks": "{}", "threads": "{}",
           "ordering": "{}", "analysis_s": "{:.2f}", "factor_s": "{:.2f}", "solve_s": "{:.2f}",
           "iterations": "{}", "peak_MB": "{:,.0f}", "factor_entries": "{:,.1f} M",
           "residual": "{:.0e}", "error": "{:.0e}"}


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--sizes", type=int, nargs="*", default=[40, 200], choices=SPARS,
                        metavar="K", help="thousands of unknowns: 40, 200, 800 (default: 40 200)")
    parser.add_argument("--large", action="store_true", help="800 too, with the two that fit")
    parser.add_argument("--wing", action="store_true",
                        help="the wing's matrix too, and the largest wing that 24 GiB carry")
    parser.add_argument("--newton", action="store_true", help="a whole solve on 1 and 2 ranks")
    parser.add_argument("--threaded-blas", type=Path, metavar="FOLDER",
                        help="where a threaded libopenblas.so.0 lies, for two threads")
    parser.add_argument("--out", type=Path, metavar="CSV", help="the table as a file")
    parser.add_argument("--one", nargs="+", help="run one case here, print its figures as JSON")
    arguments = parser.parse_args()
    if arguments.one:
        kind, *case = arguments.one
        {"write": written, "solve": solved, "newton": newton, "memory": memory}[kind](*case)
        return
    systems = [f"spar-{size}" for size in arguments.sizes]
    systems += ["spar-800"] * (arguments.large and 800 not in arguments.sizes)
    systems += ["wing-standard"] * arguments.wing
    rows = []
    for system in systems:
        for row in compared(system, arguments.threaded_blas):
            rows.append(row)
            if arguments.out:
                pd.DataFrame(rows).to_csv(arguments.out, index=False)
    if rows:
        for row in {row["system"]: row for row in rows}.values():
            print(f"{row['system']}: its assembly takes {row['assembled_peak_MB']:,.0f} MB")
        shown("Linear solvers on one tangent at rest under 20 kPa", COLUMNS, rows)
        print(growth([row for row in rows if row["system"].startswith("spar")]))
    if arguments.newton:
        found = [in_a_child(__file__, "newton", 200, ranks=ranks) for ranks in (1, 2)]
        shown("Spar from 0 to 20 kPa", dict.fromkeys(found[0], "{}"), found)
    if arguments.wing:
        found = [in_a_child(__file__, "memory", mesh) for mesh in WINGS]
        shown("The wing's memory, one rank", dict.fromkeys(found[0], "{}"), found)
        print(largest(found))


def compared(system, threaded_blas):
    """Yield the figures of each solver on one system."""
    with tempfile.TemporaryDirectory() as folder:
        made = in_a_child(__file__, "write", system, folder)
        for name, ranks, threads in LARGE if system == "spar-800" else RUNS:
            if threads > 1 and threaded_blas is None or name == ITERATIVE and "wing" in system:
                continue
            environment = {} if threads == 1 else {
                "OPENBLAS_NUM_THREADS": threads, "OMP_NUM_THREADS": threads,
                "LD_LIBRARY_PATH": threaded_blas.resolve()}
            head = {"system": system, "solver": name, "ranks": ranks, "threads": threads}
            try:
                found = in_a_child(__file__, "solve", name, folder, ranks=ranks,
                                   environment=environment)
            except RuntimeError as error:
                found = {"ordering": "failed", "reason": str(error)}
            yield head | made | found


def solved(name, folder):
    """Solve a written system, say what it took."""
    from mpi4py import MPI
    from petsc4py import PETSc

    comm = MPI.COMM_WORLD
    file = PETSc.Viewer().createBinary(f"{folder}/system", "r", comm=comm)
    matrix, b = PETSc.Mat().load(file), PETSc.Vec().load(file)
    matrix.setOption(PETSc.Mat.Option.SYMMETRIC, True)
    x = b.duplicate()
    PETSc.Log.begin()
    clock = time.perf_counter()
    if name == ITERATIVE:
        solver = iterative(matrix, folder)
    else:
        solver = direct(matrix, SOLVERS[name])
    solver.setUp()
    prepared = time.perf_counter()
    solver.solve(b, x)
    figures = {"solve_s": time.perf_counter() - prepared,
               "iterations": solver.getIterationNumber(), "peak_MB": peak_MB(comm)}
    analysis = max(PETSc.Log.Event(event).getPerfInfo()["time"]
                   for event in ("MatCholFctrSym", "MatLUFactorSym")) if name != ITERATIVE else 0.0
    figures |= {"analysis_s": analysis, "factor_s": prepared - clock - analysis}
    if "mat_mumps_icntl_13" in SOLVERS[name]:
        factor = solver.getPC().getFactorMatrix()
        ordering = factor.getMumpsInfog(7)
        entries = factor.getMumpsInfog(35)  # after compression
        figures |= {"ordering": ORDERINGS.get(ordering, ordering),
                    "factor_entries": entries / 1e6 if entries > 0 else -float(entries)}
    residual = matrix.createVecLeft()
    matrix.mult(x, residual)
    residual.axpy(-1.0, b)
    figures["residual"] = residual.norm() / b.norm()
    reference = Path(folder, "reference")
    if reference.exists():
        exact = PETSc.Vec().load(PETSc.Viewer().createBinary(str(reference), "r", comm=comm))
        size = exact.norm()
        exact.axpy(-1.0, x)
        figures["error"] = exact.norm() / size
    elif name == DEFAULT:
        x.view(PETSc.Viewer().createBinary(str(reference), "w", comm=comm))
    say(comm, figures)
    solver.destroy()  # else Python's parts of it may outlive PETSc


def direct(matrix, options):
    """Return a solver by a factor; where that is compressed, with refinement."""
    from petsc4py import PETSc

    for option, value in options.items():
        PETSc.Options("spar_factor_").setValue(option, value)
    solver = PETSc.KSP().create(matrix.comm)
    solver.setOptionsPrefix("spar_factor_")
    solver.setOperators(matrix)
    exact = "mat_mumps_icntl_35" not in options
    solver.setType("preonly" if exact else "fgmres")
    solver.setTolerances(rtol=1e-10)
    solver.getPC().setType("cholesky")
    solver.getPC().setFactorSolverType("mumps")
    solver.setFromOptions()
    return solver


def iterative(matrix, folder):
    """Return FGMRES with the preconditioner of `iterative`."""
    import numpy as np
    from iterative import AugmentedMultigrid, Parts
    from petsc4py import PETSc
    from scipy.sparse import load_npz

    with np.load(f"{folder}/parts.npz") as file:
        parts = Parts(file["u"], file["p"], load_npz(f"{folder}/up.npz"), *file["moduli"])
    solver = PETSc.KSP().create(matrix.comm)
    solver.setOptionsPrefix("spar_iterative_")
    solver.setOperators(matrix)
    solver.setType("fgmres")
    solver.setGMRESRestart(100)
    solver.setTolerances(rtol=1e-8, max_it=500)
    solver.getPC().setType("python")
    solver.getPC().setPythonContext(AugmentedMultigrid(matrix, parts))
    solver.setFromOptions()
    return solver


def newton(size):
    """Solve a spar from rest under pressure, say where the seconds went."""
    from mpi4py import MPI

    from morphing_wing.stopwatch import Stopwatch

    spar(40).inflate(upper=1e-3)  # compiles
    comm, clock = MPI.COMM_WORLD, time.perf_counter()
    scene = spar(int(size))
    timed = Stopwatch(scene)
    ready = time.perf_counter()
    path = scene.inflate(upper=PRESSURE)
    done = time.perf_counter()
    seconds = {"mesh": ready - clock, "assembly": timed.seconds["assembly"],
               "factor": timed.seconds["factor"], "solve in all": done - ready}
    say(comm, {"ranks": comm.size, "unknowns": scene.dofs,
               "steps": len(path), "iterations": sum(state.newton_iterations for state in path),
               "factorisations": scene.newton.factor.factorisations,
               **{f"{name}, s": round(value, 1) for name, value in seconds.items()},
               "angle, deg": round(path[-1].measures["span_angle_deg"], 6),
               "peak MB": round(peak_MB(comm))})


def memory(mesh):
    """Factorise a wing's tangent, say what it took."""
    from mpi4py import MPI

    comm, clock = MPI.COMM_WORLD, time.perf_counter()
    scene = wing(mesh)
    loaded(scene)
    before, assembled = peak_MB(comm), time.perf_counter()
    factor = scene.newton.linearise()._inner.matrix
    entries = factor.getMumpsInfog(29)
    say(comm, {"mesh": mesh, "unknowns": scene.dofs, "assembly, s": round(assembled - clock, 1),
               "factor, s": round(time.perf_counter() - assembled, 1),
               "factor, M non-zeros": round(entries / 1e6 if entries > 0 else -entries, 1),
               "MUMPS MB": factor.getMumpsInfog(22), "before factor, peak MB": round(before),
               "peak MB": round(peak_MB(comm))})


def growth(rows):
    """Return in words how time and memory of the default and of the iterative solver grow."""
    lines = []
    for name, ranks in ((DEFAULT, 1), (DEFAULT, 2), (ITERATIVE, 1)):
        mine = [row for row in rows if row["solver"] == name and row["ranks"] == ranks
                and row["threads"] == 1 and "solve_s" in row]
        for small, large in zip(mine, mine[1:], strict=False):
            seconds = [row["factor_s"] + row["solve_s"] for row in (small, large)]
            n = math.log(large["unknowns"] / small["unknowns"])
            by = {"seconds": seconds, "memory": (small["peak_MB"], large["peak_MB"])}
            words = ", ".join(f"{what} as n^{math.log(b / a) / n:.2f}"
                              for what, (a, b) in by.items())
            lines.append(f"{name}, {ranks} rank(s), {small['unknowns']:,} to "
                         f"{large['unknowns']:,}: factor and solve {words}")
    return "\n".join(lines)


def largest(found, limit_MB=24 * 1024):
    """Return in words how many unknowns a memory carries, by a power law through the figures."""
    import numpy as np

    n = np.log([row["unknowns"] for row in found])
    slope, start = np.polyfit(n, np.log([row["peak MB"] for row in found]), 1)
    most = math.exp((math.log(limit_MB) - start) / slope)
    return (f"peak MB = {math.exp(start):.3g} n^{slope:.2f}, one rank, no field kept: "
            f"{limit_MB / 1024:g} GiB carry {most:,.0f} unknowns")


def shown(title, columns, rows):
    """Print a table."""
    table = Table(title=title)
    for name in columns:
        table.add_column(name.replace("_", " "), justify="right")
    for before, row in zip([rows[0], *rows], rows, strict=False):
        if before.get("system") != row.get("system"):
            table.add_section()
        table.add_row(*("" if row.get(name) is None else form.format(row[name])
                        for name, form in columns.items()))
    Console(width=150).print(table)


if __name__ == "__main__":
    os.environ.setdefault("OMP_NUM_THREADS", "1")
    main()
