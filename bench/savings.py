"""What it saves to model only what a scene requires: half a spar, one row, one cell, a linear rib.

Each pair is the same question asked of the larger and of the smaller model, at "standard" where
there is a mesh, in processes of their own on one core. Seconds leave out the compilation of forms.
A rib's moments are asked for by ten loads, of Newton's method and of one factorisation whose
answer is scaled.
"""

import argparse
import time

from child import in_a_child, peak_MB, say
from rich.console import Console
from rich.table import Table

CASES = {
    "whole width": "spar, N = 20, 20 kPa", "half, by symmetry": "spar, N = 20, 20 kPa",
    "one cell": "spar, N = 20, 20 kPa", "both rows in use": "spar, N = 20, 20 kPa",
    "Newton, 10 moments": "rib, 0 to 20 N mm", "one factor, scaled": "rib, 0 to 20 N mm",
    "formula": "rib, 0 to 20 N mm",
}
BASE = {"spar, N = 20, 20 kPa": "half, by symmetry", "rib, 0 to 20 N mm": "Newton, 10 moments"}
COLUMNS = {"question": "{}", "model": "{}", "dofs": "{:,}", "iterations": "{}",
           "assembly": "{:.2f}", "factor": "{:.2f}", "seconds": "{:.3g}", "peak_MB": "{:.0f}",
           "angle_deg": "{:.4f}", "times": "{:.2f}"}


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--one", metavar="MODEL", choices=CASES,
                        help="run one case here and print its figures as JSON")
    arguments = parser.parse_args()
    if arguments.one:
        measured(arguments.one)
        return
    found = {model: in_a_child(__file__, model) for model in CASES}
    table = Table(title="seconds on one core; times: of the seconds of the usual model")
    for column in COLUMNS:
        table.add_column(column, justify="right")
    for model, question in CASES.items():
        times = found[model]["seconds"] / found[BASE[question]]["seconds"]
        row = found[model] | {"question": question, "model": model, "times": times}
        table.add_row(*(form.format(row[name]) for name, form in COLUMNS.items()))
    Console(width=130).print(table)


def measured(model):
    """Run one case and say its figures."""
    from mpi4py import MPI

    from morphing_wing.geometry import SparGeometry

    if CASES[model].startswith("rib"):
        figures = rib(model)
    else:
        spar(model, SparGeometry.validation(1))  # compiles
        figures = spar(model, SparGeometry.validation(20))
    say(MPI.COMM_SELF, figures | {"peak_MB": peak_MB(MPI.COMM_SELF)})


def spar(model, geometry):
    """Return the figures of a spar at 20 kPa."""
    from morphing_wing import Spar
    from morphing_wing.stopwatch import Stopwatch

    clock = time.perf_counter()
    scene = Spar(geometry, fidelity="cell" if model == "one cell" else "standard",
                 half=model != "whole width")
    watch = Stopwatch(scene)
    # A pressure too small to be felt, but not zero: its integrals are assembled.
    path = scene.inflate(upper=0.02, lower=1e-12 if model == "both rows in use" else None)
    return figures_of(path, "span_angle_deg", clock, watch)


def rib(model):
    """Return the figures of a rib under ten moments."""
    import numpy as np

    from morphing_wing import Rib
    from morphing_wing.geometry import RibGeometry
    from morphing_wing.stopwatch import Stopwatch

    geometry, torques = RibGeometry.validation(), np.linspace(0.0, 20.0, 11)[1:]
    fidelity = "instant" if model == "formula" else "draft"
    Rib(geometry, fidelity=fidelity).bend(torque=1e-3)  # compiles
    clock = time.perf_counter()
    scene = Rib(geometry, fidelity=fidelity)
    watch = Stopwatch(scene)
    if model != "one factor, scaled":
        return figures_of(scene.bend(torque=torques), "chord_angle_deg", clock, watch)
    small = 1e-3  # N mm, turns the tail by a thousandth of a degree
    found = figures_of(scene.bend(torque=small), "chord_angle_deg", clock, watch)
    return found | {"angle_deg": found["angle_deg"] * torques[-1] / small}


def figures_of(path, angle, clock, watch):
    """Return what a path cost."""
    seconds = time.perf_counter() - clock
    assert path.converged, path.reason
    return {"dofs": path.scene.dofs, "iterations": sum(s.newton_iterations for s in path),
            "assembly": watch.seconds["assembly"], "factor": watch.seconds["factor"],
            "seconds": seconds, "angle_deg": path[-1].measures[angle]}


if __name__ == "__main__":
    main()
