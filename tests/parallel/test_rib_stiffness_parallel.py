"""The stiffness of a rib is the same on any number of ranks, and on each of them."""

from dataclasses import replace

import numpy as np
import pytest
from mpi4py import MPI

from morphing_wing.geometry.rib import RibGeometry
from morphing_wing.rib_stiffness import rib_stiffness


@pytest.mark.quick
@pytest.mark.parametrize("layers", [2, 3])
def test_rib_stiffness_is_the_same(layers):
    geometry = replace(RibGeometry.validation("square"), layers=layers)
    together, alone = (rib_stiffness(geometry, comm=comm) for comm in
                       (MPI.COMM_WORLD, MPI.COMM_SELF))
    np.testing.assert_allclose(together.coupling, alone.coupling, atol=1e-9)
    np.testing.assert_allclose(
        np.diag(together.compliance), np.diag(alone.compliance), rtol=1e-8)
    everywhere = MPI.COMM_WORLD.allgather(together.compliance)
    assert all(np.array_equal(found, everywhere[0]) for found in everywhere)
