"""The stiffness of a rib, and how it leaves its plane, are the same on all ranks."""

from dataclasses import replace

import numpy as np
import pytest
from mpi4py import MPI

from morphing_wing.geometry.rib import RibGeometry
from morphing_wing.out_of_plane import out_of_plane
from morphing_wing.rib import Rib
from morphing_wing.rib_stiffness import rib_stiffness

# Rounding of the factorisation: arms and sockets are a thousand times as stiff as pivots.
RELATIVE = 1e-7


@pytest.mark.quick
@pytest.mark.parametrize("layers", [2, 3])
def test_rib_stiffness_is_the_same(layers):
    geometry = replace(RibGeometry.validation("square"), layers=layers)
    together, alone = (rib_stiffness(geometry, comm=comm) for comm in
                       (MPI.COMM_WORLD, MPI.COMM_SELF))
    np.testing.assert_allclose(together.coupling, alone.coupling, atol=RELATIVE)
    np.testing.assert_allclose(
        np.diag(together.compliance), np.diag(alone.compliance), rtol=RELATIVE)
    everywhere = MPI.COMM_WORLD.allgather(together.compliance)
    assert all(np.array_equal(found, everywhere[0]) for found in everywhere)


@pytest.mark.quick
def test_how_a_rib_leaves_its_plane_is_the_same():
    geometry = replace(RibGeometry.validation("square"), layers=2)
    together, alone = (out_of_plane(Rib(geometry, comm=comm).bend(torque=10.0)) for comm in
                       (MPI.COMM_WORLD, MPI.COMM_SELF))
    np.testing.assert_allclose(together, alone, atol=1e-8)
