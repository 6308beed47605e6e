"""The rib as a frame: stiffness, linearity, cable, symmetry and energy balance.

References: frames with exact Timoshenko members, E = 2500 MPa, nu = 0.35, six cells; solids with
curved second-order tetrahedra for the remark on bosses.
"""

import numpy as np
import pytest
from mpi4py import MPI

from morphing_wing.errors import InputError
from morphing_wing.geometry.rib import RibGeometry
from morphing_wing.materials import Elastic
from morphing_wing.rib import Rib

pytestmark = pytest.mark.quick
RESIN = Elastic(2500.0, 0.35)


def rib(geometry):
    return Rib(geometry, RESIN, comm=MPI.COMM_SELF)


def degrees_per_Nmm(geometry):
    return rib(geometry).bend(torque=1.0)[-1].measures["chord_angle_deg"]


@pytest.mark.parametrize(
    ("geometry", "frame"),
    [
        (RibGeometry.validation("square"), 1.901),
        (RibGeometry.validation("flush"), 1.028),
        (RibGeometry.prototype(6, "square"), 3.03),
        (RibGeometry.prototype(6, "flush"), 1.322),
    ],
    ids=["3.3-square", "3.3-flush", "5.1-square", "5.1-flush"],
)
def test_degrees_per_newton_millimetre_of_end_moment(geometry, frame):
    assert degrees_per_Nmm(geometry) == pytest.approx(frame, rel=0.002)


def test_bosses_bring_the_square_section_within_five_percent_of_the_solid():
    assert degrees_per_Nmm(RibGeometry.prototype(6, "square", bosses=True)) == pytest.approx(
        2.397, rel=0.02)
    assert degrees_per_Nmm(RibGeometry.validation("square", bosses=True)) == pytest.approx(
        1.86, rel=0.05)


@pytest.mark.parametrize("section", ["square", "flush"])
@pytest.mark.parametrize("preset", [RibGeometry.validation, lambda s: RibGeometry.prototype(6, s)],
                         ids=["3.3", "5.1"])
def test_angle_is_linear_in_the_moment_up_to_45_degrees(preset, section):
    bent = rib(preset(section))
    first = bent.bend(torque=0.1)[-1].measures["chord_angle_deg"] / 0.1
    path = bent.bend(torque=np.array([22.5, 45.0]) / first)
    for state in path:
        slope = state.measures["chord_angle_deg"] / state.load["torque_Nmm"]
        assert slope == pytest.approx(first, rel=0.005)
    assert path[-1].measures["chord_angle_deg"] == pytest.approx(45.0, rel=0.005)


def test_cable_on_a_prototype_rib_with_bosses():
    path = rib(RibGeometry.prototype(section="square", bosses=True)).pull(cable=[0.1, 0.2])
    angles = [state.measures["chord_angle_deg"] for state in path if state.requested]
    assert angles == pytest.approx([18.8, 33.3], rel=0.01)


def test_cable_pulls_down_as_the_equal_moment_at_small_load():
    geometry = RibGeometry.prototype()
    bare = rib(geometry)
    tiny = bare.pull(cable=1e-4)[-1].measures
    bare.pull(cable=0.0)
    moment = bare.bend(torque=1e-4)[-1].measures
    # Maxwell, Betti: deflection by a unit moment is rotation by a unit force.
    deflection = np.tan(np.radians(moment["chord_line_deg"])) * geometry.length
    assert np.radians(tiny["chord_angle_deg"]) == pytest.approx(deflection, rel=1e-4)


def test_a_cable_led_to_another_guide_under_tension_does_no_work_by_that():
    pulled = rib(RibGeometry.prototype())
    before = pulled.pull(cable=0.05)[-1]
    after = pulled.pull(cable=0.05, guide=(0.0, -1000.0, 0.0))[-1]
    gained = after.energy_Nmm - before.energy_Nmm
    assert after.external_work_Nmm - before.external_work_Nmm == pytest.approx(gained, rel=0.1)


def test_symmetric_layers_keep_the_tail_in_its_plane():
    bent = rib(RibGeometry.prototype(6, "square"))
    bent.bend(torque=20.0)
    tail = bent.ribs.end_values("tail", 0)
    assert np.abs(tail[[2, 3, 4]]).max() < 1e-9 * np.abs(tail).max()


def test_stored_energy_is_the_work_of_the_moment():
    state = rib(RibGeometry.validation()).bend(torque=[20.0, 40.0])[-1]
    assert state.energy_Nmm == pytest.approx(state.external_work_Nmm, rel=1e-4)


def test_large_steps_take_few_iterations_and_reach_the_state_of_small_ones():
    geometry = RibGeometry.prototype(6, "square")
    at_once = rib(geometry).bend(torque=30.0)
    slowly = rib(geometry).bend(torque=np.linspace(3.0, 30.0, 10))
    assert [state.requested for state in at_once] == [True]
    assert at_once[-1].newton_iterations <= 8
    assert at_once[-1].measures["chord_angle_deg"] == pytest.approx(
        slowly[-1].measures["chord_angle_deg"], rel=1e-8)


@pytest.mark.parametrize(
    ("call", "sentence"),
    [
        (lambda r: r.bend(torque=[1.0, np.nan]), "torque = "),
        (lambda r: r.pull(cable=-0.1), "cable = -0.1 N: must be 0 N or more"),
        (lambda r: r.pull(cable=0.1, guide=(0.0, 0.0)), "guide = "),
        (lambda r: r.pull(cable=0.1, guide=(0.0, 0.0, 0.0)), "guide = "),
    ],
)
def test_loads_that_cannot_be_are_refused(call, sentence):
    with pytest.raises(InputError) as refused:
        call(rib(RibGeometry.validation()))
    assert str(refused.value).startswith(sentence)


def test_unknown_fidelity_is_refused():
    with pytest.raises(InputError, match="fidelity = 'finest': must be one of instant, cell"):
        Rib(RibGeometry.validation(), fidelity="finest")
