"""
Past the limit point: a spar filled with a volume
=================================================

Under pressure a spar of silicone chambers gives way at some 80 kPa: from there on its chambers grow
while the pressure falls, as a toy balloon's does, and a given pressure holds no state nearby. Given
the volume instead, as a syringe does, each state is one of a smooth path past that point.

    python demos/ballooning.py

**The equations.** The pressures become unknowns, the multipliers of the volumes that are given,

    Pi = E(u) - sum_k p_k (V_k(u) - V_k0 - dV_k),

one more row of the same matrix each. Each brings one more negative pivot, which is taken off the
count: what is left says whether a state is stable while the volume is held.
"""

from pathlib import Path

import numpy as np

from morphing_wing import Progress, Spar
from morphing_wing.geometry import SparGeometry
from morphing_wing.limits import Limits
from morphing_wing.passed import passed

OUT = Path("output") / "ballooning"
geometry = SparGeometry.validation(n_cells=4)
at_rest = (geometry.n_cells * geometry.cavity_length * geometry.cavity_height
           * geometry.cavity_width)  # mm^3 in the upper row


def filled(how, most):
    """Fill the upper row up to `most` times its volume at rest; return all states on the way."""
    spar = Spar(geometry, fidelity="draft", filled=how)
    spar.watch.append(Limits(spar))  # largest stretch, and whether the material's law still holds
    progress = Progress(spar.comm)
    path = spar.fill(upper=at_rest * np.linspace(0.0, most, 13)[1:], on_step=progress,
                     on_cut=progress.cut)
    progress.end(path.converged, path.reason)
    path.save(OUT / how)
    return path


def told(path, words):
    """Print what a path shows, on one rank."""
    if path.scene.comm.rank == 0:
        table = path.table()
        peak = table["pressure_MPa"].idxmax()
        print(f"{words}: {1000 * table['pressure_MPa'][peak]:.1f} kPa at most, with "
              f"{table['upper_mm3'][peak] / 1000:.1f} ml filled in", *passed(path), "", sep="\n")


# One supply
# ----------
# All chambers of the row hang on one supply: they share a pressure, and the sum of their volumes is
# given. Past the limit point one of them takes ever more of it (`upper_largest_chamber`,
# `upper_largest_share` in the table). That is no failure of the solver; where the path ends, it is
# the material that gives way: with C20 < 0 its force falls beyond a stretch of 5.46.

told(filled("shared", 6.0), "one supply")

# Chamber by chamber
# ------------------
# Filled apart, as if each had a syringe of its own, each chamber takes its part, at a pressure of
# its own: those at the ends have no neighbour on one side. No chamber can run away with the
# others' air, so that the spar bends much further before its silicone would tear.

apart = filled("separate", 7.0)
told(apart, "chamber by chamber")

# What to look at
# ---------------
# `angles.png` has the angle, the pressure (dashed where it falls: unstable under a given pressure)
# and the energies against the volume; `shape.png` the last state, with the chamber that balloons.

if apart.scene.comm.rank == 0:
    print(f"pictures, tables and files for ParaView are in {OUT}")
