"""
A pantographic rib, bent by a moment and by a cable
===================================================

The ribs of the wing are pantographs: three layers of inclined bars, joined by cylinders that run
across the wing's span. When such a rib bends, every cylinder is twisted a little and every bar
bent a little, and many small elastic deformations add up to a large rotation of the trailing
edge. Across the span the rib stays stiff.

    mpirun -n 2 python demos/rib.py            # or without mpirun

**The model.** Each bar and each cylinder is a geometrically exact beam after Simo and Reissner,
with the unknowns u (displacement) and theta (rotation vector, R = exp theta^) and the energy

    W = integral of 1/2 (Gamma . C_N Gamma + K . C_M K) ds

in the strains Gamma = Lambda^T r' - e_1 and curvatures K. Energy alone is written down
(`forms/beam.py`); residual and tangent are its derivatives.
"""

from pathlib import Path

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np
from mpi4py import MPI

from morphing_wing.geometry import rib as shapes
from morphing_wing.materials import RESIN
from morphing_wing.rib import Rib

output = Path("output") / "rib"
root = MPI.COMM_WORLD.rank == 0


def say(*words):
    """Print on one rank only."""
    if root:
        print(*words, flush=True)


# How the bars look
# -----------------
# The paper's figures leave the bars' section open. Two readings fit its words: "flush" bars are
# as wide as the cylinders, "square" ones are narrower, so that cylinders wider than the bars may
# run through them as bosses. The moment-angle line of Section 3.3 tells how much it matters.

readings = {
    "flush": shapes.RibGeometry.validation("flush"),
    "square": shapes.RibGeometry.validation("square"),
    "square, bosses": shapes.RibGeometry.validation("square", bosses=True),
}
torques = np.linspace(0.0, 40.0, 9)  # N mm
bent = {}
for name, geometry in readings.items():
    path = Rib(geometry, RESIN).bend(torque=torques)
    bent[name] = [state for state in path if state.requested]
    last = bent[name][-1]
    per_Nmm = last.measures["chord_angle_deg"] / last.load["torque_Nmm"]
    iterations = sum(state.newton_iterations for state in path)
    say(f"{name:15s} {per_Nmm:6.3f} degrees per N mm, {iterations} Newton iterations")

# The lines are straight although rotations are large: the bars' rotations against each other stay
# small. That is what the paper found too (its Figure 5B-2).

# A cable instead of a moment
# ---------------------------
# On the wing a fishing line pulls the tail. With constant tension T and a guide point g its
# potential is T |x - g|, so it pulls towards g wherever the tail goes. The prototype's rib has a
# 55.7 mm chord in 17 cells (a number that the paper does not give); the line leads straight down.

cable = Rib(shapes.RibGeometry.prototype(section="square", bosses=True), RESIN)
pulled = cable.pull(cable=[0.025, 0.05, 0.1, 0.15, 0.2, 0.3, 0.4, 0.5])
table = pulled.table()
say(table[["cable_N", "chord_angle_deg", "chord_line_deg", "newton_iterations"]].to_string())

# The tail's rotation and the line from root to tail are two angles; a protractor may read either.
# The curve bends over: the more the rib turns towards the guide, the shorter the cable's lever.

if root:
    output.mkdir(parents=True, exist_ok=True)
    figure, (left, right) = plt.subplots(1, 2, figsize=(10, 4), layout="constrained")
    for name, states in bent.items():
        left.plot(torques, [s.measures["chord_angle_deg"] for s in states], "o-", label=name)
    left.set(xlabel="end moment, N mm", ylabel="rotation of the tail, degrees",
             title="Section 3.3, six cells")
    requested = table[table["requested"]]
    for column, label in (("chord_angle_deg", "tail"), ("chord_line_deg", "deflection line")):
        right.plot(requested["cable_N"], requested[column], "o-", label=label)
    right.set(xlabel="cable tension, N", title="Section 5.1, 17 cells")
    for axes in (left, right):
        axes.grid(alpha=0.3)
        axes.legend()
    figure.savefig(output / "angles.png", dpi=150)

# And the bent rib, with the state before in grey:

pulled[-1].render(output / "rib.png")
say(f"curves and picture are in {output}/")
