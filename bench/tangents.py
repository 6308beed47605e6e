"""Tangents on which linear solvers are compared, and how a process hands one to another.

The half spar of Section 3.3 (Q2/P1disc), refined as it grows, and the wing of Section 5.1 with
quadratic elements; at rest, with 20 kPa in the upper chambers.
"""

from child import peak_MB, say

PRESSURE = 0.02
SPARS = {40: (1, 7), 200: (2, 9), 800: (4, 7)}  # thousands of unknowns: level of grading, chambers
WINGS = ("standard", "graded", "finer")


def spar(size):
    """Return the half spar of some thousand unknowns."""
    from morphing_wing.geometry.spar import SparGeometry, SparMeshing
    from morphing_wing.spar import Spar

    level, n_cells = SPARS[size]
    return Spar(SparGeometry.validation(n_cells), meshing=SparMeshing.graded(level))


def wing(mesh):
    """Return the wing of quadratic elements on a mesh."""
    from morphing_wing.geometry.hexmesh import two_sided
    from morphing_wing.geometry.wing import WingGeometry
    from morphing_wing.geometry.wing_mesh import WingMeshing
    from morphing_wing.wing import Wing

    meshings = {"standard": WingMeshing.coarse(), "graded": WingMeshing.graded(),
                "finer": WingMeshing.of(cavity_width=two_sided(8, 2.0), pocket=12, wall_length=2,
                                        cavity_length=two_sided(4, 3.0), cavity_height=2)}
    return Wing(WingGeometry.prototype(), fidelity="standard", meshing=meshings[mesh])


def loaded(scene):
    """Return tangent and residual of a scene at rest under pressure."""
    scene._use(("upper_MPa",))
    scene.set_load({name: PRESSURE for name in scene.loads})
    scene._take_up_contact()
    scene.before_tangent(0)
    at_rest, b = scene.system.x.duplicate(), scene.system.x.duplicate()
    scene.system.residual(at_rest, b)
    return scene.system.tangent(), b


def written(system, folder):
    """Write matrix and right-hand side of a system, and what an iterative solver has to know."""
    import numpy as np
    from iterative import Parts
    from mpi4py import MPI
    from petsc4py import PETSc
    from scipy.sparse import save_npz

    kind, size = system.split("-")
    scene = spar(int(size)) if kind == "spar" else wing(size)
    matrix, b = loaded(scene)
    with_matrix = PETSc.Viewer().createBinary(f"{folder}/system", "w", comm=MPI.COMM_SELF)
    matrix.view(with_matrix)
    b.view(with_matrix)
    if kind == "spar":
        parts = Parts.of(scene)
        np.savez(f"{folder}/parts", u=parts.u, p=parts.p, moduli=[parts.mu, parts.kappa])
        save_npz(f"{folder}/up", parts.up)
    say(MPI.COMM_SELF, {"unknowns": scene.dofs, "assembled_peak_MB": peak_MB(MPI.COMM_SELF)})
