"""The BLAS under PETSc and MUMPS: give it the right kernel, and say which one is at work.

More than half of a large solve is spent in MUMPS's dense kernels, that is in the BLAS. OpenBLAS
picks its kernel when it is loaded, by the processor's model number. OpenBLAS 0.3.21 (Debian 12)
takes some new Intel processors for a "Prescott" of 2004 and then runs four to eight times slower
than it could. The processor's own flags say better, and `OPENBLAS_CORETYPE` tells OpenBLAS.

OpenBLAS reads the variable once, when it is loaded. So `prepare` runs when `morphing_wing` is
imported, and works if that is before PETSc's BLAS is loaded. A numpy that was imported first does
no harm where it brings a BLAS of its own (from pip), but Debian's numpy and conda-forge's share
PETSc's: then the kernel is fixed already, and all that `check` can do is to warn.
"""

import ctypes
import os
import platform
import warnings
from pathlib import Path

import threadpoolctl

VARIABLE = "OPENBLAS_CORETYPE"

# Flags as /proc/cpuinfo spells them; the first kernel whose flags are all there is taken.
KERNELS = (
    ("SkylakeX", {"avx512f", "avx512dq", "avx512bw", "avx512vl"}),
    ("Haswell", {"avx2", "fma"}),
)
# What OpenBLAS falls back to on x86-64 when it does not know the processor.
FALLBACK_CORES = ("prescott", "katmai")
REFERENCE = "reference"
# One function of each BLAS that may stand behind the name libblas.so.3 (Debian's alternatives).
FAST_FUNCTIONS = (
    "openblas_get_config",
    "bli_info_get_version_str",
    "ATL_buildinfo",
    "MKL_Get_Version",
)

_warned = False


def prepare() -> None:
    """Name the kernel for OpenBLAS, unless the user did or the processor is no x86.

    Sets `OPENBLAS_CORETYPE` and touches nothing else. Warns if a slow BLAS is loaded already.
    """
    core = suitable_core(cpu_flags())
    # check first: a library that is loaded already has not read what is set below.
    check()
    if core is not None and VARIABLE not in os.environ:
        # os.environ calls putenv, so C libraries loaded later see it, and so do child processes.
        os.environ[VARIABLE] = core


def check() -> None:
    """Warn, once a run and on one rank, if the loaded BLAS is a slow one."""
    global _warned
    sentence = "" if _warned or not _is_first_rank() else complaint(describe(), cpu_flags())
    if sentence:
        _warned = True
        warnings.warn(sentence, RuntimeWarning, stacklevel=2)


def suitable_core(flags: set[str], machine: str | None = None) -> str | None:
    """Return the OpenBLAS kernel that a processor with these flags should run.

    Parameters
    ----------
    flags
        The processor's flags, as /proc/cpuinfo spells them.
    machine
        Architecture as `platform.machine` spells it; None: this machine's.

    Returns
    -------
    str or None
        None where OpenBLAS had better decide alone: not x86, or neither AVX2 nor AVX-512.
    """
    if (machine or platform.machine()) != "x86_64":
        return None
    return next((core for core, needed in KERNELS if needed <= flags), None)


def describe() -> dict[str, str]:
    """Return which BLAS this process has loaded for PETSc and MUMPS.

    Returns
    -------
    dict
        `library` (its path), `version`, `core` (the kernel that it runs, or "reference") and
        `coretype` (what `OPENBLAS_CORETYPE` asks for). What is unknown or not loaded yet is "".
    """
    found = {"library": "", "version": "", "core": "", "coretype": os.environ.get(VARIABLE, "")}
    reference = [path for path in _mapped_files("libblas.") if _is_reference(path)]
    fast = [
        library
        for library in threadpoolctl.threadpool_info()
        if library["user_api"] == "blas" and not _is_private(library["filepath"])
    ]
    if reference:
        found |= {"library": reference[0], "core": REFERENCE}
    elif fast:
        found["library"] = fast[0]["filepath"]
        found["version"] = fast[0].get("version") or ""
        found["core"] = fast[0].get("architecture") or ""
    return found


def complaint(used: dict[str, str], flags: set[str]) -> str:
    """Return one sentence on a slow BLAS and its cure, or "" where all is well.

    Parameters
    ----------
    used
        As `describe` returns it.
    flags
        The processor's flags, as /proc/cpuinfo spells them.
    """
    core = suitable_core(flags)
    if core is not None and used["core"].lower() in FALLBACK_CORES:
        return (
            f"OpenBLAS {used['version']} runs its {used['core']} kernel, four to eight times "
            f"slower than this processor's {core}: import morphing_wing before numpy, or start "
            f"Python with {VARIABLE}={core} in the environment."
        )
    if used["core"] == REFERENCE:
        return (
            f"PETSc's BLAS is the reference one ({used['library']}), about four times slower than "
            "OpenBLAS: install libopenblas0-serial, or choose it with update-alternatives."
        )
    return ""


def cpu_flags() -> set[str]:
    """Return the processor's flags; empty where the system does not list them (not Linux)."""
    try:
        lines = Path("/proc/cpuinfo").read_text().splitlines()
    except OSError:
        return set()
    flags = next((line for line in lines if line.startswith("flags")), "flags :")
    return set(flags.split(":")[1].split())


def _is_private(path: str) -> bool:
    """Return True for the copies that the pip packages of numpy and scipy keep for themselves."""
    return any(part in ("numpy.libs", "scipy.libs") for part in Path(path).parts)


def _is_reference(path: str) -> bool:
    """Return True for a libblas with none of the fast libraries in it or below it."""
    library = ctypes.CDLL(path)
    return not any(hasattr(library, name) for name in FAST_FUNCTIONS)


def _mapped_files(prefix: str) -> list[str]:
    """Return the libraries in this process whose file name begins so (Linux; else none)."""
    try:
        lines = Path("/proc/self/maps").read_text().splitlines()
    except OSError:
        return []
    paths = dict.fromkeys(line.split(maxsplit=5)[5] for line in lines if line.count("/"))
    return [path for path in paths if Path(path).name.startswith(prefix)]


def _is_first_rank() -> bool:
    """Return False on ranks other than 0, as the launcher's variables tell before MPI starts."""
    launchers = ("OMPI_COMM_WORLD_RANK", "PMI_RANK", "PMIX_RANK", "SLURM_PROCID")
    return next((os.environ[name] for name in launchers if name in os.environ), "0") == "0"
