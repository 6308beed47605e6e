"""Table 3 has the same figures on any number of ranks; rank 0 writes them."""

import numpy as np
from mpi4py import MPI

from morphing_wing.table3 import table3


def test_table_3_is_the_same(tmp_path):
    together, alone = (table3(["draft"], ["flush"], comm) for comm in (MPI.COMM_WORLD,
                                                                       MPI.COMM_SELF))
    many, one = together.table(), alone.table()
    for name in ("chord_angle_deg", "fitted_torque_Nmm", "energy_Nmm"):
        np.testing.assert_allclose(many[name], one[name], rtol=1e-8, err_msg=name)
    folder = MPI.COMM_WORLD.bcast(tmp_path)
    together.save(folder)
    assert (folder / "table3.png").exists()
