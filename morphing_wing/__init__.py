"""Pneumatic morphing wings with pantographic ribs on FEniCSx."""

from morphing_wing import blas as _blas

# Before anything below imports numpy or PETSc: OpenBLAS reads its settings when it is loaded.
_blas.prepare()

# Before DOLFINx: where it comes as a wheel, mpi4py is what finds and loads the MPI library for all.
from mpi4py import MPI as _MPI  # noqa: E402, F401
