"""The whole rib as a solid, loaded in all six ways: how good the frame's stiffnesses are.

Six cells, both presets and both sections, E = 2500 MPa, nu = 0.35: curved second-order tetrahedra,
the root section clamped, the tail section on a rigid plate, no symmetry. Half a minute to two and
2 GB each. Out of the plane the frame is the softer one: there a solid's cylinders stiffen the bars
that they run through or end at, the frame's do not.
"""

import argparse
import time

import numpy as np
from child import in_a_child, say
from rich.console import Console
from rich.table import Table

CASES = [("validation", "square", False), ("validation", "flush", False),
         ("prototype", "square", True), ("prototype", "flush", False)]
FIGURES = ("chordwise_bending", "spanwise_bending", "torsion", "axial", "anisotropy")


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--size", type=float, default=0.8,
                        help="edges over the smallest dimension (0.8)")
    parser.add_argument("--one", type=int, help="run one case here and print its figures as JSON")
    arguments = parser.parse_args()
    if arguments.one is not None:
        measured(*CASES[arguments.one], arguments.size)
        return
    table = Table(title="Solid rib of six cells; the frame's difference in brackets, per cent")
    for column in ("rib", "unknowns", "s", "EI_z, N mm2", "EI_y, N mm2", "GJ, N mm2", "EA, N",
                   "EI_y/EI_z"):
        table.add_column(column, justify="right")
    for i, (preset, section, bosses) in enumerate(CASES):
        found = in_a_child(__file__, str(i), "--size", str(arguments.size))
        table.add_row(
            f"{preset}, {section}{', bosses' * bosses}", str(found["dofs"]),
            f"{found['seconds']:.0f}",
            *(f"{solid:.4g} ({100 * (frame / solid - 1):+.0f})"
              for solid, frame in (found[name] for name in FIGURES)))
    Console(width=110).print(table)


def measured(preset, section, bosses, size):
    """Run one case and say each figure of the solid and of the frame."""
    from dataclasses import replace

    from mpi4py import MPI

    from morphing_wing.geometry import RibGeometry
    from morphing_wing.geometry.rib_solid import rib_solid
    from morphing_wing.materials import Elastic
    from morphing_wing.resin_body import ResinBody
    from morphing_wing.rib_stiffness import RibStiffness, rib_stiffness
    from morphing_wing.rigid_end import RigidEnd
    from morphing_wing.solid_rib import SolidRib
    from morphing_wing.system import EquilibriumSystem

    class WholeRib(SolidRib):
        multiplicity = 1

        def _build(self):
            smallest = min(self.geometry.shaft_width, self.geometry.shaft_thickness,
                           self.geometry.pivot_diameter)
            grid = rib_solid(self.geometry, size * smallest, half=False)
            self.body = ResinBody(self.comm, grid, self.material, clamped=("root",))
            self.tail = RigidEnd(self.body, "tail", self._tail_place)
            self.system = EquilibriumSystem(self.comm, [self.body.block, *self.tail.blocks])
            self.tail.join(self.system)

    geometry = replace(getattr(RibGeometry, preset)(section=section, bosses=bosses), n_cells=6)
    resin = Elastic(2500.0, 0.35)
    clock = time.perf_counter()
    rib = WholeRib(geometry, resin, fidelity="standard", comm=MPI.COMM_SELF)
    rib.take_into_use([])
    factor, numbers = rib.linearise(), rib.tail.blocks[0].numbers
    compliance = np.zeros((6, 6))
    force, motion = rib.system.x.duplicate(), rib.system.x.duplicate()
    for load, number in enumerate(numbers):
        force.set(0.0)
        force.setValue(int(number), 1.0)
        force.assemble()
        factor.solve(force, motion)
        compliance[:, load] = motion.getArray(readonly=True)[numbers]
    both = RibStiffness(geometry, compliance), rib_stiffness(geometry, resin, MPI.COMM_SELF)
    say(MPI.COMM_SELF, {"dofs": rib.dofs, "seconds": time.perf_counter() - clock}
        | {name: [float(getattr(each, name)) for each in both] for name in FIGURES})


if __name__ == "__main__":
    main()
