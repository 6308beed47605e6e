"""What every parallel test stands on: mpirun, mpi4py and DOLFINx speak of the same ranks."""

import os
import time

import numpy as np
import pytest
from dolfinx import mesh
from mpi4py import MPI

from morphing_wing import compat

pytestmark = pytest.mark.quick


def test_mpirun_and_mpi4py_belong_to_the_same_mpi():
    started = os.environ.get("OMPI_COMM_WORLD_SIZE") or os.environ.get("PMI_SIZE") or "1"
    assert MPI.COMM_WORLD.size == int(started)


def test_every_cell_is_owned_by_one_rank():
    cube = mesh.create_unit_cube(MPI.COMM_WORLD, 4, 4, 4, mesh.CellType.hexahedron)
    owned = cube.topology.index_map(cube.topology.dim).size_local
    assert MPI.COMM_WORLD.allreduce(owned) == 4**3
    assert owned > 0


def test_sums_are_the_same_on_all_ranks():
    totals = MPI.COMM_WORLD.allgather(MPI.COMM_WORLD.allreduce(0.1 * (MPI.COMM_WORLD.rank + 1)))
    np.testing.assert_array_equal(totals, totals[0])


def test_ranks_that_still_build_alone_do_not_lock_the_others_out():
    ends = np.array([[0.0, 0.0, 0.0], [1.0, 0.0, 0.0]])
    time.sleep(0.3 * (MPI.COMM_WORLD.rank > 0))
    for comm in (MPI.COMM_SELF, MPI.COMM_WORLD):  # rank 0 is at the second one first
        built = compat.create_mesh(comm, "interval", np.array([[0, 1]]), ends)
        assert comm.allreduce(built.topology.index_map(1).size_local) == 1
