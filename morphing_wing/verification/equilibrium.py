"""Equilibrium of one body under held faces and one load."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from typing import Any

import numpy as np
import ufl
from dolfinx import fem
from mpi4py import MPI

from morphing_wing import compat
from morphing_wing.elastomer import Elastomer
from morphing_wing.elements import ELEMENTS
from morphing_wing.forms.kinematics import cofactor, deformation_gradient
from morphing_wing.geometry.hexmesh import HexMesh
from morphing_wing.geometry.tetmesh import TetMesh
from morphing_wing.led import LedLoad
from morphing_wing.materials import Elastic, Yeoh
from morphing_wing.newton import Newton, NewtonResult
from morphing_wing.resin_body import ResinBody
from morphing_wing.system import EquilibriumSystem

__all__ = ["TETRAHEDRA", "Equilibrium", "NoEquilibriumError"]

TETRAHEDRA = "P2 tetrahedra"
"""The resin's element; all others are the elastomer's."""


class NoEquilibriumError(RuntimeError):
    """Newton's method did not converge, or to a state that is not stable."""


class Equilibrium:
    """A body, its equations and Newton's method.

    Parameters
    ----------
    comm, grid, material
        Where, the body's mesh, of what.
    element
        Name of the finite element, `TETRAHEDRA` of resin on a mesh of them.
    work
        From the body and a load to the load's work, a UFL functional, linear in the load.
    led
        Name of the face at which the load acts if not it is given but the displacement on which
        it works; None: the load is given.
    body
        Class of the elastomer's body.
    options
        Of the body: ``clamped``, ``symmetry``.
    """

    def __init__(
        self,
        comm: MPI.Comm,
        grid: HexMesh | TetMesh,
        material: Yeoh | Elastic,
        element: str,
        work: Callable[[Any, Any], Any] | None = None,
        led: str | None = None,
        body: type[Elastomer] = Elastomer,
        **options: Any,
    ) -> None:
        if element == TETRAHEDRA:
            self.body: Any = _Resin(comm, grid, material, **options)
        else:
            self.body = body(comm, grid, material, ELEMENTS[element], thin=("body",), **options)
        self.load: Any = compat.constant(self.body.mesh, 0.0)
        self._led = None if led is None else LedLoad(self.body.mesh, self.body.faces.cells(led))
        energies, blocks = [self.body.energy], [self.body.block]
        if work is not None:
            self._displacement = compat.form(work(self.body, 1.0))
            if self._led is None:
                energies.append(-work(self.body, self.load))
            else:
                energies += [-work(self.body, self._led.seen), self._led.potential()]
                blocks += self._led.blocks
        self.system = EquilibriumSystem(comm, blocks)
        if self._led is not None:
            self._led.number(self.system)
        self.system.set_energies(energies, [self.body.tangent_correction])
        iterate = self.body.iterate
        self._newton = Newton(
            self.system, "verification_",
            expected_negative=self.body.n_pressures() + (self._led is not None),
            before_tangent=iterate.before_tangent if iterate else None)

    def solve(self, force: float = 1e-3) -> NewtonResult:
        """Solve to a residual of 1e-9 times a force in N, and take the state as converged.

        Raises
        ------
        NoEquilibriumError
            If Newton does not converge, or the tangent has negative pivots beyond the pressures'.
        """
        result = self._newton.solve(force)
        if not result.converged:
            raise NoEquilibriumError(result.reason)
        if result.negative_pivots != 0:
            raise NoEquilibriumError(f"{result.negative_pivots} surplus negative pivots")
        if self.body.iterate:
            self.body.iterate.accept()
        return result

    def load_at(self, displacement: float, steps: int = 1) -> float:
        """Return the load that brings about a displacement, led there in equal steps."""
        before = self.displacement()
        for part in np.arange(1, steps + 1) / steps:
            self._led.given.value = before + part * (displacement - before)
            self.solve()
        return self._led.value

    def displacement(self) -> float:
        """Displacement on which the load works: of a pressure the enclosed volume in mm^3."""
        return compat.assemble_scalar(self.body.comm, self._displacement)

    def displacement_function(self) -> Any:
        """Displacement part of the unknown, to be interpolated into."""
        return self.body.displacement_part(self.body.function)

    def force_along(
        self, motion: Callable[[np.ndarray], np.ndarray], pressed: tuple[str, float] | None = None
    ) -> float:
        """Return the work in N mm of the inner forces on a motion.

        Parameters
        ----------
        motion
            In mm, from (3, n) to (3, n).
        pressed
            Face and the pressure in MPa that pushes on it, whose work is taken off.
        """
        body = self.body
        v = fem.Function(body.function.function_space)
        part = body.displacement_part(v)
        part.interpolate(motion)
        work = ufl.derivative(body.energy, body.function, v)
        if pressed is not None:
            face, pressure = pressed
            push = -pressure * cofactor(deformation_gradient(body.u)) * body.normal
            moved = ufl.split(v)[0] if body.is_mixed else v
            work = work - body.on_face(face, ufl.inner(push, moved))
        return compat.assemble_scalar(body.comm, compat.form(work))

    def at(self, point: np.ndarray) -> np.ndarray:
        """Return the displacement in mm of the node at a point, the same on all ranks."""
        u = self.body.displacement()
        space = u.function_space
        n = space.dofmap.index_map.size_local
        x = space.tabulate_dof_coordinates()[:n]
        here = np.flatnonzero(np.linalg.norm(x - point, axis=1) < 1e-6)
        found = self.body.comm.allgather(u.x.array.reshape(-1, 3)[here])
        return np.concatenate(found)[0]


class _Resin(ResinBody):
    """A resin body by the names that an elastomer has for the same."""

    def __init__(
        self, comm: MPI.Comm, grid: TetMesh, material: Elastic, clamped: Sequence[str] = (),
        symmetry: Mapping[str, int] | None = None,
    ) -> None:
        held = [(face, axis) for face in clamped for axis in range(3)]
        super().__init__(comm, grid, material, [*held, *(symmetry or {}).items()])

    @property
    def u(self) -> Any:
        return self.function

    def displacement(self) -> fem.Function:
        return self.function

    def displacement_part(self, function: Any) -> Any:
        return function

    def n_pressures(self) -> int:
        return 0

    def volume_measure(self, degree: int) -> Any:
        return ufl.dx(domain=self.mesh, metadata={"quadrature_degree": degree})
