"""A spar under suction: the walls of its chambers meet, and stop each other if they are told to."""

import pytest
from mpi4py import MPI

from morphing_wing.chamber_contact import in_chambers
from morphing_wing.contact import ALIKE, CLOSE
from morphing_wing.geometry.hexmesh import geometric, two_sided, uniform
from morphing_wing.geometry.spar import SparGeometry, SparMeshing
from morphing_wing.spar import Spar

GEOMETRY = SparGeometry(
    cavity_length=6.0, wall_length=2.0, top_thickness=1.0, cavity_height=1.0, middle_thickness=2.0,
    side_thickness=2.0, cavity_width=12.0, n_cells=1)
MESHING = SparMeshing(
    cavity_length=two_sided(6, 1.5), wall_length=uniform(1), cavity_width=geometric(4, 0.7),
    side_thickness=uniform(1), top_thickness=uniform(2), cavity_height=uniform(2),
    middle_thickness=uniform(2))
SUCTIONS = [-0.002, -0.05]
"""In MPa: one under which the walls stay apart, one under which they meet."""


def spar(contact):
    """A spar of one flat chamber a row, and thin walls above and below it."""
    return Spar(GEOMETRY, meshing=MESHING, element="Q1 reduced", comm=MPI.COMM_SELF,
                contact=contact)


@pytest.fixture(scope="module")
def with_contact():
    return spar(contact=True).inflate(upper=SUCTIONS)


def test_without_contact_the_walls_of_a_chamber_pass_through_each_other():
    scene = spar(contact=False)
    path = scene.inflate(upper=-0.02)
    assert in_chambers(scene.body).smallest_gap() < -0.1
    assert "gap_mm" not in path[-1].measures


def test_with_contact_they_stop_each_other_and_the_way_goes_on(with_contact):
    path = with_contact
    assert path.converged, path.reason
    first, last = (state.measures for state in path if state.requested)
    assert (first["touching"], last["touching"]) == (0.0, 1.0)
    assert first["contact_force_N"] == 0.0 < last["contact_force_N"]
    assert last["penetration_mm"] < 0.01 * GEOMETRY.top_thickness
    assert last["gap_mm"] == pytest.approx(-last["penetration_mm"], rel=ALIKE, abs=CLOSE)


def test_contact_force_is_what_the_suction_leaves_to_the_floor(with_contact):
    path = with_contact
    suction = -path[-1].load["upper_MPa"]
    area = GEOMETRY.cavity_length * GEOMETRY.cavity_width
    force = path[-1].measures["contact_force_N"]
    # The part of the ceiling that lies on the floor is carried by it, the rest by the side walls.
    assert 0.2 * suction * area < force < suction * area


def test_before_they_meet_contact_changes_nothing(with_contact):
    path = with_contact
    without = spar(contact=False).inflate(upper=SUCTIONS[0])
    first = next(state for state in path if state.requested)
    assert first.energy_Nmm == pytest.approx(without[-1].energy_Nmm, rel=1e-7)
    assert first.measures["span_angle_deg"] == pytest.approx(
        without[-1].measures["span_angle_deg"], rel=1e-6)
