"""
The pneumatic spar: one step, many steps, and how fine is fine enough
=====================================================================

Two rows of twenty chambers lie one above the other in a bar of silicone. Air in the upper row
stretches the upper side, and the bar bends down: the set of the paper's Section 3.3.

    mpirun -n 2 python demos/spar.py           # or without mpirun

**The model.** Yeoh's strain energy with the paper's constants,

    W = C10 (I1bar - 3) + C20 (I1bar - 3)^2 + p (J - 1) - p^2 / (2 kappa),

minus the pressure times the volume that the chambers' deformed faces enclose. The mean stress p is
an unknown of its own, so nearly incompressible silicone does not lock, and Newton's method takes
the whole load in one step. By symmetry one half of the spar is enough.
"""

from pathlib import Path

import numpy as np
from mpi4py import MPI

from morphing_wing import DRAGON_SKIN_30, Progress, Spar, plot_paths
from morphing_wing.geometry import SparGeometry

output = Path("output") / "spar"
root = MPI.COMM_WORLD.rank == 0


def say(text):
    """Print on one rank only."""
    if root:
        print(text, flush=True)


# One step to 20 kPa
# ------------------
# A short spar first: four cells instead of twenty.

short = Spar(SparGeometry.validation(n_cells=4), DRAGON_SKIN_30, fidelity="standard")
state = short.inflate(upper=0.020)[-1]
say(f"4 cells, 20 kPa: phi_1 = {state.measures['span_angle_deg']:.3f} degrees "
    f"in {state.newton_iterations} Newton iterations, from nothing, in one step")

# Up and down
# -----------
# The lower row bends the spar up by the same angle: it is symmetric, and the model keeps that.

up = short.inflate(upper=0.0, lower=0.020)[-1]
say(f"the other row: phi_1 = {up.measures['span_angle_deg']:.3f} degrees")

# Twenty cells at two fidelities
# ------------------------------
# "draft" has linear hexahedra with constant p, "standard" quadratic ones with linear p, on the same
# mesh, graded towards the chambers' corners. The draft costs a fraction and is a few per cent too
# stiff.

paths = {}
for fidelity in ("draft", "standard"):
    spar = Spar(SparGeometry.validation(), DRAGON_SKIN_30, fidelity=fidelity)
    say(f"\n{fidelity}: {spar.dofs:,} unknowns")
    progress = Progress(MPI.COMM_WORLD)
    path = spar.inflate(upper=np.linspace(0.0, 0.040, 9), on_step=progress, on_cut=progress.cut)
    progress.end(path.converged, path.reason)
    path.save(output / fidelity)
    paths[fidelity] = path

# The curve bends upwards: stretched walls get thinner, and C20 < 0 softens them further. Ballooning
# lies at the end of that road.

if root:
    plot_paths(paths, output / "angle.png")
paths["standard"].render(output / "spar.png")
say(f"\nTables, curves, pictures and files for ParaView are in {output}/")
