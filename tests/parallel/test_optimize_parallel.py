"""An optimisation is the same on any number of ranks, and rank 0 writes it."""

import pandas as pd
import pytest
from mpi4py import MPI

from morphing_wing.cli import main
from morphing_wing.optimization.optimum import optimize
from morphing_wing.optimization.problem_file import parse_problem

pytestmark = pytest.mark.quick

RIB = {
    "scene": "rib-validation", "maximize": "chord_angle_deg", "rungs": ["instant", "draft"],
    "base": {"loads.torque": "10 N mm"}, "evaluations": 8,
    "variables": {"geometry.shaft_thickness": {"low": "1.1 mm", "high": "1.5 mm"},
                  "geometry.pivot_length": {"low": "5.0 mm", "high": "6.0 mm"}},
    "constraints": {"mass_g": {"max": "base"}},
}


def test_designs_are_those_of_one_rank():
    here = optimize(parse_problem(RIB), MPI.COMM_WORLD).table().drop(columns="seconds")
    alone = optimize(parse_problem(RIB), MPI.COMM_SELF).table().drop(columns="seconds")
    # Values of designs are rounded to six digits, so that what ranks round differently is the same.
    pd.testing.assert_frame_equal(here, alone, rtol=2e-5)


def test_rank_0_writes_and_a_bad_problem_ends_all_ranks(tmp_path, capsys):
    comm = MPI.COMM_WORLD
    folder = comm.bcast(tmp_path)
    problem = folder / "table2.toml"
    text = ('scene = "spar-validation"\nmaximize = "span_angle_deg"\nrungs = ["instant"]\n'
            '[base]\nloads.upper = "20 kPa"\n[variables]\n'
            'geometry.wall_length = { low = "2 mm", high = "2.4 mm" }\n')
    if comm.rank == 0:
        problem.write_text(text)
    comm.barrier()
    assert main(["optimize", str(problem), "--out", str(folder / "out")]) == 0
    assert ("results are in" in capsys.readouterr().out) == (comm.rank == 0)
    assert pd.read_csv(folder / "out" / "table.csv")["wall_length_mm"].max() == 2.4
    assert main(["optimize", "spars"]) == 2
    assert ("problem = 'spars'" in capsys.readouterr().err) == (comm.rank == 0)
