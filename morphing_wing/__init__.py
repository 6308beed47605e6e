"""Pneumatic morphing wings with pantographic ribs on FEniCSx."""

from importlib import import_module as _import
from typing import Any

from morphing_wing import blas as _blas

# Before anything below imports numpy or PETSc: OpenBLAS reads its settings when it is loaded.
_blas.prepare()

# Before DOLFINx: where it comes as a wheel, mpi4py is what finds and loads the MPI library for all.
from mpi4py import MPI as _MPI  # noqa: E402, F401

# Loaded when first used: DOLFINx takes a second.
_PLACES = {
    "Spar": "spar", "Rib": "rib", "Wing": "wing", "Path": "path", "State": "path",
    "Trim": "trim", "load_table": "path", "Progress": "progress", "plot_paths": "curves",
    "Adhesive": "materials", "Yeoh": "materials", "Elastic": "materials",
    "Case": "studies.case", "run_case": "studies.case", "Study": "studies.study",
    "Factor": "studies.factors", "Design": "studies.designs",
    "DRAGON_SKIN_30": "materials", "RESIN": "materials", "InputError": "errors",
}  # fmt: skip
__all__ = list(_PLACES)


def __getattr__(name: str) -> Any:
    if name not in _PLACES:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    found = getattr(_import(f"{__name__}.{_PLACES[name]}"), name)
    globals()[name] = found
    return found


def __dir__() -> list[str]:
    return sorted([*globals(), *_PLACES])
