"""
Past the limit point: a spar filled with a volume
=================================================

Under pressure a spar of silicone chambers gives way at some 80 kPa: from there on its chambers grow
while the pressure falls, as a toy balloon's does, and a given pressure holds no state nearby. Given
the volume instead, as a syringe does, each state is one of a smooth path past that point: the
pressure is then the unknown, one more of the same Newton problem.

    python demos/ballooning.py

**What to look for.** All chambers of a row hang on one supply here. Past the limit point one of
them begins to grow faster than the others (`upper_largest_chamber`, `upper_largest_share`), on
states that are stable for a given volume: no surplus negative pivots. Filled apart
(`filled="separate"`), each chamber takes its part, at a pressure of its own.
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

for filled, most in (("shared", 6.0), ("separate", 7.0)):
    spar = Spar(geometry, fidelity="draft", filled=filled)
    spar.watch.append(Limits(spar))  # largest stretch, and whether the material's law still holds
    progress = Progress(spar.comm)
    path = spar.fill(upper=at_rest * np.linspace(0.0, most, 13)[1:], on_step=progress,
                     on_cut=progress.cut)
    progress.end(path.converged, path.reason)
    path.save(OUT / filled)
    if spar.comm.rank == 0:
        highest = path.table()["pressure_MPa"].max()
        print(f"{filled}: {1000 * highest:.1f} kPa at most", *passed(path), sep="\n")

if spar.comm.rank == 0:
    print(f"curves, pictures, tables and fields are in {OUT}")
