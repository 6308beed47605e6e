"""The rib as a solid: against the frame, linearity, balance, rigid rotation, tangents, stress."""

from dataclasses import replace

import numpy as np
import pytest
from mpi4py import MPI

from morphing_wing import compat, solid_rib
from morphing_wing.errors import InputError
from morphing_wing.geometry.rib import RibGeometry
from morphing_wing.limits import Limits
from morphing_wing.rib import Rib

SHORT = replace(RibGeometry.validation("square", bosses=True), n_cells=2)
COARSE = 6


@pytest.fixture(autouse=True)
def coarse(monkeypatch):
    """Let every solid be coarse."""
    monkeypatch.setitem(solid_rib.AROUND, "standard", COARSE)


def solid(geometry=SHORT):
    return Rib(geometry, fidelity="standard", comm=MPI.COMM_SELF)


def slope(rib):
    return rib.bend(torque=1.0)[-1].measures["chord_angle_deg"]


@pytest.mark.quick
@pytest.mark.parametrize("geometry", [
    SHORT, replace(RibGeometry.validation("flush"), n_cells=2)], ids=["square", "flush"])
def test_a_coarse_solid_turns_as_far_as_the_frame_within_six_percent(geometry):
    assert slope(solid(geometry)) == pytest.approx(slope(Rib(geometry)), rel=0.06)


@pytest.mark.quick
def test_angle_is_linear_in_the_moment_up_to_45_degrees_in_one_step():
    rib = solid()
    first = slope(rib)
    path = rib.bend(torque=45.0 / first)
    assert [state.requested for state in path] == [True]
    assert path[-1].newton_iterations <= 10
    # Two cells of 22 degrees each bend more than cells of longer ribs do at that angle.
    assert path[-1].measures["chord_angle_deg"] == pytest.approx(45.0, rel=0.01)
    assert path[-1].energy_Nmm == pytest.approx(path[-1].external_work_Nmm, rel=1e-3)
    assert path[-1].negative_pivots == 0


@pytest.mark.quick
def test_a_rigid_rotation_by_90_degrees_stores_nothing():
    rib = solid()
    body, ends = rib.ribs.body, rib.ribs.ends
    x = body.function.function_space.tabulate_dof_coordinates()
    turned = x @ np.array([[0.0, -1.0, 0.0], [1.0, 0.0, 0.0], [0.0, 0.0, 1.0]]).T
    body.function.x.array[:] = (turned - x).ravel()
    tail = np.array([SHORT.length, 0.0, 0.0])
    motion = np.concatenate([[-tail[0], tail[0], 0.0], [0.0, 0.0, np.pi / 2]])
    ends.motion.x.array[:] = motion
    seen = ends.block.function.x.array.reshape(-1, 6)
    seen[np.unique(body.faces.cells("tail_0"))] = motion
    energies = [compat.assemble_scalar(MPI.COMM_SELF, compat.form(part.energy))
                for part in rib.ribs.parts]
    bent = solid().bend(torque=1.0)[-1].energy_Nmm
    assert np.abs(energies).max() < 1e-12 * bent


@pytest.mark.quick
def test_tangent_is_the_derivative_of_the_residual_in_a_bent_state():
    rib = solid()
    rib.bend(torque=20.0)
    rib.before_tangent(0)
    system = rib.system
    tangent = system.tangent()
    x, step = system.x.duplicate(), system.x.duplicate()
    system.push(x)
    step.setRandom()
    step.array[~system.free] = 0.0
    low, high, product = (system.x.duplicate() for _ in range(3))
    tangent.mult(step, product)
    errors = []
    for size in (1e-3, 5e-4):
        at = x.copy()
        at.axpy(size, step)
        system.residual(at, high)
        at.axpy(-2.0 * size, step)
        system.residual(at, low)
        difference = (high.array - low.array) / (2.0 * size)
        errors.append(np.linalg.norm((difference - product.array)[system.free]))
    assert errors[0] < 0.05 * np.linalg.norm(product.array[system.free])
    assert errors[0] / errors[1] == pytest.approx(4.0, rel=0.1)


def test_any_split_of_the_moment_ends_in_the_same_state():
    at_once = solid().bend(torque=30.0)[-1].measures["chord_angle_deg"]
    slowly = solid().bend(torque=[5.0, 10.0, 20.0, 30.0])[-1].measures["chord_angle_deg"]
    assert slowly == pytest.approx(at_once, rel=1e-8)


def test_a_cable_turns_it_as_it_turns_the_frame():
    geometry = replace(SHORT, n_cells=3)
    angles = [rib.pull(cable=0.5)[-1].measures["chord_angle_deg"]
              for rib in (solid(geometry), Rib(geometry))]
    assert angles[0] == pytest.approx(angles[1], rel=0.05)


def test_mass_is_that_of_the_half_and_stress_grows_with_the_moment():
    rib = solid()
    volume = rib.ribs.body.grid.volume()
    assert sum(mass.sum() for mass in rib.masses()) == pytest.approx(
        3.0 * 1180e-9 * volume, rel=1e-6)
    rib.watch.append(Limits(rib))
    stress = [s.measures["rib_stress_MPa"] for s in rib.bend(torque=[5.0, 10.0]) if s.requested]
    assert stress[1] == pytest.approx(2.0 * stress[0], rel=0.05)
    frame = Rib(SHORT)
    frame.watch.append(Limits(frame))
    assert stress[1] == pytest.approx(
        frame.bend(torque=10.0)[-1].measures["rib_stress_MPa"], rel=0.5)


@pytest.mark.quick
def test_a_density_of_ones_own_replaces_the_fidelitys_and_has_no_measured_error():
    own = Rib(SHORT, fidelity="standard", comm=MPI.COMM_SELF, around=4)
    assert own.dofs < solid().dofs
    assert own.error_estimate is None
    for fidelity, around in (("draft", 6), ("instant", 6), ("standard", 3), ("standard", 6.5)):
        with pytest.raises(InputError, match="around = "):
            Rib(SHORT, fidelity=fidelity, around=around)


def test_a_solid_is_resumed_where_it_stood(tmp_path):
    through = solid().bend(torque=[5.0, 10.0])[-1].measures["chord_angle_deg"]
    solid().bend(torque=5.0, restart=tmp_path)
    path = solid().bend(torque=[5.0, 10.0], resume=tmp_path)
    assert len(path) == 2
    assert path[-1].measures["chord_angle_deg"] == pytest.approx(through, rel=1e-9)


@pytest.mark.quick
def test_parts_that_collide_are_named_before_any_meshing():
    with pytest.raises(InputError, match="crossing_angle = 47 degrees: neighbouring shafts"):
        solid(replace(RibGeometry.prototype(6), crossing_angle=47.0))
