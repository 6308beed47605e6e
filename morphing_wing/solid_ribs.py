"""One or several ribs as solids, with the same ends as a frame of them has."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
from mpi4py import MPI

from . import compat
from .blocks import Block
from .forms.gravity import gravity_potential
from .geometry.rib import RibGeometry
from .geometry.rib_solid import rib_solid
from .geometry.tetmesh import joined
from .materials import Elastic
from .resin_body import ResinBody
from .rigid_ends import RigidEnds
from .root import on_root
from .system import EquilibriumSystem

_OUT_OF_PLANE = (2, 3, 4)  # of an end's six motions, those that a half rib does not have


class SolidRibs:
    """What `morphing_wing.frame.BeamFrame` is, of second-order tetrahedra.

    Parameters
    ----------
    comm
        Communicator.
    rib, material
        Dimensions, the same of each; resin.
    around
        Elements around a cylinder, see `morphing_wing.geometry.rib_solid`.
    roots : (n_ribs, 3) array
        Where each one's root is, mm.
    half
        Whether only what lies at z > 0, by symmetry.
    clamped
        Whether root sections do not move; else they are on rigid plates, as tail sections are.

    Attributes
    ----------
    body, ends
        The bodies as one, and the plates.
    motion, motion_mesh
        The plates' translations in mm and rotation vectors in UFL, and their mesh.
    """

    def __init__(
        self, comm: MPI.Comm, rib: RibGeometry, material: Elastic, around: int,
        roots: Sequence[Sequence[float]] = ((0.0, 0.0, 0.0),), half: bool = False,
        clamped: bool = False,
    ) -> None:
        self.comm, self.material = comm, material
        roots = np.asarray(roots, dtype=float)
        tails = roots + np.array([rib.length, 0.0, 0.0])
        grid = joined(comm.bcast(on_root(comm, lambda: rib_solid(rib, around, half))), roots)
        each = range(len(roots))
        plates = {f"tail_{i}": tails[i] for i in each}
        if not clamped:
            plates |= {f"root_{i}": roots[i] for i in each}
        held = [(f"root_{i}", axis) for i in each for axis in range(3)] if clamped else []
        held += [(f"symmetry_{i}", 2) for i in each] if half else []
        self.body = ResinBody(comm, grid, material, held)
        self.ends = RigidEnds(self.body, plates, held=_OUT_OF_PLANE if half else ())
        self.function = self.body.function
        self.motion, self.motion_mesh = self.ends.motion, self.ends.mesh

    @property
    def unknowns(self) -> list[Block]:
        """The independent blocks of a system."""
        return [self.body.block, self.ends.own_block]

    @property
    def parts(self) -> tuple[Any, ...]:
        """What stores energy."""
        return self.body, self.ends

    def join(self, system: EquilibriumSystem) -> None:
        """Tell the system whose unknowns the bodies' cells see. Collective."""
        self.ends.number(system)

    def at_ends(self, kind: str, integrand: Any) -> Any:
        """Return the sum of an integrand over the ribs' roots or tails as a UFL functional."""
        return self.ends.at(kind, integrand)

    def end_numbers(self, kind: str, rib: int) -> np.ndarray:
        """Return a system's numbers of a rib's root or tail on every rank, shape (6,)."""
        return self.ends.numbers(f"{kind}_{rib}")

    def end_values(self, kind: str, rib: int) -> np.ndarray:
        """Return u (mm) and theta of a rib's root or tail on every rank, shape (6,)."""
        return self.ends.values(f"{kind}_{rib}")

    def rise(self, weight: float) -> Any:
        """Return the integral of a weight in N/mm^3 times the way up, a UFL functional."""
        density = compat.constant(self.body.mesh, weight)
        return gravity_potential(density, self.function) * self.body.measure
