"""Kernels are compiled once, whoever else compiles and whatever a killed compiler has left."""

import fcntl
import os
import subprocess
import sys
import time

import pytest

SCRIPT = """
import morphing_wing
from mpi4py import MPI
import numpy as np
from morphing_wing import compat
import ufl
print("about to compile", flush=True)
mesh = compat.create_mesh(MPI.COMM_SELF, "interval", np.array([[0, 1]]), np.eye(3)[:2])
length = compat.form(compat.scalar_type(3.0) * ufl.dx(domain=mesh))
print(compat.assemble_scalar(MPI.COMM_SELF, length))
"""


def started(cache):
    """Start the script in a process of its own, with an own cache of kernels."""
    return subprocess.Popen([sys.executable, "-c", SCRIPT], text=True, stdout=subprocess.PIPE,
                            stderr=subprocess.PIPE, env=os.environ | {"XDG_CACHE_HOME": str(cache)})


def length(process):
    out, err = process.communicate(timeout=120)
    assert process.returncode == 0, err[-2000:]
    return float(out.splitlines()[-1])


@pytest.mark.quick
def test_what_a_killed_compiler_has_left_is_compiled_anew(tmp_path):
    assert length(started(tmp_path)) == pytest.approx(3.0 * 2**0.5)
    finished = sorted((tmp_path / "fenics").glob("*.c.cached"))
    assert finished
    for mark in finished:
        mark.unlink()
    for library in (tmp_path / "fenics").glob("*.so"):
        library.unlink()
    assert length(started(tmp_path)) == pytest.approx(3.0 * 2**0.5)
    assert sorted((tmp_path / "fenics").glob("*.c.cached")) == finished


@pytest.mark.quick
def test_a_program_waits_while_another_one_compiles(tmp_path):
    kernels = tmp_path / "fenics"
    kernels.mkdir()
    with open(kernels / "morphing-wing.lock", "w") as lock:
        fcntl.flock(lock, fcntl.LOCK_EX)
        waiting = started(tmp_path)
        assert waiting.stdout.readline() == "about to compile\n"
        time.sleep(2.0)  # several times what its kernel takes
        assert waiting.poll() is None and not list(kernels.glob("*.c"))
    assert length(waiting) == pytest.approx(3.0 * 2**0.5)
