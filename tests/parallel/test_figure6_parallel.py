"""Figure 6 on several ranks: the bulge and the file of cases are those of one rank."""

import numpy as np
import pytest
from mpi4py import MPI

from morphing_wing.bulge import Bulge
from morphing_wing.cli import main
from morphing_wing.errors import InputError
from morphing_wing.figure5_curves import Curve
from morphing_wing.figure6.cases import read_cases, write_cases
from morphing_wing.figure6.points import PANELS
from morphing_wing.figure6.result import Figure6
from morphing_wing.geometry.spar import SparGeometry
from morphing_wing.rib import Rib
from morphing_wing.solved_case import solved_case
from morphing_wing.spar import Spar
from morphing_wing.table3 import rib_of

pytestmark = pytest.mark.quick


def test_a_bulge_is_the_same():
    def bulge(comm):
        spar = Spar(SparGeometry.validation(n_cells=2), fidelity="draft", comm=comm)
        spar.watch.append(Bulge(spar))
        return spar.inflate(upper=0.02)[-1].measures["bulge_mm"]

    found = MPI.COMM_WORLD.allgather(bulge(MPI.COMM_WORLD))
    assert min(found) > 0.01
    np.testing.assert_allclose(found, bulge(MPI.COMM_SELF), rtol=1e-8)


def test_solved_cases_are_kept_and_read_on_any_number_of_ranks(tmp_path):
    comm = MPI.COMM_WORLD
    folder = comm.bcast(tmp_path)
    levels = PANELS["rib"].middle
    study = Figure6(comm, {Curve("rib", "draft", "flush"): {tuple(levels.values()): solved_case(
        levels, "chord_angle_deg",
        lambda case: Rib(rib_of(case, "flush"), comm=comm).bend(torque=1.0))}})
    write_cases(study, folder)
    assert read_cases(comm, folder) == comm.bcast(study.solved)  # clocks differ, files do not
    with pytest.raises(InputError, match="must hold a solved.csv"):  # on every rank
        read_cases(comm, folder / "empty")


def test_rank_0_writes_and_tells(tmp_path, capsys):
    comm = MPI.COMM_WORLD
    folder = comm.bcast(tmp_path)
    assert main(["paper", "fig6", "--fidelity", "instant", "--out", str(folder)]) == 0
    assert (folder / "fig6.png").exists()
    assert ("results are in" in capsys.readouterr().out) == (comm.rank == 0)
