"""For all tests: MPI's manners. Ranks finish each test together, and fail together."""

import gc
import os
import sys

import pytest
from mpi4py import MPI

import morphing_wing  # noqa: F401  before DOLFINx and numpy: it prepares BLAS and MPI

os.environ.pop("COLUMNS", None)  # pytest-xdist's own: what is printed would be wrapped by it


@pytest.fixture(autouse=True)
def ranks_finish_together():
    """Free PETSc's objects at the same point on every rank: their destruction is collective."""
    yield
    if MPI.COMM_WORLD.size > 1:
        gc.collect()
        MPI.COMM_WORLD.Barrier()


@pytest.hookimpl(trylast=True)
def pytest_unconfigure(config):
    """End all ranks if one has failed: the others may wait for it in a collective call for ever."""
    failed = getattr(config, "some_test_failed", False)
    if failed and MPI.COMM_WORLD.size > 1:
        sys.stdout.flush()
        sys.stderr.flush()
        MPI.COMM_WORLD.Abort(1)


def pytest_sessionfinish(session, exitstatus):
    session.config.some_test_failed = exitstatus not in (0, pytest.ExitCode.NO_TESTS_COLLECTED)
