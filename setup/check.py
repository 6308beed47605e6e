"""Prove that the installed pieces fit each other: compiled modules, numpy, scalars, the package."""

import importlib
import logging

# First, as in every program: it prepares BLAS and MPI for what is loaded next.
from morphing_wing import blas, renderer

# isort: split
import dolfinx
import numpy as np
import ufl
from mpi4py import MPI
from petsc4py import PETSc

if np.issubdtype(PETSc.ScalarType, np.complexfloating):
    raise SystemExit("setup: petsc4py is built for complex numbers: install python3-petsc4py-real")

# Arrays cross from numpy to PETSc, DOLFINx and MPI and back: what a wrong binary interface breaks.
vector = PETSc.Vec().createWithArray(np.arange(3.0), comm=MPI.COMM_SELF)
vector.scale(2.0)
np.testing.assert_array_equal(vector.array, [0.0, 2.0, 4.0])
mesh = dolfinx.mesh.create_unit_square(MPI.COMM_SELF, 2, 2)
assert mesh.geometry.x.shape == (9, 3)

# The smallest form that has to be compiled: needs a C compiler and Python's headers.
logging.disable(logging.INFO)  # the compiler's command lines
area = dolfinx.fem.assemble_scalar(dolfinx.fem.form(ufl.as_ufl(1.0) * ufl.dx(domain=mesh)))
np.testing.assert_allclose(area, 1.0)

total = np.zeros(1)
MPI.COMM_SELF.Allreduce(np.ones(1), total)
assert total[0] == 1.0
for name in (
    "gmsh",
    "pyvista",
    "scipy.sparse",
    "pandas",
    "morphing_wing.forms",
    "morphing_wing.geometry",
):
    importlib.import_module(name)

try:
    renderer.choose_renderer()
except renderer.NoRenderer as error:
    print(f"setup: warning: no pictures: {error}")

used = blas.describe()
print(
    f"setup: DOLFINx {dolfinx.__version__}, numpy {np.__version__}, "
    f"PETSc {'.'.join(map(str, PETSc.Sys.getVersion()))} on {used['library']} {used['version']} "
    f"({used['core']})"
)
