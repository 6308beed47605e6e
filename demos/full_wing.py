"""
The whole wing: pressure bends it along the span, cables along the chord
========================================================================

A pneumatic spar of silicone takes the front half of a NACA 0012 section. Two rows of eighteen
chambers lie in it, one above the other; air in the upper row stretches the upper side and bends the
wing down. Three pantographic ribs of resin stand on the spar's rear wall, inside a hollow trailing
edge of 1 mm silicone skin, and a cable pulls the tail of each one down. The wing is clamped at its
root section.

    mpirun -n 2 python demos/full_wing.py                  # draft: minutes
    mpirun -n 2 python demos/full_wing.py --fidelity standard

**The equations.** All of it is one functional,

    Pi = elastomer + ribs + glue - P V + T L,

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

from morphing_wing import Progress, Wing, plot_paths
from morphing_wing.geometry import WingGeometry

arguments = argparse.ArgumentParser(description="the whole wing, by pressure and by cables")
arguments.add_argument("--fidelity", default="draft", choices=["draft", "standard"])
arguments.add_argument("--points", type=int, default=8, help="points on each curve")
arguments.add_argument("--out", type=Path, default=Path("output") / "full_wing")
options = arguments.parse_args()
root = MPI.COMM_WORLD.rank == 0


def say(text):
    """Print on one rank only."""
    if root:
        print(text, flush=True)


def actuated(name, geometry, **loads):
    """Build a wing, load it, save everything; return its path."""
    wing = Wing(geometry, fidelity=options.fidelity)
    say(f"\n{name}: {wing.dofs:,} unknowns")
    progress = Progress(MPI.COMM_WORLD)
    path = wing.actuate(**loads, on_step=progress, on_cut=progress.cut)
    progress.end(path.converged, path.reason)
    path.save(options.out / name.replace(", ", "_").replace(" ", "_"))
    return path


# Pressure alone, cables alone
# ----------------------------
# Each scene builds only what it requires: no cable, no cable energy; no pressure in the lower row,
# no integral over its chambers.

with_skin = WingGeometry.prototype()
pressures = np.linspace(0.0, 0.040, options.points + 1)  # MPa
tensions = np.linspace(0.0, 0.5, options.points + 1)  # N in each cable
by_pressure = {"with skin": actuated("pressure", with_skin, upper=pressures)}
by_cable = {"with skin": actuated("cables", with_skin, cable=tensions)}

# Without the skin
# ----------------
# The skin costs a tenth of the angle along the span, and most of the angle along the chord: glued
# at the spar and at the tail, its two sides act as a closed box. Contact is not modelled. Where
# the skin would pass through itself or through a rib, `contact` is true in the tables and curves
# are dashed: from there on they are too soft or simply fiction.

no_skin = WingGeometry.prototype(skin_thickness=None)
by_pressure["no skin"] = actuated("pressure, no skin", no_skin, upper=pressures)
by_cable["no skin"] = actuated("cables, no skin", no_skin, cable=tensions)

# Both together
# -------------

both = actuated("both", with_skin, upper=0.025, cable=0.2)
bare = actuated("both, no skin", no_skin, upper=0.025, cable=0.2)

# What came out
# -------------

columns = ["pressure_MPa", "cable_N", "span_angle_deg", "span_line_deg", "chord_angle_deg",
           "chord_line_deg", "rib_2_rotation_deg", "newton_iterations", "negative_pivots"]
for title, path in (("with skin, 25 kPa and 0.2 N", both), ("no skin, 25 kPa and 0.2 N", bare)):
    say(f"\n{title}\n{path.table()[columns].tail(1).to_string(index=False)}")
if root:
    plot_paths(by_pressure, options.out / "span_angle.png")
    plot_paths(by_cable, options.out / "chord_angle.png", angle="chord_angle_deg")
both.render(options.out / "wing.png")
say("\nTables, curves, pictures and files for ParaView are in "
    f"{options.out}/")
