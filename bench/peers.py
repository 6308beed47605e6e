"""The spar on one mesh by this package, FElupe and CalculiX: the same angles, and what they cost.

The half model of Section 3.3 on the mesh of ``SparMeshing.plain()``, upper row inflated, 20 kPa a
load step. This package and FElupe (`pip install felupe tensortrax pypardiso`) solve the same
equations, Q1/P0 and Q2/P1disc; CalculiX (`apt-get install calculix-ccx`) has no such elements: its
C3D20R stands against Q2/P1disc, and cuts the steps as it must. Each case runs in a process of its
own, timed from outside: "process" is all of it, from the start of Python to its end, "solve" the
model, the load steps and the angle without start-up and imports; where "CPU" is much less than the
process, others were using the machine. Forms are compiled before. What takes less than ten seconds
is run three times, and the fastest counts.
"""

import argparse
import importlib.util
import resource
import shutil
import tempfile
import time
from pathlib import Path

from child import in_a_child
from rich.console import Console
from rich.table import Table

CASE = Path(__file__).with_name("peer_case.py")
QUICK = [("Q1/P0", 4, 0.02), ("Q2/P1disc", 4, 0.02), ("C3D20R", 4, 0.02)]
ALL = [*QUICK, ("Q1/P0", 20, 0.02), ("Q2/P1disc", 20, 0.02), ("C3D20R", 20, 0.02),
       ("Q2/P1disc", 20, 0.04)]
KNOWN = {("Q1/P0", 4, 0.02): 3.6921, ("Q2/P1disc", 4, 0.02): 3.8575,
         ("Q1/P0", 20, 0.02): 18.5451, ("Q2/P1disc", 20, 0.02): 19.2449,
         ("C3D20R", 20, 0.02): 19.2233, ("Q2/P1disc", 20, 0.04): 44.6434}
RUNS, ENOUGH = 3, 10.0  # runs, and the seconds after which one is enough


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--all", action="store_true", help="20 chambers too: minutes, 2 GB")
    parser.add_argument("--ranks", type=int, default=1, metavar="R",
                        help="this package on R ranks, the others on R threads, too")
    parser.add_argument("--startup", action="store_true", help="only what it takes to start")
    arguments = parser.parse_args()
    console = Console(width=170)
    there = {"FElupe": all(map(importlib.util.find_spec, ("felupe", "tensortrax"))),
             "CalculiX": shutil.which("ccx") is not None}
    for name in (name for name, found in there.items() if not found):
        console.print(f"{name} is not installed: its rows are left out.")
    peers = {name for name, found in there.items() if found}
    with tempfile.TemporaryDirectory() as folder:
        if arguments.startup:
            console.print(start_up(peers, Path(folder)))
        else:
            cases = ALL if arguments.all else QUICK
            console.print(compared(cases, peers, arguments.ranks, Path(folder)))


def compared(cases, peers, ranks, folder):
    """Return the table of all cases."""
    table = Table(title="In brackets: ratio to ours on as many cores")
    for column in ("code", "cores", "element", "N", "kPa", "unknowns", "known, deg", "angle, deg",
                   "iterations", "solve, s", "process, s", "CPU, s", "peak, MB"):
        table.add_column(column, justify="left" if column == "code" else "right", no_wrap=True)
    ours = {}
    for code, element, n_cells, pressure, cores in chosen(cases, peers, ranks):
        found = fastest(code, element, n_cells, pressure, cores, folder)
        if code == "ours":
            ours[element, n_cells, pressure, cores] = found
        base = ours["Q2/P1disc" if element == "C3D20R" else element, n_cells, pressure, cores]
        known = KNOWN.get((element, n_cells, pressure))
        table.add_row(
            found["code"], str(cores), element, str(n_cells), f"{1000 * pressure:g}",
            f"{found['dofs']:,}", "" if known is None else f"{known:.4f}",
            f"{found['angle']:.4f}", str(found["iterations"]),
            *(f"{found[name]:.{digits}f}" + (
                "" if code == "ours" else f" ({found[name] / base[name]:.1f})")
              for name, digits in (("solve", 2), ("process", 2), ("CPU", 2), ("peak_MB", 0))))
    return table


def chosen(cases, peers, ranks):
    """Yield code, element, chambers, pressure and cores, ours before those compared with it."""
    for element, n_cells, pressure in cases:
        for code in ("CalculiX",) if element == "C3D20R" else ("ours", "FElupe"):
            if code == "ours" or code in peers:
                for cores in sorted({1, ranks}):
                    yield code, element, n_cells, pressure, cores


def start_up(peers, folder):
    """Return the table of what new processes take for little."""
    table = Table(title="Seconds of a new process")
    table.add_column("process")
    table.add_column("s", justify="right")
    draft = ("Q1/P0", 20, 0.02, 1)
    name = "Q1/P0, N = 20, 20 kPa"

    def row(what, *case, runs=RUNS, cache=None):
        found = fastest(*case, folder, cache, runs=runs)
        table.add_row(what, f"{found['process']:.2f}")

    row("import morphing_wing", "import", "morphing_wing", 20, 0.0, 1)
    row("from morphing_wing import Spar", "import", "morphing_wing.spar", 20, 0.0, 1)
    row(f"this package, {name}", "ours", *draft)
    row(f"this package, {name}, nothing compiled before", "ours", *draft, runs=1,
        cache=folder / "empty")
    if "FElupe" in peers:
        row("import felupe", "import", "felupe", 20, 0.0, 1)
        row(f"FElupe, {name}", "FElupe", *draft)
    return table


def fastest(*case, runs=RUNS):
    """Return the figures of the fastest of some runs of a case."""
    found = [one(*case)]
    while len(found) < runs and found[0]["process"] < ENOUGH:
        found.append(one(*case))
    return min(found, key=lambda figures: figures["process"])


def one(code, element, n_cells, pressure, cores, folder, cache=None):
    """Return the figures of one case, run in a process of its own."""
    file = folder / f"{n_cells}.npz"
    threads = 1 if code == "ours" else cores
    settings = {name: str(threads) for name in ("OMP_NUM_THREADS", "MKL_NUM_THREADS")}
    if code == "ours":
        # Kernels of our own: others' in the same folder, and who else compiles, take time.
        settings["XDG_CACHE_HOME"] = str(cache or folder / "cache")
    if not file.exists():
        in_a_child(CASE, "prepare", element, n_cells, 0.0, 1, file,
                   environment={"XDG_CACHE_HOME": str(folder / "cache")})
    clock, before = time.perf_counter(), cpu_of_children()
    found = in_a_child(CASE, code, element, n_cells, pressure, threads, file,
                       ranks=cores if code == "ours" else 1, environment=settings)
    return found | {"process": time.perf_counter() - clock, "CPU": cpu_of_children() - before}


def cpu_of_children():
    """Return the seconds of CPU of all processes that this one has run and waited for."""
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    return used.ru_utime + used.ru_stime


if __name__ == "__main__":
    main()
