"""What goes wrong with a case on one rank alone is told on all of them."""

import pytest
from mpi4py import MPI

from morphing_wing.studies import case as module
from morphing_wing.studies.case import Case, run_case

pytestmark = pytest.mark.quick


def test_a_failure_of_the_last_rank_is_what_all_ranks_find(monkeypatch):
    comm = MPI.COMM_WORLD
    if comm.rank == comm.size - 1:
        monkeypatch.setattr(module, "found_outputs", None)
    found = run_case(Case.of("spar-n4", {"fidelity": "instant"}), ["span_angle_deg"], comm)
    assert found["stopped"].startswith("unexpected TypeError")
    assert found["span_angle_deg"] != found["span_angle_deg"]
