"""The compliance of a rib's tail: against exact frames and beams, differences, and symmetries."""

from dataclasses import dataclass, replace

import numpy as np
import pytest
from mpi4py import MPI

from morphing_wing import condensed_rib
from morphing_wing.errors import InputError
from morphing_wing.geometry.frame import Frame, local_axes
from morphing_wing.geometry.rib import KINDS, RibGeometry
from morphing_wing.geometry.section import Rectangle
from morphing_wing.materials import Elastic
from morphing_wing.rib import Rib
from morphing_wing.rib_stiffness import rib_stiffness, stiffness_table, tail_compliance
from tests.studies.exact_frame import exact_compliance

pytestmark = pytest.mark.quick
RESIN = Elastic(2500.0, 0.35)
SQUARE = RibGeometry.validation("square")
IN_PLANE, OUT_OF_PLANE = (0, 1, 5), (2, 3, 4)


def stiffness(geometry):
    return rib_stiffness(geometry, RESIN, MPI.COMM_SELF)


@dataclass(frozen=True)
class StraightBar(RibGeometry):
    """In place of a rib one bar of 2 x 3 mm between root and tail."""

    def frame(self):
        points = np.array([[x, 0.0, 0.0] for x in (0.0, 0.2, 0.8, 1.0)]) * [self.length, 1, 1]
        bars = np.array([[0, 1], [1, 2], [2, 3]])
        kinds = np.array([KINDS.index(kind) for kind in ("root", "shaft", "tail")])
        section = Rectangle(width=2.0, depth=3.0)
        return Frame(points, bars, kinds, KINDS, local_axes(points, bars),
                     (dict.fromkeys(KINDS, section),), np.zeros(3, int), np.array([0]),
                     np.array([3]))


def test_a_straight_bar_has_the_compliance_of_timoshenko():
    bar = StraightBar(6.5, 1.2, 1.5, 5.4, 90.0, 6)
    found, L = stiffness(bar), bar.length
    EA, GA2, GA3, GJ, EI2, EI3 = Rectangle(2.0, 3.0).stiffness(RESIN.E, RESIN.nu)
    assert (found.axial, found.torsion, found.spanwise_bending, found.chordwise_bending) == (
        pytest.approx((EA, GJ, EI2, EI3), rel=1e-9))
    soft = L**3 / (3 * EI3) + L / GA2, L**3 / (3 * EI2) + L / GA3
    assert found.against_force(np.array([90.0, 0.0])) == pytest.approx(np.reciprocal(soft), 1e-9)
    assert found.compliance[1, 5] == pytest.approx(L**2 / (2 * EI3), rel=1e-9)
    assert found.compliance[2, 4] == pytest.approx(-(L**2) / (2 * EI2), rel=1e-9)


@pytest.mark.parametrize("geometry", [
    SQUARE, replace(SQUARE, layers=2), RibGeometry.prototype(4, "square", bosses=True),
    replace(RibGeometry.prototype(3), layers=2), replace(SQUARE, n_cells=1),
], ids=["3.3", "3.3, two layers", "5.1, bosses", "5.1 flush, two layers", "one cell"])
def test_all_36_figures_are_those_of_an_exact_frame(geometry):
    exact = exact_compliance(geometry.frame(), RESIN)
    scale = np.sqrt(np.outer(np.diag(exact), np.diag(exact)))
    np.testing.assert_allclose(stiffness(geometry).compliance / scale, exact / scale, atol=1e-6)


@pytest.mark.parametrize("layers", [2, 3])
def test_compliance_is_symmetric_as_maxwell_and_betti_have_it(layers):
    coupling = stiffness(replace(SQUARE, layers=layers)).coupling
    np.testing.assert_allclose(coupling, coupling.T, atol=1e-8)


@pytest.mark.parametrize("layers", [2, 3])
def test_compliance_is_what_small_moments_and_pulls_move(layers):
    geometry, small = replace(SQUARE, layers=layers), 1e-3
    C = stiffness(geometry).compliance
    loads = [lambda rib, s: rib.bend(torque=s * small)]
    for axis in range(3):
        # Far away, so that the pull keeps its direction.
        loads.append(lambda rib, s, axis=axis: rib.pull(small, guide=s * 1e6 * np.eye(3)[axis]))
    for load, column in zip(loads, (-C[:, 5], *C[:, :3].T), strict=True):
        sides = []
        for sign in (1.0, -1.0):
            rib = Rib(geometry, RESIN, comm=MPI.COMM_SELF)
            assert load(rib, sign).converged
            sides.append(rib.ribs.end_values("tail", 0))
        difference = (sides[0] - sides[1]) / (2.0 * small)
        size = np.sqrt(np.diag(C)) * np.linalg.norm(column / np.sqrt(np.diag(C)))
        np.testing.assert_allclose(difference / size, column / size, atol=1e-5)


def test_the_square_rib_of_section_3_3_turns_by_1_902_degrees_per_Nmm():
    found = stiffness(SQUARE)
    assert found.degrees_per_Nmm == pytest.approx(1.902, abs=5e-4)
    assert found.chordwise_bending == pytest.approx(
        SQUARE.length / np.radians(found.degrees_per_Nmm))


def test_stiffness_against_a_force_turns_smoothly_from_span_to_height():
    found = stiffness(replace(SQUARE, layers=2))
    around = found.against_force(np.arange(0.0, 361.0, 45.0))
    assert around[[0, 2]] == pytest.approx(1.0 / np.diag(found.compliance)[[2, 1]])
    np.testing.assert_allclose(around[:5], around[4:])
    mixed = found.compliance[1:3, 1:3].sum() / 2
    assert around[1] == pytest.approx(1.0 / mixed)


def test_three_layers_keep_what_is_in_the_plane_in_it_and_two_do_not():
    three, two = (stiffness(replace(SQUARE, layers=n)).coupling for n in (3, 2))
    assert np.abs(three[np.ix_(IN_PLANE, OUT_OF_PLANE)]).max() < 1e-7
    assert two[0, 3] == pytest.approx(-0.374, abs=0.001)  # a pull along the chord twists the tail
    assert two[1, 2] == pytest.approx(0.0125, abs=0.001)  # a force downwards moves it sideways
    assert np.abs(two[np.ix_((0, 3), (1, 2, 4, 5))]).max() < 1e-7  # half a turn about x


def test_two_layers_leave_the_plane_at_large_rotations_and_three_do_not():
    for layers, torque in ((3, 23.7), (2, 12.9)):
        bent = Rib(replace(SQUARE, layers=layers), RESIN, comm=MPI.COMM_SELF)
        angle = bent.bend(torque=torque)[-1].measures["chord_angle_deg"]
        assert angle == pytest.approx(45.0, abs=0.1)
        tail = bent.ribs.end_values("tail", 0)
        if layers == 3:
            assert np.abs(tail[list(OUT_OF_PLANE)]).max() < 1e-9
        else:
            assert tail[2] == pytest.approx(-0.049, abs=0.001)
            assert np.degrees(tail[3]) == pytest.approx(0.40, abs=0.01)


def test_the_third_layer_makes_the_rib_stiffer_spanwise_than_chordwise():
    three, two = (stiffness(replace(SQUARE, layers=n)) for n in (3, 2))
    assert (three.anisotropy, two.anisotropy) == pytest.approx((1.474, 0.838), abs=1e-3)
    assert three.anisotropy_of_full_bar == pytest.approx(5.58, abs=0.01)


def test_condensed_cells_are_stiffer_spanwise_than_a_frame_as_whole_solids_are(monkeypatch):
    monkeypatch.setitem(condensed_rib.AROUND, "cell", 6)
    cell, frame = (rib_stiffness(SQUARE, RESIN, MPI.COMM_SELF, kind) for kind in ("cell", "draft"))
    assert cell.chordwise_bending == pytest.approx(frame.chordwise_bending, rel=0.03)
    assert cell.anisotropy == pytest.approx(1.76, rel=0.03)  # a whole solid's, bench/
    with pytest.raises(InputError, match="fidelity = 'standard': must be one of draft, cell"):
        rib_stiffness(SQUARE, RESIN, MPI.COMM_SELF, "standard")


def test_rotation_by_an_end_moment_grows_linearly_with_the_cells():
    turned = [stiffness(replace(SQUARE, n_cells=n)).degrees_per_Nmm for n in (4, 8, 12)]
    first, second = np.diff(turned)
    assert second == pytest.approx(first, rel=1e-4)


def test_table_has_a_row_a_rib_and_units_in_its_columns():
    table = stiffness_table({"a": SQUARE, "b": replace(SQUARE, layers=2)}, RESIN, MPI.COMM_SELF)
    assert list(table.index) == ["a", "b"]
    assert table.loc["a", "EI_y_Nmm2"] / table.loc["a", "EI_z_Nmm2"] == pytest.approx(
        table.loc["a", "EI_y/EI_z"])
    assert table.loc["b", "k_y_N_per_mm"] == pytest.approx(
        stiffness(replace(SQUARE, layers=2)).against_force(90.0))


def test_in_a_bent_state_it_is_the_slope_of_the_path_there():
    rib = Rib(SQUARE, RESIN, comm=MPI.COMM_SELF)
    rib.bend(torque=20.0)
    slope = tail_compliance(rib)[5, 5]
    turned = [rib.bend(torque=m)[-1].measures["chord_angle_deg"] for m in (20.01, 19.99)]
    assert np.degrees(slope) == pytest.approx((turned[0] - turned[1]) / 0.02, rel=1e-5)
