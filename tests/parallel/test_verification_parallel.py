"""Problems with known answers hold on all ranks together."""

import pytest
from mpi4py import MPI

from morphing_wing.verification import PROBLEMS

pytestmark = pytest.mark.quick


@pytest.mark.parametrize("name", ["patch", "balance", "elastica", "land"])
def test_numbers_hold_on_all_ranks_together(name):
    checks = list(PROBLEMS[name].run(MPI.COMM_WORLD))
    assert checks and [check.name for check in checks if not check.holds] == []
