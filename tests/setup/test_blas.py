import os
import subprocess
import sys
from pathlib import Path

import pytest

from morphing_wing import blas

pytestmark = pytest.mark.quick

AVX2 = {"avx2", "fma"}
AVX512 = AVX2 | {"avx512f", "avx512dq", "avx512bw", "avx512vl"}
# MPI first, as the wheels of DOLFINx want it; then PETSc, and its BLAS, before the package.
LOADED_BEFORE = "import mpi4py.MPI; from petsc4py import PETSc; import morphing_wing;"


def run_python(program: str, **environment: str) -> subprocess.CompletedProcess:
    """Run a program in a new process, without this one's choice of kernel and ranks."""
    clean = {
        name: value
        for name, value in os.environ.items()
        if name != blas.VARIABLE and not name.startswith(("OMPI_COMM", "PMI", "PMIX"))
    }
    return subprocess.run(
        [sys.executable, "-c", program],
        env=clean | environment,
        capture_output=True,
        text=True,
        check=True,
    )


@pytest.mark.parametrize(
    ("flags", "core"),
    [
        (AVX512, "SkylakeX"),
        (AVX512 - {"avx512vl"}, "Haswell"),
        (AVX2, "Haswell"),
        ({"avx2"}, None),
        ({"sse4_2"}, None),
        (set(), None),
    ],
)
def test_kernel_follows_the_processors_flags(flags, core):
    assert blas.suitable_core(flags, machine="x86_64") == core


def test_kernel_is_left_to_openblas_on_other_processors():
    assert blas.suitable_core(AVX512, machine="aarch64") is None


def test_a_kernel_that_the_user_chose_stays():
    program = "import morphing_wing, os; print(os.environ['OPENBLAS_CORETYPE'])"
    assert run_python(program, OPENBLAS_CORETYPE="Haswell").stdout.strip() == "Haswell"


def test_petsc_runs_the_suitable_kernel_after_importing_morphing_wing():
    core = blas.suitable_core(blas.cpu_flags())
    program = (
        "from morphing_wing import blas; from petsc4py import PETSc; used = blas.describe();"
        "print(used['library'], used['core'])"
    )
    library, kernel = run_python(program).stdout.split()
    if core is None or "openblas" not in library:
        pytest.skip("no OpenBLAS, or no x86 processor with AVX2")
    assert kernel == core


def test_one_sentence_warns_of_the_fallback_kernel_loaded_before():
    if blas.suitable_core(blas.cpu_flags()) is None:
        pytest.skip("no x86 processor with AVX2")
    program = LOADED_BEFORE + "morphing_wing._blas.check()"
    outcome = run_python(program, OPENBLAS_CORETYPE="Prescott")
    assert outcome.stderr.count("RuntimeWarning") == 1
    assert "import morphing_wing before numpy" in outcome.stderr


def test_ranks_other_than_the_first_do_not_warn():
    program = LOADED_BEFORE
    outcome = run_python(program, OPENBLAS_CORETYPE="Prescott", PMI_RANK="1")
    assert "RuntimeWarning" not in outcome.stderr


def test_reference_blas_is_recognised_and_warned_of():
    folder = next(Path("/usr/lib").glob("*/blas/libblas.so.3"), Path()).parent
    if folder == Path():
        pytest.skip("Debian's reference BLAS is not installed")
    program = (
        "import ctypes; ctypes.CDLL('libblas.so.3'); from morphing_wing import blas;"
        "print(blas.describe()['core'])"
    )
    outcome = run_python(program, LD_LIBRARY_PATH=str(folder))
    assert outcome.stdout.strip() == blas.REFERENCE
    assert outcome.stderr.count("RuntimeWarning") == 1
    assert "libopenblas0-serial" in outcome.stderr


def test_the_blas_in_use_is_not_a_slow_one():
    from petsc4py import PETSc  # noqa: F401  loads it

    assert blas.complaint(blas.describe(), blas.cpu_flags()) == ""
