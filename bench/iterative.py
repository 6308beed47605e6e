"""An iterative solver for thin nearly incompressible walls: Q2/P1disc, one rank.

The tangent of the mixed form is K = [[A, B'], [B, -M/kappa]], with the pressure's mass matrix M, a
block a cell. Three things make a preconditioner of it that FGMRES gets along with:

- the pressure by its mass matrix, for B A^-1 B' is like M/mu;
- A augmented by ``gamma`` mu B' M^-1 B, which stays within a cell and so adds no entry. With none
  of it thin walls cost more iterations, with much of it A is as hard to solve as rubber itself;
- A by two levels, Q2 and Q1, the coarse one factorised: an aggregate of AMG knows nothing of walls
  one element thick.
"""

from dataclasses import dataclass

import basix
import numpy as np
from petsc4py import PETSc
from scipy.sparse import csr_matrix, kron

from morphing_wing import compat

OPTIONS = {
    "mg_levels_ksp_type": "chebyshev", "mg_levels_ksp_max_it": 2, "mg_levels_pc_type": "sor",
    "mg_coarse_ksp_type": "preonly", "mg_coarse_pc_type": "cholesky",
    "mg_coarse_pc_factor_mat_solver_type": "mumps", "mg_coarse_mat_mumps_icntl_13": 1,
}


@dataclass
class Parts:
    """What the preconditioner has to know beside the matrix.

    Attributes
    ----------
    u, p : (n,) and (n_cells, 4) arrays
        Unknowns that are displacements, node by node, and pressures, cell by cell.
    up
        Interpolation from the corners' displacements to those of all nodes.
    mu, kappa
        Moduli in MPa.
    """

    u: np.ndarray
    p: np.ndarray
    up: csr_matrix
    mu: float
    kappa: float

    @classmethod
    def of(cls, scene):
        """Return the parts of a spar's tangent."""
        body = scene.body
        space, u = body.displacement_space()
        p = _cell_dofs(body.function.function_space.sub(1))
        held = ~scene.system.free[u]
        material = body.material
        return cls(u, p, _interpolation(space, held), 2.0 * material.coefficients[0], material.bulk)


class AugmentedMultigrid:
    """A PETSc Python preconditioner, block triangular.

    Parameters
    ----------
    K
        The matrix.
    parts
        What its unknowns are.
    gamma
        Augmentation in shear moduli.
    prefix
        Prefix of the PETSc options of the two levels, `OPTIONS` where they are not set.
    """

    def __init__(self, K, parts, gamma=1.0, prefix="spar_levels_"):
        self._parts = parts
        u, p = (PETSc.IS().createGeneral(dofs.astype(PETSc.IntType), comm=PETSc.COMM_SELF)
                for dofs in (parts.u, parts.p.ravel()))
        A, B, self._gradient = (K.createSubMatrix(*part) for part in ((u, u), (p, u), (u, p)))
        mass = np.stack([-parts.kappa * K.getValues(dofs, dofs) for dofs in parts.p])
        self._inverse_mass = np.linalg.inv(mass)
        bulk = gamma * parts.mu
        within_cells = _block_diagonal(self._inverse_mass).ptap(B)
        A.axpy(bulk, within_cells, PETSc.Mat.Structure.SUBSET_NONZERO_PATTERN)
        within_cells.destroy()
        schur = 1.0 / (1.0 / parts.kappa + 1.0 / (parts.mu + bulk))
        self._pressure, self._push = -schur, bulk + (1.0 - bulk / parts.kappa) * schur
        self._levels = _two_levels(A, _matrix(parts.up), prefix)
        self._displacement, self._force = A.createVecs()
        self._scaled = B.createVecLeft()

    def apply(self, pc, b, y):
        """Solve for the pressure, and with it for the displacement."""
        given, found = b.getArray(readonly=True), y.getArray()
        scaled = np.einsum("cij,cj->ci", self._inverse_mass, given[self._parts.p])
        found[self._parts.p] = self._pressure * scaled
        self._scaled.array[:] = self._push * scaled.ravel()
        self._gradient.mult(self._scaled, self._force)
        self._force.array[:] += given[self._parts.u]
        self._levels.apply(self._force, self._displacement)
        found[self._parts.u] = self._displacement.array


def _two_levels(A, up, prefix):
    """Return a PC of A with its coarse level behind the interpolation."""
    options = PETSc.Options(prefix)
    for name, value in OPTIONS.items():
        if not options.hasName(name):
            options.setValue(name, value)
    pc = PETSc.PC().create(A.comm)
    pc.setOptionsPrefix(prefix)
    pc.setOperators(A)
    pc.setType("mg")
    pc.setMGLevels(2)
    pc.setMGInterpolation(1, up)
    pc.getMGSmoother(1).setOperators(A)
    pc.getMGCoarseSolve().setOperators(A.ptap(up))
    pc.setFromOptions()
    pc.setUp()
    return pc


def _interpolation(space, held):
    """Return the interpolation from corners to all nodes, between displacements that are free."""
    corners = compat.vector_space(space.mesh, 1)
    linear = basix.create_element(basix.ElementFamily.P, basix.CellType.hexahedron, 1)
    points = compat.interpolation_points(space)
    values = linear.tabulate(0, points)[0].reshape(len(points), 8)
    place, corner = np.nonzero(np.abs(values) > 1e-12)
    rows, columns = _cell_dofs(space)[:, place].ravel(), _cell_dofs(corners)[:, corner].ravel()
    entries = np.tile(values[place, corner], len(rows) // len(place))
    _, once = np.unique(np.stack([rows, columns]), axis=1, return_index=True)
    rows, columns, entries = rows[once], columns[once], entries[once]
    node_of = np.empty(columns.max() + 1, dtype=int)
    at_corner = entries > 1.0 - 1e-12
    node_of[columns[at_corner]] = rows[at_corner]
    up = kron(csr_matrix((entries, (rows, columns))), np.eye(3)).tocsr()
    up = up.multiply(~held[:, None]).tocsc()[:, ~held.reshape(-1, 3)[node_of].ravel()].tocsr()
    up.eliminate_zeros()
    return up


def _cell_dofs(space):
    n_cells = space.mesh.topology.index_map(3).size_local
    return np.array([space.dofmap.cell_dofs(cell) for cell in range(n_cells)])


def _block_diagonal(blocks):
    n, size, _ = blocks.shape
    columns = np.arange(n * size).reshape(n, 1, size).repeat(size, axis=1)
    return _matrix(csr_matrix((blocks.ravel(), columns.ravel(), np.arange(n * size + 1) * size)))


def _matrix(csr):
    rows, columns = (part.astype(PETSc.IntType) for part in (csr.indptr, csr.indices))
    return PETSc.Mat().createAIJ(csr.shape, csr=(rows, columns, csr.data), comm=PETSc.COMM_SELF)
