"""Rank 0 writes what a table's study found; ribs themselves are in `test_scenes_parallel`."""

import numpy as np
import pytest
from mpi4py import MPI

from morphing_wing.cli import main
from morphing_wing.table3 import table3

pytestmark = pytest.mark.quick


def test_table_3_is_the_same_and_written_once(tmp_path, capsys):
    comm = MPI.COMM_WORLD
    folder = comm.bcast(tmp_path)
    assert main(["paper", "table3", "--fidelity", "instant", "--out", str(folder)]) == 0
    assert (folder / "table3.png").exists()
    assert ("results are in" in capsys.readouterr().out) == (comm.rank == 0)
    moments = comm.allgather(table3(["draft"], ["flush"]).table()["fitted_torque_Nmm"].to_numpy())
    alone = table3(["draft"], ["flush"], MPI.COMM_SELF).table()["fitted_torque_Nmm"].to_numpy()
    np.testing.assert_allclose(moments, np.broadcast_to(alone, np.shape(moments)), rtol=1e-8)
