"""One elastomer body whose faces are moved, and what acts on it: contact or glue."""

import numpy as np
import ufl
from dolfinx import fem
from mpi4py import MPI

from morphing_wing import compat
from morphing_wing.adhesive import GluedPatches
from morphing_wing.contact import Contact, Opposed
from morphing_wing.elastomer import Elastomer
from morphing_wing.elements import ELEMENTS
from morphing_wing.geometry.patches import patch_points
from morphing_wing.newton import Newton
from morphing_wing.surface import Surface
from morphing_wing.system import EquilibriumSystem

MOST_ROUNDS = 6


class Moved:
    """A body with one more part, made by ``part`` from the body, and Newton's method.

    ``part`` returns a `Contact`, a `GluedPatches` on a foot that stands still, or None.
    """

    def __init__(self, grid, material, element, part=lambda body: None, **held):
        self.body = body = Elastomer(
            MPI.COMM_SELF, grid, material, ELEMENTS[element], thin=("body",), **held)
        self.part = part(body)
        self.parts = [body] if self.part is None else [body, self.part]
        self.system = EquilibriumSystem(body.comm, [part.block for part in self.parts])
        if isinstance(self.part, GluedPatches):
            self.part.join(self.system)
        self.system.set_energies([part.energy for part in self.parts],
                                 [part.tangent_correction for part in self.parts])
        self.newton = Newton(
            self.system, "test_moved_", max_iterations=60, before_tangent=self.before_tangent,
            admissible=self.admissible if isinstance(self.part, Contact) else None)
        self._internal = compat.form(ufl.derivative(
            body.energy, body.function, ufl.TestFunction(body.function.function_space)))

    def move(self, face, axis, by):
        """Give a held face a displacement in mm along an axis."""
        self.body.function.x.array[self._dofs(face, axis)] = by

    def lead(self, face, axis, start, end):
        """Move a held face from one displacement in mm to another, in as many steps as it takes.

        ``on_step`` is called with the displacement after each step.
        """
        values, here, step = self.body.function.x.array, start, end - start
        while here != end:
            last = values.copy()
            there = end if abs(end - here) < 1.01 * abs(step) else here + step
            self.move(face, axis, there)
            try:
                self.solve()
            except AssertionError:
                values[:] = last
                step /= 2
                assert abs(step) > abs(end - start) / 128, f"stopped at {here}"
                continue
            here = there
            self.on_step(there)

    def on_step(self, displacement):
        """Do nothing; replace it to be told of each step."""

    def solve(self, force=1e-3):
        """Solve, find anew what touches what, and take the state as converged."""
        contact = self.part if isinstance(self.part, Contact) else None
        if contact is not None and contact.prepare(self.system):
            self.newton.renew()
        result = self.newton.solve(force)
        assert result.converged, result.reason
        rounds = 1
        while contact is not None and contact.review(self.system):
            self.newton.renew()
            result, rounds = self.newton.solve(force), rounds + 1
            assert result.converged, result.reason
            assert rounds < MOST_ROUNDS
        for part in self.parts:
            part.iterate.accept()
        if isinstance(self.part, GluedPatches):
            self.part.accept()
        return result

    def before_tangent(self, iteration):
        for part in self.parts:
            part.iterate.before_tangent(iteration)

    def admissible(self, x, step):
        return self.part.admissible(self.system, x, step)

    def reaction(self, face, axis):
        """Force in N along an axis that holds a face where it is."""
        forces = np.zeros_like(self.body.function.x.array)
        compat.assemble_vector(self._internal, forces)
        return float(forces[self._dofs(face, axis)].sum())

    def stored(self):
        """Energy in N mm stored in all parts."""
        return sum(compat.assemble_scalar(MPI.COMM_SELF, compat.form(
            getattr(part, "stored", part.energy))) for part in self.parts)

    def _dofs(self, face, axis):
        body = self.body
        part = body.displacement_part(body.function.function_space).sub(axis)
        collapsed, _ = part.collapse()
        return fem.locate_dofs_topological((part, collapsed), 2, body.faces.facets(face))[0]


LINEAR = 1e-12
"""Penetration in mm beyond which the pressure grows with it: the closed forms' law."""


def pressing(*pairs, stiffness):
    """Return what makes the contact of nodes of a face with another face, for each pair."""
    def make(body):
        surface = {name: Surface(body, body.grid.facets[name]) for pair in pairs for name in pair}
        return Contact(body.comm, [
            Opposed(surface[a].nodes, surface[b], surface[a].area, np.zeros(len(surface[a].area)))
            for a, b in pairs], stiffness, soft=LINEAR)

    return make


class Foot(GluedPatches):
    """Glue between the part of a face in a box and a rigid foot that stands still."""

    def __init__(self, body, face, box, law):
        self.surface = Surface(body, body.grid.facets[face])
        self.points = patch_points(self.surface.nodes.reference, self.surface.facets, box)
        super().__init__(body.comm, self.points, np.zeros_like(self.points.place), law)

    def join(self, system):
        """Tell the system whose unknowns the points share."""
        faces = self.surface.nodes.numbers[self.surface.facets[self.points.facet]]
        self.number(system, faces, np.full((len(faces), 6), -1))


def glued(face, law, box=((-1e3, -1e3, -1e3), (1e3, 1e3, 1e3))):
    """Return what glues the part of a face in a box to a foot that stands still."""
    return lambda body: Foot(body, face, np.array(box), law)
