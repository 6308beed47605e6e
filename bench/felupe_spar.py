"""The spar on one mesh by this package and by FElupe: the same angles, and what they cost.

FElupe (https://felupe.readthedocs.io, `pip install felupe tensortrax`) is an independent code:
its own elements, materials and assembly. The mesh is the one of ``SparMeshing.plain()``; so are
the formulations, Q1/P0 and Q2/P1disc, in FElupe's three fields (displacement, pressure, volume
ratio). Both use MUMPS, FElupe through petsc4py. Each case runs in a process of its own.
"""

import argparse
import importlib.util
import sys
import time

import numpy as np
from child import in_a_child, peak_MB, say
from rich.console import Console
from rich.table import Table

CASES = {
    "quick": [("Q1/P0", 4, 0.02), ("Q2/P1disc", 4, 0.02)],
    "all": [("Q1/P0", 4, 0.02), ("Q2/P1disc", 4, 0.02), ("Q1/P0", 20, 0.02),
            ("Q2/P1disc", 20, 0.02), ("Q2/P1disc", 20, 0.04)],
}
PUBLISHED = {("Q1/P0", 4, 0.02): 3.6921, ("Q2/P1disc", 4, 0.02): 3.8575,
             ("Q1/P0", 20, 0.02): 18.5451, ("Q2/P1disc", 20, 0.02): 19.2449,
             ("Q2/P1disc", 20, 0.04): 44.6434}


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--all", action="store_true", help="20 chambers too: minutes, 2 GB")
    parser.add_argument("--one", nargs=4, metavar=("CODE", "ELEMENT", "CELLS", "MPA"),
                        help="run one case here and print its figures as JSON")
    arguments = parser.parse_args()
    if arguments.one:
        code, element, n_cells, pressure = arguments.one
        measured(code, element, int(n_cells), float(pressure))
        return
    if importlib.util.find_spec("felupe") is None:
        sys.exit("FElupe is not installed: pip install felupe tensortrax")
    table = Table(title="Angle in degrees, seconds of the solve, peak memory in MB")
    columns = ("element", "N", "kPa", "known", "ours", "FElupe", "ours, s", "FElupe, s",
               "ours, MB", "FElupe, MB")
    for column in columns:
        table.add_column(column, justify="right")
    for case in CASES["all" if arguments.all else "quick"]:
        ours, theirs = (in_a_child(__file__, code, *case) for code in ("ours", "felupe"))
        element, n_cells, pressure = case
        name = (element, str(n_cells), f"{1000 * pressure:g}", f"{PUBLISHED[case]:.4f}")
        both = [f"{found[figure]:{form}}" for figure, form in
                (("angle", ".4f"), ("seconds", ".1f"), ("peak_MB", ".0f"))
                for found in (ours, theirs)]
        table.add_row(*name, *both)
    Console(width=110).print(table)


def measured(code, element, n_cells, pressure):
    """Run one case and say its angle, seconds and peak memory."""
    import morphing_wing  # noqa: F401, I001  prepares BLAS for both codes
    from mpi4py import MPI

    solve = by_this_package if code == "ours" else by_felupe
    solve(element, 1, 0.005)  # compiles
    clock = time.perf_counter()
    angle = solve(element, n_cells, pressure)
    say(MPI.COMM_SELF, {"angle": angle, "seconds": time.perf_counter() - clock,
                        "peak_MB": peak_MB(MPI.COMM_SELF)})


def by_this_package(element, n_cells, pressure):
    """Return the angle by the package's scene."""
    from morphing_wing.geometry.spar import SparGeometry, SparMeshing
    from morphing_wing.spar import Spar

    scene = Spar(SparGeometry.validation(n_cells), element=element, meshing=SparMeshing.plain())
    path = scene.inflate(upper=steps_to(pressure))
    return path[-1].measures["span_angle_deg"]


def steps_to(pressure):
    """Return load steps of 20 kPa at most."""
    count = int(np.ceil(pressure / 0.02 - 1e-9))
    return list(np.linspace(0.0, pressure, count + 1)[1:])


# -- FElupe ---------------------------------------------------------------------------------------


def by_felupe(element, n_cells, pressure):
    """Return the angle by FElupe on the package's mesh."""
    import felupe as fem

    from morphing_wing.geometry.spar import SparGeometry, SparMeshing
    from morphing_wing.materials import DRAGON_SKIN_30

    quadratic = element == "Q2/P1disc"
    grid = SparGeometry.validation(n_cells).mesh(SparMeshing.plain())
    mesh = felupe_mesh(grid, quadratic)
    field = three_fields(mesh, quadratic)
    C10, C20 = DRAGON_SKIN_30.coefficients
    rubber = fem.Hyperelastic(fem.yeoh, C10=C10, C20=C20, C30=0.0)
    body = fem.SolidBody(fem.NearlyIncompressible(rubber, bulk=DRAGON_SKIN_30.bulk), field)

    boundary = (fem.RegionTriQuadraticHexahedronBoundary if quadratic
                else fem.RegionHexahedronBoundary)

    def on_face(name):
        return fem.FieldContainer([fem.Field(
            boundary(mesh, mask=on_grid_face(mesh, grid, name)), dim=3)])

    chambers, tip = on_face("upper_chambers"), on_face("tip")
    chambers[0].values = tip[0].values = field[0].values
    load = fem.SolidBodyPressure(chambers)
    held = {
        "root": fem.Boundary(field[0], fz=0.0),
        "symmetry": fem.Boundary(field[0], fx=0.0, skip=(0, 1, 1)),
    }
    dof0, dof1 = fem.dof.partition(field, held)
    for step in steps_to(pressure):
        load.update(step)
        fem.newtonrhapson(items=[body, load], dof0=dof0, dof1=dof1, verbose=0,
                          solver=by_mumps, ext0=np.zeros(len(dof0)))
        chambers[0].values = tip[0].values = field[0].values
    F = tip.extract()[0]
    cofactor = np.linalg.det(np.moveaxis(F, (0, 1), (-2, -1)))[None, None] * np.moveaxis(
        np.linalg.inv(np.moveaxis(F, (0, 1), (-1, -2))), (-2, -1), (0, 1))
    normal = np.einsum("ijqc,jqc->i", cofactor, tip.region.dA)
    return float(np.degrees(np.arctan2(-normal[1], normal[2])))


def felupe_mesh(grid, quadratic):
    """Return FElupe's mesh of 8 or 27 points a cell."""
    import felupe as fem

    kind = fem.TriQuadraticHexahedron() if quadratic else fem.Hexahedron()
    part = (kind.points[:, None, :] + 1.0) / 2.0
    corner = np.array([(i, j, k) for k in (0, 1) for j in (0, 1) for i in (0, 1)])
    weights = np.where(corner[None] == 1, part, 1.0 - part).prod(axis=2)
    points = np.einsum("pv,cvi->cpi", weights, grid.points[grid.cells])
    rounded = np.round(points.reshape(-1, 3), 9) + 0.0
    _, first, number = np.unique(rounded, axis=0, return_index=True, return_inverse=True)
    cells = number.ravel().reshape(len(grid.cells), -1)
    name = "hexahedron27" if quadratic else "hexahedron"
    return fem.Mesh(points.reshape(-1, 3)[first], cells, cell_type=name)


def three_fields(mesh, quadratic):
    """Return displacement, pressure and volume ratio; the latter constant or linear in a cell."""
    import felupe as fem

    if not quadratic:
        return fem.FieldsMixed(fem.RegionHexahedron(mesh), n=3)

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


def on_grid_face(mesh, grid, name):
    """Return the mask of a mesh's points on the axis-parallel rectangles of a grid's face."""
    mask = np.zeros(mesh.npoints, dtype=bool)
    for corners in grid.facet_points(name):
        low, high = corners.min(axis=0) - 1e-6, corners.max(axis=0) + 1e-6
        mask |= ((mesh.points > low) & (mesh.points < high)).all(axis=1)
    return mask


def by_mumps(A, b):
    """Solve a sparse system by MUMPS through petsc4py."""
    from petsc4py import PETSc

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


if __name__ == "__main__":
    main()
