"""How ribs leave their plane: a table, what the moment is then, and the pictures."""

from dataclasses import replace

import numpy as np
import pytest
from mpi4py import MPI
from scipy.spatial.transform import Rotation

from morphing_wing.geometry.rib import RibGeometry
from morphing_wing.out_of_plane import moment_in_space, out_of_plane
from morphing_wing.out_of_plane_picture import draw
from morphing_wing.rib import Rib
from morphing_wing.rib_stiffness import rib_stiffness
from morphing_wing.rib_stiffness_picture import figure

pytestmark = pytest.mark.quick
SQUARE = RibGeometry.validation("square")
TWO = replace(SQUARE, layers=2)


def rib(geometry):
    return Rib(geometry, comm=MPI.COMM_SELF)


@pytest.mark.parametrize("theta", [[0.0, 0.0, -0.8], [0.3, -0.2, 1.1], [1e-6, 0.0, 2e-6]])
def test_moment_in_space_works_on_turns_as_its_potential_falls(theta):
    theta, small = np.array(theta), 1e-6
    for step in small * np.eye(3):
        ahead, behind = (Rotation.from_rotvec(theta + sign * step) for sign in (1.0, -1.0))
        turn = (ahead * behind.inv()).as_rotvec()
        assert moment_in_space(theta) @ turn == pytest.approx(2.0 * step[2], abs=1e-11)


def test_twist_of_two_layers_grows_as_the_square_of_the_moment_and_drift_changes_its_sign():
    down, half, up = (out_of_plane(rib(TWO).bend(torque=m)).iloc[-1] for m in (8.0, 4.0, -8.0))
    assert down["twist_deg"] == pytest.approx(up["twist_deg"], rel=1e-6)
    assert down["twist_deg"] == pytest.approx(4.0 * half["twist_deg"], rel=0.01)
    assert down["sideways_mm"] == pytest.approx(-up["sideways_mm"], rel=1e-6)
    assert 0.0 < down["moment_tilt_deg"] < 0.1


def test_a_pull_along_the_chord_twists_two_layers_and_not_three():
    pulled = {layers: out_of_plane(rib(replace(SQUARE, layers=layers)).pull(
        1.0, guide=(100.0, 0.0, 0.0))).iloc[-1] for layers in (2, 3)}
    assert pulled[2]["twist_deg"] == pytest.approx(-2.87, abs=0.01)
    assert abs(pulled[3]["twist_deg"]) < 1e-9 and pulled[3]["largest_mm"] < 1e-3
    assert np.isnan(pulled[2]["moment_tilt_deg"])


def test_polar_picture_has_a_closed_curve_a_rib_and_a_matrix_a_title():
    ribs = {name: rib_stiffness(g, comm=MPI.COMM_SELF) for name, g in
            (("three", SQUARE), ("two", TWO))}
    made = figure(ribs, ribs)
    polar, *matrices = made.get_axes()
    assert [line.get_label() for line in polar.lines] == ["three", "two"]
    for line, found in zip(polar.lines, ribs.values(), strict=True):
        radius = 10.0 ** line.get_ydata()
        assert radius[0] == pytest.approx(radius[-1])
        assert radius[90] == pytest.approx(found.against_force(90.0) * SQUARE.length**3 / 3.0)
    assert [axes.get_title() for axes in matrices] == ["three", "two"]


def test_shapes_and_curves_are_drawn(tmp_path):
    geometries = {"three": SQUARE, "two": TWO}
    draw({name: rib(g).pull(0.1) for name, g in geometries.items()},
         {name: rib(g).bend(1.0) for name, g in geometries.items()}, tmp_path / "picture.png")
    assert (tmp_path / "picture.png").stat().st_size > 20_000
