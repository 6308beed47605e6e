"""The whole rib as a solid, loaded in all six ways: how good frame and condensed cell are.

Six cells, both presets and both sections, E = 2500 MPa, nu = 0.35: curved second-order tetrahedra,
the root section clamped, the tail section on a rigid plate, no symmetry. Half a minute each. Out of
the plane the frame is the softer one: there a solid's cylinders stiffen the bars that they run
through or end at, the frame's do not. The condensed cell is meshed as the solid.
"""

import argparse
import time

from child import in_a_child, say
from rich.console import Console
from rich.table import Table

CASES = [("validation", "square", False), ("validation", "flush", False),
         ("prototype", "square", True), ("prototype", "flush", False)]
FIGURES = ("chordwise_bending", "spanwise_bending", "torsion", "axial", "anisotropy")


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--around", type=int, default=10,
                        help="elements around a cylinder (10)")
    parser.add_argument("--one", type=int, help="run one case here and print its figures as JSON")
    arguments = parser.parse_args()
    if arguments.one is not None:
        measured(*CASES[arguments.one], arguments.around)
        return
    table = Table(title="Solid rib of six cells (per cent: frame, condensed cell)")
    for column in ("rib", "unknowns", "s", "EI_z, N mm2", "EI_y, N mm2", "GJ, N mm2", "EA, N",
                   "EI_y/EI_z"):
        table.add_column(column, justify="right")
    for i, (preset, section, bosses) in enumerate(CASES):
        found = in_a_child(__file__, str(i), "--around", str(arguments.around))
        table.add_row(
            f"{preset}, {section}{', bosses' * bosses}", str(found["dofs"]),
            f"{found['seconds']:.0f}",
            *(f"{solid:.4g} ({100 * (frame / solid - 1):+.0f}, {100 * (cell / solid - 1):+.2f})"
              for solid, frame, cell in (found[name] for name in FIGURES)))
    Console(width=130).print(table)


def measured(preset, section, bosses, around):
    """Run one case and say each figure of the solid, of the frame and of the condensed cell."""
    from dataclasses import replace

    from mpi4py import MPI

    from morphing_wing.geometry import RibGeometry
    from morphing_wing.materials import Elastic
    from morphing_wing.rib_stiffness import (
        CondensedInSpace,
        RibStiffness,
        rib_stiffness,
        tail_compliance,
    )
    from morphing_wing.solid_rib import SolidRib
    from morphing_wing.solid_ribs import SolidRibs

    class WholeRib(SolidRib):
        multiplicity = 1

        def _made(self):
            return SolidRibs(self.comm, self.geometry, self.material, around, clamped=True)

    geometry = replace(getattr(RibGeometry, preset)(section=section, bosses=bosses), n_cells=6)
    resin = Elastic(2500.0, 0.35)
    clock = time.perf_counter()
    rib = WholeRib(geometry, resin, fidelity="standard", comm=MPI.COMM_SELF)
    solid = RibStiffness(geometry, tail_compliance(rib))
    seconds = time.perf_counter() - clock
    cell = CondensedInSpace(geometry, resin, "cell", MPI.COMM_SELF, around=around)
    every = (solid, rib_stiffness(geometry, resin, MPI.COMM_SELF),
             RibStiffness(geometry, tail_compliance(cell)))
    say(MPI.COMM_SELF, {"dofs": rib.dofs, "seconds": seconds}
        | {name: [float(getattr(each, name)) for each in every] for name in FIGURES})


if __name__ == "__main__":
    main()
