"""How many evaluations a second the paper's formulas give over arrays, and their derivatives.

Every evaluation has parameters of its own: seven lengths, the material and the load all vary, as
in a random search. One core; the best of three runs.
"""

import argparse
import time

import numpy as np
from rich.console import Console
from rich.table import Table

from morphing_wing.analytic_rib import RibFormula
from morphing_wing.analytic_spar import SparFormula
from morphing_wing.geometry.rib import RibGeometry
from morphing_wing.geometry.spar import SparGeometry
from morphing_wing.materials import DRAGON_SKIN_30, RESIN

SPAR, RIB = SparGeometry.validation(), RibGeometry.validation("square")
SPAR_NAMES = ("cavity_length", "wall_length", "top_thickness", "cavity_height",
              "middle_thickness", "side_thickness", "cavity_width")
RIB_NAMES = ("shaft_length", "shaft_thickness", "pivot_diameter", "pivot_length",
             "crossing_angle")


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--evaluations", type=int, default=1_000_000, help="(1000000)")
    n = parser.parse_args().evaluations
    random = np.random.default_rng(0)

    def around(base, names):
        return {name: getattr(base, name) * random.uniform(0.8, 1.2, n) for name in names}

    spars = SparFormula(SPAR, DRAGON_SKIN_30, C10=0.117 * random.uniform(0.8, 1.2, n),
                        **around(SPAR, SPAR_NAMES))
    ribs = RibFormula(RIB, RESIN, **around(RIB, RIB_NAMES))
    pressures, torques = random.uniform(0.0, 0.04, n), random.uniform(0.0, 20.0, n)
    turns = spars.turn(pressures)
    exact = np.nanmax(np.abs(spars.pressure(turns) / pressures - 1.0))
    table = Table(title=f"{n:,} evaluations, every one with parameters of its own, one core")
    for column in ("formula", "asked for", "seconds", "millions a second"):
        table.add_column(column, justify="left" if column in ("formula", "asked for") else "right")
    for formula, asked, run in (
        ("spar, Eqs 6-12", "pressure of each turn", lambda: spars.pressure(turns)),
        ("", "angle under each pressure (Newton)", lambda: spars.angle(pressures)),
        ("", "that, and eleven exact derivatives", lambda: spars.derivatives(pressures)),
        ("rib, Eqs 13-18", "angle under each moment", lambda: ribs.angle(torques)),
        ("", "that, and nine exact derivatives", lambda: ribs.derivatives(torques)),
    ):
        seconds = min(timed(run) for _ in range(3))
        table.add_row(formula, asked, f"{seconds:.2f}", f"{n / seconds / 1e6:.2f}")
    console = Console(width=100)
    console.print(table)
    console.print(f"The pressure of the angle found is the one asked for within {exact:.1e}.",
                  highlight=False)


def timed(run):
    """Return the seconds that a call takes."""
    begin = time.perf_counter()
    run()
    return time.perf_counter() - begin


if __name__ == "__main__":
    main()
