"""Rank 0 reads, fits and writes a calibration; the others wait, and fail with it."""

import json

import pytest
from mpi4py import MPI

from morphing_wing.cli import main

pytestmark = pytest.mark.quick


def test_a_calibration_is_written_once_and_says_so_once(tmp_path, capsys):
    comm = MPI.COMM_WORLD
    folder = comm.bcast(tmp_path)
    assert main(["calibrate", "dragon_skin_30", "--max-stretch", "3", "--out", str(folder)]) == 0
    summary = json.loads((folder / "summary.json").read_text())
    assert summary["coefficients_MPa"] == pytest.approx([0.1032, 0.00508], rel=1e-3)
    assert ("results are in" in capsys.readouterr().out) == (comm.rank == 0)


def test_all_ranks_refuse_a_file_that_is_not_there(tmp_path, capfd):
    assert main(["calibrate", str(tmp_path / "none.csv")]) == 2
    assert ("cannot be read" in capfd.readouterr().err) == (MPI.COMM_WORLD.rank == 0)
