"""What the middle rib's rotation owes to its foot: size, glue and mesh.

The prototype without skin, cables at 0.1 N. A rib stands on soft rubber, into which its foot sinks
and turns: the answer depends on the foot plate's size and on the glue, which are parameters of the
wing, and must not depend on the mesh below, which is none. Linear hexahedra, one load step; also
under ``mpirun``. Thirteen full wings, 5 to 15 seconds each on one core.

    python bench/foot.py
    mpirun -n 2 python bench/foot.py --cells 12
"""

import argparse
import time
from dataclasses import replace

from mpi4py import MPI
from rich.console import Console
from rich.table import Table

from morphing_wing import Wing
from morphing_wing.geometry import WingGeometry
from morphing_wing.geometry.hexmesh import two_sided, uniform
from morphing_wing.geometry.wing_mesh import WingMeshing

TENSION = 0.1


def cases(wing):
    """Yield what is changed, the wing and its mesh; first nothing."""
    draft, (height, width) = WingMeshing.fine(), wing.foot()
    yield "draft as it is", wing, draft
    for factor in (0.5, 2.0):
        yield (f"foot_height = {factor * height:.2f} mm",
               replace(wing, foot_height=factor * height), draft)
    for factor in (0.5, 1.5):
        yield (f"foot_width = {factor * width:.2f} mm",
               replace(wing, foot_width=factor * width), draft)
    for stiffness in (5.0, 500.0, 5000.0):
        yield (f"glue_stiffness = {stiffness:g} N/mm^3",
               replace(wing, glue_stiffness=stiffness), draft)
    for name, heights in (("2", uniform(2)), ("6, graded", two_sided(6, 1.5)), ("8", uniform(8))):
        yield f"cavity_height = {name} intervals", wing, replace(draft, cavity_height=heights)
    yield "middle_thickness = 2 intervals", wing, replace(draft, middle_thickness=uniform(2))
    yield "wall_length = 2 intervals", wing, replace(draft, wall_length=uniform(2))


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--cells", type=int, default=18, metavar="N",
                        help="chambers in a row (default: 18, the prototype's)")
    arguments = parser.parse_args()
    prototype = WingGeometry.prototype(n_cells=arguments.cells, skin_thickness=None)
    height, width = prototype.foot()
    table = Table(title=f"Middle rib at {TENSION:g} N, foot {height:.2f} mm x {width:.2f} mm, "
                        f"glue {prototype.glue_stiffness:g} N/mm^3, {MPI.COMM_WORLD.size} rank(s)")
    for column in ("changed", "dofs", "iterations", "s", "rotation, deg", "line, deg", "change, %"):
        table.add_column(column, justify="left" if column == "changed" else "right")
    first = None
    for name, geometry, meshing in cases(prototype):
        clock = time.perf_counter()
        wing = Wing(geometry, fidelity="draft", meshing=meshing)
        path = wing.actuate(cable=TENSION)
        seconds = time.perf_counter() - clock
        if not path.converged:
            table.add_row(name, f"{wing.dofs:,}", "", f"{seconds:.0f}", path.reason, "", "")
            continue
        middle = (len(geometry.rib_positions) + 1) // 2
        rotation, line = (path[-1].measures[f"rib_{middle}_{kind}_deg"]
                          for kind in ("rotation", "line"))
        first = first or rotation
        table.add_row(name, f"{wing.dofs:,}", str(sum(s.newton_iterations for s in path)),
                      f"{seconds:.0f}", f"{rotation:.2f}", f"{line:.2f}",
                      f"{100 * (rotation / first - 1):+.1f}")
    if MPI.COMM_WORLD.rank == 0:
        Console(width=110).print(table)


if __name__ == "__main__":
    main()
