"""Figure 7 has the same figures on any number of ranks, stresses and stretches among them."""

import numpy as np
from mpi4py import MPI

from morphing_wing.figure7 import figure7
from tests.parallel.tolerances import WORK
from tests.scenes.small_wing import GEOMETRY, MESHING

TIMES = ["step_seconds"]


def test_figure_7_is_the_same(tmp_path):
    def run(comm):
        return figure7(pressures=[0.01], tensions=[0.02], skins=[False], geometry=GEOMETRY,
                       meshing=MESHING, comm=comm)

    together, alone = run(MPI.COMM_WORLD), run(MPI.COMM_SELF)
    many, one = (study.table().drop(columns=TIMES) for study in (together, alone))
    assert list(many) == list(one) and len(many) == 2
    for name in one.select_dtypes("number"):
        rtol = WORK if name == "external_work_Nmm" else 1e-7
        np.testing.assert_allclose(many[name], one[name], rtol=rtol, atol=1e-10, err_msg=name)
    folder = MPI.COMM_WORLD.bcast(tmp_path)
    together.save(folder)
    assert (folder / "fig7.png").exists()
