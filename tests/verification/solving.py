"""Equilibrium of one elastomer body under held faces and one pressure."""

from dolfinx import fem
from mpi4py import MPI

from morphing_wing import compat
from morphing_wing.elastomer import Elastomer
from morphing_wing.elements import ELEMENTS
from morphing_wing.newton import Newton
from morphing_wing.system import EquilibriumSystem


class Equilibrium:
    """A body, its equations and Newton's method.

    ``volume`` takes the body to the UFL functional on which the pressure does its work.
    """

    def __init__(self, grid, material, element, volume=None, **held):
        self.body = Elastomer(
            MPI.COMM_SELF, grid, material, ELEMENTS[element], thin=("body",), **held)
        self.system = EquilibriumSystem(self.body.comm, [self.body.block])
        self.pressure = fem.Constant(self.body.mesh, compat.scalar_type(0.0))
        energy = self.body.energy
        if volume is not None:
            functional = volume(self.body)
            energy = energy - self.pressure * functional
            self._volume = compat.form(functional)
        self.system.set_energies([energy], [self.body.tangent_correction])
        iterate = self.body.iterate
        self._newton = Newton(
            self.system, "test_verification_", expected_negative=self.body.n_pressures(),
            before_tangent=iterate.before_tangent if iterate else None)

    def solve(self, force=1e-3):
        """Solve to a residual of 1e-9 times a force in N, and take the state as converged."""
        result = self._newton.solve(force)
        assert result.converged, result.reason
        assert result.negative_pivots == 0
        if self.body.iterate:
            self.body.iterate.accept()
        return result

    def enclosed(self):
        """Volume in mm^3 on which the pressure does its work."""
        return compat.assemble_scalar(self.body.comm, self._volume)

    def displacement_function(self):
        """Displacement part of the unknown, to be interpolated into."""
        return self.body.displacement_part(self.body.function)
