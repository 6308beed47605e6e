"""The frame rib: stiffness against exact Timoshenko frames, linearity, iterations, seconds, memory.

Six cells, both presets and both sections, E = 2500 MPa, nu = 0.35. First 0.1 N mm at the tail, then
in one load step the torque that would turn it by 45 degrees if it went on as it began. Each case
runs in a process of its own; seconds leave out the compilation of the forms.
"""

import argparse
import time
from dataclasses import replace

from child import in_a_child, peak_MB, say
from rich.console import Console
from rich.table import Table

EXACT = {("validation", "square"): 1.901, ("validation", "flush"): 1.028,
         ("prototype", "square"): 3.03, ("prototype", "flush"): 1.322}
SMALL = 0.1  # N mm


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--one", nargs=2, metavar=("PRESET", "SECTION"),
                        help="run one case here and print its figures as JSON")
    arguments = parser.parse_args()
    if arguments.one:
        measured(*arguments.one)
        return
    table = Table(title="Frame rib of six cells under an end moment, one core")
    for column in ("preset", "section", "dofs", "deg per N mm", "error, %", "at 45 deg, %",
                   "iterations", "all, s", "peak, MB"):
        table.add_column(column, justify="right")
    for (preset, section), exact in EXACT.items():
        found = in_a_child(__file__, preset, section)
        table.add_row(
            preset, section, str(found["dofs"]), f"{found['slope']:.4f}",
            f"{100 * (found['slope'] / exact - 1):+.2f}", f"{100 * found['change']:+.2f}",
            str(found["iterations"]), f"{found['seconds']:.2f}", f"{found['peak_MB']:.0f}")
    Console(width=110).print(table)


def measured(preset, section):
    """Run one case and say its figures."""
    from mpi4py import MPI

    from morphing_wing import Rib
    from morphing_wing.geometry import RibGeometry
    from morphing_wing.materials import Elastic

    geometry = replace(getattr(RibGeometry, preset)(section=section), n_cells=6)
    Rib(geometry, Elastic(2500.0, 0.35)).bend(torque=SMALL)  # compiles
    clock = time.perf_counter()
    rib = Rib(geometry, Elastic(2500.0, 0.35))
    slope = rib.bend(torque=SMALL)[-1].measures["chord_angle_deg"] / SMALL
    path = rib.bend(torque=45.0 / slope)
    seconds = time.perf_counter() - clock
    say(MPI.COMM_SELF, {
        "dofs": rib.dofs, "slope": slope,
        "change": path[-1].measures["chord_angle_deg"] / 45.0 - 1.0,
        "iterations": sum(state.newton_iterations for state in path), "seconds": seconds,
        "peak_MB": peak_MB(MPI.COMM_SELF),
    })


if __name__ == "__main__":
    main()
