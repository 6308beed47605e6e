"""Pneumatic morphing wings with pantographic ribs on FEniCSx."""

from morphing_wing import blas as _blas

# Before anything below imports numpy or PETSc: OpenBLAS reads its settings when it is loaded.
_blas.prepare()
