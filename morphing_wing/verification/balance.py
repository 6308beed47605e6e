"""Balances: work against energy, reactions against loads, and rigid motions that change nothing."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
from mpi4py import MPI
from scipy.spatial.transform import Rotation

from morphing_wing import compat
from morphing_wing.blocks import Block
from morphing_wing.elastomer import Elastomer
from morphing_wing.geometry.rib import RibGeometry
from morphing_wing.geometry.spar import SparGeometry, SparMeshing
from morphing_wing.materials import RESIN
from morphing_wing.rib import Rib
from morphing_wing.spar import Spar
from morphing_wing.system import EquilibriumSystem

from .check import Check
from .equilibrium import TETRAHEDRA, Equilibrium
from .meshes import tetrahedra
from .thick_walls import thick_sphere

__all__ = ["balance", "rotation"]

TURN = Rotation.from_rotvec([0.9, -1.4, 0.6])
ANGLE = TURN.magnitude()


def balance(comm: MPI.Comm) -> Iterator[Check]:
    """Yield the work along paths against the stored energy, and a reaction against its load."""
    for element in ("Q1/P0", "Q2/P1disc"):
        spar = Spar(SparGeometry.validation(2), element=element, meshing=SparMeshing.plain(),
                    comm=comm)
        last = spar.inflate(upper=[0.02, 0.04])[-1]
        yield Check(f"spar, {element}, 40 kPa in two steps: external work",
                    last.external_work_Nmm, last.energy_Nmm, "N mm", 5e-3)
    bent = Rib(RibGeometry.prototype(), comm=comm).pull(cable=[0.05, 0.1, 0.15, 0.2])[-1]
    yield Check("rib, cable of 0.2 N in four steps: external work", bent.external_work_Nmm,
                bent.energy_Nmm, "N mm", 5e-3)
    sphere = thick_sphere("Q2/P1disc", comm)
    pressure = sphere.load_at(1.25**3 * sphere.displacement())
    # The reaction in the plane z = 0: what a rise of this plane alone costs.
    reaction = sphere.force_along(
        lambda x: np.stack([0 * x[0], 0 * x[0], 1.0 * (np.abs(x[2]) < 1e-9)]),
        pressed=("inner", pressure))
    # The face's area vector looks out of the wall, into the sphere.
    resultant = -pressure * sphere.body.mean_normal("inner")[2]
    yield Check("thick sphere, reaction in a plane against the pressure's resultant",
                -reaction, resultant, "N", 1e-8)


def rotation(comm: MPI.Comm) -> Iterator[Check]:
    """Yield what turning adds to the forces of a whole spar, and of resin without load.

    Of the spar with the pressure in its chambers.
    """
    for element in ("Q1/P0", "Q2/P1disc"):
        for pressure in (0.0, 0.04):
            body = _inflated(element, pressure, comm)
            free = EquilibriumSystem(comm, [Block(body.function)])
            work = compat.constant(body.mesh, pressure) * body.chamber_volume("upper_chambers")
            free.set_energies([body.energy, -work])
            forces, energy = _forces(free), sum(free.energies())
            _turn(body)
            where = f"{element}, {1000 * pressure:g} kPa, turned by {np.degrees(ANGLE):.0f} deg"
            # Beside the supports' forces all others are zero: those of the stress, or of none.
            yield Check(f"{where}: norm of nodal forces", _forces(free), forces, "N", 1e-9)
            yield Check(f"{where}: energy", sum(free.energies()), energy, "N mm", 1e-9)
    resin = Equilibrium(comm, tetrahedra(), RESIN, TETRAHEDRA)
    resin.displacement_function().interpolate(lambda x: TURN.apply(x.T).T - x)
    where = f"{TETRAHEDRA}, turned by {np.degrees(ANGLE):.0f} deg"
    yield Check(f"{where}: norm of nodal forces", _forces(resin.system), 0.0, "N", 1e-10)
    yield Check(f"{where}: energy over E and volume", resin.system.energies()[0] / RESIN.E, 0.0,
                "", 1e-20)


def _inflated(element: str, pressure: float, comm: MPI.Comm) -> Elastomer:
    scene = Spar(SparGeometry.validation(2), element=element, meshing=SparMeshing.plain(),
                 half=False, comm=comm)
    scene.inflate(upper=pressure)
    return scene.body


def _forces(system: EquilibriumSystem) -> float:
    """Return the norm in N of the residual; rounding of none."""
    x, out = system.x.duplicate(), system.x.duplicate()
    system.push(x)
    system.residual(x, out)
    norm = out.norm()
    for vector in (x, out):
        vector.destroy()
    return norm if norm > 1e-10 else 0.0


def _turn(body: Elastomer) -> None:
    space, dofs = body.displacement_space()
    x = space.tabulate_dof_coordinates()
    values = body.function.x.array[dofs].reshape(-1, 3)
    body.function.x.array[dofs] = (TURN.apply(x + values) - x).ravel()
