"""The spar by FElupe (https://felupe.readthedocs.io), an independent finite-element code.

Its usual fast ways: Yeoh's law by hand instead of automatic differentiation; Q1/P0 with pressure
and volume ratio condensed in each cell; Q2/P1disc in three fields (displacement, pressure, volume
ratio); MKL PARDISO if pypardiso is installed, MUMPS through petsc4py otherwise.
"""

import felupe as fem
import numpy as np
from felupe.math import dya

try:
    from pypardiso import spsolve

    SOLVER = "PARDISO"
except ImportError:
    import morphing_wing  # noqa: F401, I001  prepares BLAS before PETSc loads it
    from petsc4py import PETSc

    SOLVER = "MUMPS"
# Facets of a cell in the package's order: axis and side.
SIDES = [(2, -1), (1, -1), (0, -1), (0, 1), (1, 1), (2, 1)]


def solve(problem, element, steps, threads):
    """Return the angle in degrees, iterations and unknowns."""
    quadratic = element == "Q2/P1disc"
    kind = fem.TriQuadraticHexahedron() if quadratic else fem.Hexahedron()
    mesh = mesh_of(problem, kind)
    umat = Yeoh(*problem["yeoh"], parallel=threads > 1)
    bulk = float(problem["bulk"])
    if quadratic:
        field = three_fields(mesh)
        body = fem.SolidBody(fem.NearlyIncompressible(umat, bulk=bulk), field)
        boundary = fem.RegionTriQuadraticHexahedronBoundary
    else:
        field = fem.FieldContainer([fem.Field(fem.RegionHexahedron(mesh), dim=3)])
        body = fem.SolidBodyNearlyIncompressible(umat, field, bulk=bulk)
        boundary = fem.RegionHexahedronBoundary

    def on_face(name):
        mask = points_on(problem[name], mesh, kind)
        return fem.FieldContainer([fem.Field(boundary(mesh, mask=mask), dim=3)])

    # Cells' faces on the symmetry plane between two chambers have all their corners on chambers
    # and come along in Q1; their force is along x, where nothing moves.
    chambers, tip = on_face("upper_chambers"), on_face("tip")
    load = fem.SolidBodyPressure(chambers)
    held = {
        "root": fem.Boundary(field[0], fz=0.0),
        "symmetry": fem.Boundary(field[0], fx=0.0, skip=(0, 1, 1)),
    }
    dof0, dof1 = fem.dof.partition(field, held)
    iterations = 0
    for step in steps:
        load.update(step)
        found = fem.newtonraphson(
            items=[body, load], dof0=dof0, dof1=dof1, ext0=np.zeros(len(dof0)), verbose=0,
            solver=spsolve if SOLVER == "PARDISO" else by_mumps, kwargs={"parallel": threads > 1})
        iterations += found.iterations
        chambers[0].values = tip[0].values = field[0].values
    F = np.moveaxis(tip.extract()[0], (0, 1), (-2, -1))
    cofactor = np.linalg.det(F)[..., None, None] * np.linalg.inv(F).swapaxes(-2, -1)
    normal = np.einsum("qcij,jqc->i", cofactor, tip.region.dA)
    return {"angle": float(np.degrees(np.arctan2(-normal[1], normal[2]))),
            "iterations": iterations, "dofs": int(sum(field.fieldsizes))}


class Yeoh(fem.ConstitutiveMaterial):
    """C10 (I1bar - 3) + C20 (I1bar - 3)^2; I1bar - 3 is neo-Hooke's energy for mu = 2."""

    def __init__(self, C10, C20, parallel):
        self.C10, self.C20, self.parallel = C10, C20, parallel
        self.I1bar = fem.NeoHooke(mu=2.0)
        self.x = [np.eye(3), np.zeros(0)]

    def _gradient(self, x):
        return [self._slope(x) * self.I1bar._gradient(x)[0], x[-1]]

    def _hessian(self, x):
        first, second = self.I1bar._gradient(x)[0], self.I1bar._hessian(x)[0]
        second *= self._slope(x)
        second += 2.0 * self.C20 * dya(first, first)
        return [second]

    def _slope(self, x):
        return self.C10 + 2.0 * self.C20 * self.I1bar.function(x)[0]


def mesh_of(problem, kind):
    """Return FElupe's mesh of 8 or 27 points a cell."""
    part = (kind.points[:, None, :] + 1.0) / 2.0
    corner = np.array([(i, j, k) for k in (0, 1) for j in (0, 1) for i in (0, 1)])
    weights = np.where(corner[None] == 1, part, 1.0 - part).prod(axis=2)
    points = np.einsum("pv,cvi->cpi", weights, problem["points"][problem["cells"]]).reshape(-1, 3)
    _, first, number = np.unique(
        np.round(points, 9) + 0.0, axis=0, return_index=True, return_inverse=True)
    cells = number.ravel().reshape(len(problem["cells"]), -1)
    return fem.Mesh(points[first], cells, cell_type=f"hexahedron{len(kind.points)}".rstrip("8"))


def three_fields(mesh):
    """Return displacement, and pressure and volume ratio linear in each cell."""

    class Linear(fem.Hexahedron):
        """1, r, s, t in each cell."""

        def __init__(self):
            super().__init__()
            self.shape = (4, 3)

        def function(self, r):
            return np.array([1.0, *r])

        def gradient(self, r):
            return np.vstack([np.zeros(3), np.eye(3)])

    region = fem.RegionTriQuadraticHexahedron(mesh)
    n = mesh.ncells
    dual = fem.Mesh(np.zeros((4 * n, 3)), np.arange(4 * n).reshape(n, 4), cell_type="linear")
    linear = fem.Region(dual, Linear(), region.quadrature, grad=False)
    ratio = fem.Field(linear, dim=1)
    ratio.values[::4] = 1.0
    return fem.FieldContainer([fem.Field(region, dim=3), fem.Field(linear, dim=1), ratio])


def points_on(facets, mesh, kind):
    """Return the mask of a mesh's points on facets, pairs of cell and side."""
    mask = np.zeros(mesh.npoints, dtype=bool)
    for number, (axis, side) in enumerate(SIDES):
        there = mesh.cells[facets[facets[:, 1] == number, 0]]
        mask[there[:, kind.points[:, axis] == side]] = True
    return mask


def by_mumps(A, b):
    """Solve a sparse system by MUMPS through petsc4py."""
    A = A.tocsr()
    A.sort_indices()
    matrix = PETSc.Mat().createAIJ(A.shape, csr=(
        A.indptr.astype(PETSc.IntType), A.indices.astype(PETSc.IntType), A.data))
    solver = PETSc.KSP().create()
    solver.setOperators(matrix)
    solver.setType("preonly")
    solver.getPC().setType("lu")
    solver.getPC().setFactorSolverType("mumps")
    right, x = matrix.createVecs()
    right.array[:] = np.asarray(b).ravel()
    solver.solve(right, x)
    found = x.array.copy()
    for item in (solver, matrix, right, x):
        item.destroy()
    return found
