"""
The whole wing: pressure bends it along the span, cables along the chord
========================================================================

A pneumatic spar of silicone takes the front half of a NACA 0012 section. Two rows of eighteen
chambers lie in it, one above the other; air in the upper row stretches the upper side and bends the
wing down. Three pantographic ribs of resin stand on the spar's rear wall, inside a hollow trailing
edge of 1 mm silicone skin, and a cable pulls the tail of each one down. The wing is clamped at its
root section.

    mpirun -n 2 python demos/full_wing.py                  # draft: minutes
    mpirun -n 2 python demos/full_wing.py --fidelity standard --points 8

**The equations.** All of it is one functional,

    Pi = elastomer + ribs + glue + contact - P V + T L,

with Yeoh's strain energy on swept hexahedra, geometrically exact beams for the ribs, an elastic
glue between ribs and elastomer, pressure times the chambers' volume, and tension times the cables'
length. Its derivative is the residual, its second derivative the tangent; one PETSc matrix holds
all unknowns, and MUMPS factorises it as L D L^T, whose negative pivots tell whether a state is
stable. The thin skin buckles on the way: see `morphing_wing/inertia.py` for what carries Newton's
method past that.
"""

import argparse
from pathlib import Path

import numpy as np
from mpi4py import MPI

from morphing_wing import Progress
from morphing_wing.fields import save_path
from morphing_wing.figure7 import figure7
from morphing_wing.figure7_report import report
from morphing_wing.terminal_tables import console

arguments = argparse.ArgumentParser(description="the whole wing, by pressure and by cables")
arguments.add_argument("--fidelity", default="draft", choices=["draft", "standard"])
arguments.add_argument("--points", type=int, default=4, help="points on each curve")
arguments.add_argument("--out", type=Path, default=Path("output") / "full_wing")
options = arguments.parse_args()
root = MPI.COMM_WORLD.rank == 0


def say(text):
    """Print on one rank only."""
    if root:
        print(text, flush=True)


def begin(what, wing):
    """Say what is solved, and return what tells of its steps."""
    say(f"\n{what}: {wing.dofs:,} unknowns")
    return Progress(wing.comm)


# Pressure alone, cables alone
# ----------------------------
# This is the paper's Figure 7: panel B-1 has the angle phi_1 along the span against pressure, B-2
# the angle phi_2 along the chord against the cables. Each scene builds only what it requires: no
# cable, no cable energy; no pressure in the lower row, no integral over its chambers.
#
# Each curve is run with the skin and without. The skin costs a tenth of the angle along the span,
# and most of the angle along the chord: glued at the spar and at the tail, its two sides act as a
# closed box whose root edge is clamped. Where the skin meets itself or a rib, contact forces keep
# them apart: `touching`, `contact_force_N` and `penetration_mm` in the tables tell of it.

pressures = np.linspace(0.0, 0.040, options.points + 1)  # MPa
# N in each cable; closer where the skin buckles and the curve bends.
tensions = 0.5 * np.linspace(0.0, 1.0, options.points + 1) ** 1.5


def deformed(study, curve, path):
    """Draw the last state of a curve and write its steps for ParaView, while the wing is there."""
    folder = options.out / curve.slug
    if curve.skin:
        path.render(options.out / f"wing_{curve.panel}.png")
    save_path(path, folder / "fields")


study = figure7([options.fidelity], pressures, tensions, begin=begin, done=deformed)

# What came out
# -------------
# The paper's text says that the test reached 12 degrees along the span and 35 along the chord. By
# which angle a protractor was read it does not say: the rotation of the end face and the line from
# root to tip differ by a factor of two along the span. The table has both.

study.save(options.out)
if root:
    for table in report(study.facts()):
        console().print("", table)
say(f"\nFigure 7 is {options.out}/fig7.png, the deformed wing wing_pressure.png and "
    "wing_cables.png; tables and files for ParaView stand beside them")
