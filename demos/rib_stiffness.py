"""
Tunable stiffness: how stiff is a pantographic rib, and which way?
==================================================================

The paper's title promises tunable stiffness, and its text a rib that is "flexible chordwise but
stiffer spanwise". Here the frame of beams answers: how large is the ratio, which dimension tunes
it, and what does the third layer do for it?

    mpirun -n 2 python demos/rib_stiffness.py            # or without mpirun; half a minute

**The model.** Clamped at its root, the rib is loaded at its tail by three unit forces and three
unit moments, one after another: one factorisation of the tangent at rest, six solutions. Of
(u, theta) = C (F, M) all the rest is algebra: EI = M L/theta about z (chordwise bending, what the
cables do) and about y (spanwise bending), GJ, EA, and F/u of a force in any direction.
"""

from dataclasses import replace
from pathlib import Path

import numpy as np
from mpi4py import MPI

from morphing_wing import rib_stiffness_picture
from morphing_wing.geometry.rib import RibGeometry
from morphing_wing.out_of_plane import out_of_plane
from morphing_wing.out_of_plane_picture import draw
from morphing_wing.renderer import or_warned
from morphing_wing.rib import Rib
from morphing_wing.rib_stiffness import rib_stiffness, stiffness_table
from morphing_wing.root import on_root

output = Path("output") / "rib_stiffness"
comm = MPI.COMM_WORLD


def say(words):
    """Print on one rank only."""
    if comm.rank == 0:
        print(words, "\n", flush=True)


def table(ribs):
    """Say the stiffnesses of ribs."""
    say(stiffness_table(ribs).to_string(float_format="{:.4g}".format))


# Is it stiffer spanwise?
# -----------------------
# Both sets of the paper, the bars' section read both ways, with three layers and with two. Beside
# the ratio EI_y/EI_z stands that of a full bar as deep and as high.

validation = RibGeometry.validation("square")
prototype = RibGeometry.prototype(section="square", bosses=True)
sets = {"3.3 square": validation, "3.3 flush": RibGeometry.validation("flush"),
        "5.1 square, bosses": prototype, "5.1 flush": RibGeometry.prototype()}
table(sets)
table({f"{name}, two layers": replace(rib, layers=2) for name, rib in sets.items()})

# Yes, but not by much: the bars of a layer are joined to each other by pivots only, so that
# whichever way the rib bends, pivots bend and twist. A full bar of the same outline is far more
# direction-minded. (A solid is stiffer out of the plane than this frame, and the ratio a fifth to
# two fifths larger: bench/rib_stiffness.py.) And without the third layer the rib is *softer*
# spanwise than chordwise.

# What tunes it
# -------------
# One dimension at a time, around both sets.

changes = {
    "crossing_angle": [50.0, 70.0, 90.0, 110.0, 130.0], "shaft_thickness": [0.6, 0.8, 1.0, 1.5],
    "pivot_diameter": [0.75, 1.0, 1.25, 1.5], "shaft_length": [4.0, 5.0, 6.5, 8.0],
    "pivot_length": [2.0, 4.0, 6.0, 10.0],
}
for name, base in (("3.3 square", validation), ("5.1 square, bosses", prototype)):
    table({name: base} | {f"{field} = {value:g}": replace(base, **{field: value})
                          for field, values in changes.items() for value in values})

# Flat rhombi and long pivots make the rib choosy, thin pivots make it soft all round: they are
# twisted by chordwise bending and bent by everything else.

# What leaves the plane
# ---------------------
# With three layers nothing in the plane (F_x, F_y, M_z) moves the tail out of it: the rib is its
# own mirror image. With two it is its own image after half a turn about x, y or z only, which
# leaves a screw: a pull along the chord twists it. Now at large rotations, under a moment and
# under a cable, which beyond 45 degrees pulls along the rib.

bent, pulled = {}, {}
for label, layers in (("three layers", 3), ("two layers", 2)):
    rib = Rib(replace(prototype, layers=layers))
    per_Nmm = rib_stiffness(rib.geometry).degrees_per_Nmm
    bent[label] = rib.bend(torque=np.arange(0.0, 61.0, 7.5) / per_Nmm)
    pulled[label] = Rib(rib.geometry).pull(cable=[0.0, 0.02, 0.05, 0.1, 0.15, 0.2, 0.3, 0.4, 0.5])
    for path in (bent[label], pulled[label]):
        found = out_of_plane(path).round(4) + 0.0  # no -0
        say(f"{label}\n{found.to_string(index=False)}")

# So the distortion under a moment is small (`moment_tilt_deg` says that "a moment about z" still
# means one), and under a cable some degrees. The third layer's main gift is stiffness.

ribs = {name: rib_stiffness(rib) for name, rib in {
    "Section 3.3, square": validation, "the same, two layers": replace(validation, layers=2),
    "$\\alpha$ = 50\N{DEGREE SIGN}": replace(validation, crossing_angle=50.0),
    "$\\alpha$ = 130\N{DEGREE SIGN}": replace(validation, crossing_angle=130.0),
    r"$l_{cs}$ = 10 mm": replace(validation, pivot_length=10.0)}.items()}
first, second = list(ribs.values())[:2]
on_root(comm, lambda: rib_stiffness_picture.draw(
    ribs, {"three layers": first, "two layers": second}, output / "stiffness.png"))
with or_warned(comm):  # the shapes want a renderer
    draw(pulled, bent, output / "out_of_plane.png")
say(f"pictures are in {output}/")
