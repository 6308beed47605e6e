"""A strip 20 x 0.5 x 1 mm, clamped at both ends, pushed together until it buckles."""

import numpy as np
from dolfinx import fem
from mpi4py import MPI

from morphing_wing.elastomer import Elastomer
from morphing_wing.elements import ELEMENTS
from morphing_wing.geometry.hexmesh import swept_blocks, uniform
from morphing_wing.inertia import Regularisation
from morphing_wing.materials import Yeoh
from morphing_wing.newton import Newton
from morphing_wing.system import EquilibriumSystem

LENGTH, HEIGHT = 20.0, 0.5


class Strip:
    """The strip, with a dent of ``imperfection`` mm, and Newton's method."""

    def __init__(self, imperfection, regularised, element="Q2 reduced", cells=10):
        def mapping(x):
            dent = imperfection * np.sin(np.pi * x[:, 0] / LENGTH) ** 2
            return x + np.outer(dent, [0.0, 1.0, 0.0])

        def faces(midpoints, normals):
            return {"left": normals[:, 0] < 0, "right": normals[:, 0] > 0}

        lines = LENGTH * uniform(cells), HEIGHT * uniform(1), uniform(1)
        grid = swept_blocks(lines, np.ones((cells, 1, 1), int), {1: "body"}, mapping, faces)
        self.body = body = Elastomer(MPI.COMM_SELF, grid, Yeoh((0.117,), bulk=20.0),
                                     ELEMENTS[element], clamped=("left", "right"))
        self.system = EquilibriumSystem(body.comm, [body.block])
        self.system.set_energies([body.energy], [body.tangent_correction])
        rule = None
        if regularised:
            everywhere = np.ones(self.system.n_owned, dtype=bool)
            rule = Regularisation(body.lumped_volume("body"), everywhere)
        self.newton = Newton(
            self.system, "test_strip_", rule, body.n_pressures(), max_iterations=60,
            before_tangent=body.iterate.before_tangent if body.iterate else None)

    def push(self, by):
        """Move the right end by mm to the left and solve; return Newton's result."""
        space = self.body.function.function_space
        right = self._right_end(self.body.displacement_part(space))
        self.body.function.x.array[right] = -by
        result = self.newton.solve(1e-2)
        if self.body.iterate:
            self.body.iterate.accept()
            self.body.iterate.before_tangent(0)
        return result

    def negative_eigenvalues(self):
        """Number of negative eigenvalues of the tangent beyond those of the pressures."""
        eigenvalues = np.linalg.eigvalsh(self.system.tangent()[:, :])
        return int((eigenvalues < 0.0).sum()) - self.body.n_pressures()

    def bow(self):
        """Largest deflection in mm."""
        return float(np.abs(self.body.displacement().x.array[1::3]).max())

    def _right_end(self, space):
        part = space.sub(0)
        collapsed, _ = part.collapse()
        return fem.locate_dofs_topological(
            (part, collapsed), 2, self.body.faces.facets("right"))[0]
