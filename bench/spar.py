"""The spar's rungs: angle, error, iterations, seconds and memory of each fidelity and size.

The paper's validation set (Section 3.3), upper row at 20 kPa in one load step, half model. Each
case runs in a process of its own. The error is against angles converged under refinement:
1.951 (N = 2), 3.99 (N = 4) and 20.09 degrees (N = 20, by one cell). Seconds leave out the
compilation of the forms and count assembly and factorisation apart.
"""

import argparse
import sys
import time

from child import in_a_child, peak_MB, say
from rich.console import Console
from rich.table import Table

CONVERGED = {2: 1.951, 4: 3.99, 20: 20.09}
FIDELITIES = ("draft", "standard")
PRESSURE = 0.02


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--cells", type=int, nargs="+", default=[2, 4, 20], metavar="N",
                        help="numbers of chambers in a row (default: 2 4 20)")
    parser.add_argument("--fidelity", nargs="+", default=FIDELITIES, choices=FIDELITIES)
    parser.add_argument("--one", nargs=2, metavar=("FIDELITY", "N"),
                        help="run one case here and print its figures as JSON")
    arguments = parser.parse_args()
    if arguments.one:
        measured(arguments.one[0], int(arguments.one[1]))
        return
    table = Table(title="Spar of Section 3.3 at 20 kPa, one load step, one core")
    for column in ("fidelity", "N", "dofs", "angle, deg", "error, %", "iterations",
                   "assembly, s", "factor, s", "all, s", "peak, MB"):
        table.add_column(column, justify="right")
    for n_cells in arguments.cells:
        for fidelity in arguments.fidelity:
            found = in_a_child(__file__, fidelity, n_cells)
            exact = CONVERGED.get(n_cells)
            error = "" if exact is None else f"{100 * (found['angle'] / exact - 1):+.2f}"
            table.add_row(
                fidelity, str(n_cells), f"{found['dofs']:,}", f"{found['angle']:.4f}", error,
                str(found["iterations"]), f"{found['assembly']:.2f}", f"{found['factor']:.2f}",
                f"{found['seconds']:.2f}", f"{found['peak_MB']:.0f}")
    Console(width=110).print(table)


def measured(fidelity, n_cells):
    """Run one case and say its figures."""
    from mpi4py import MPI

    from morphing_wing.geometry.spar import SparGeometry
    from morphing_wing.materials import DRAGON_SKIN_30
    from morphing_wing.spar import Spar
    from morphing_wing.stopwatch import Stopwatch

    def spar(n):
        return Spar(SparGeometry.validation(n), DRAGON_SKIN_30, fidelity=fidelity)

    spar(1).inflate(upper=1e-3)  # compiles
    clock = time.perf_counter()
    scene = spar(n_cells)
    timed = Stopwatch(scene)
    path = scene.inflate(upper=PRESSURE)
    seconds = time.perf_counter() - clock
    if not path.converged or len(path) != 1:
        sys.exit(f"fidelity {fidelity}, N = {n_cells}: {len(path)} steps, {path.reason}")
    say(MPI.COMM_SELF, {
        "dofs": scene.dofs, "angle": path[0].measures["span_angle_deg"],
        "iterations": path[0].newton_iterations, "assembly": timed.seconds["assembly"],
        "factor": timed.seconds["factor"], "seconds": seconds,
        "peak_MB": peak_MB(MPI.COMM_SELF),
    })


if __name__ == "__main__":
    main()
