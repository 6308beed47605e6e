"""Glue between ribs and elastomer: rigid feet, their stiffness, perfect glue."""

from dataclasses import replace

import numpy as np
import pytest
from mpi4py import MPI

from morphing_wing import compat
from morphing_wing.wing import Wing
from tests.scenes.small_wing import GEOMETRY, NO_SKIN, actuated, move_elastomer, wing


def glue_and_rib_energy(scene):
    """Energy in N mm of glue and ribs for the functions' present values."""
    x = scene.system.x.duplicate()
    scene.system.push(x)
    scene.system.pull(x)  # hands the ribs' ends on to the glue
    return [compat.assemble_scalar(MPI.COMM_SELF, compat.form(owner.energy))
            for owner in (scene.glue, scene.ribs)]


def rigid_motion(points, angle):
    """Displacement of points that turn about an axis askew and move, and the rotation vector."""
    theta = angle * np.array([2.0, -1.0, 2.0]) / 3.0
    K = np.array([[0, -theta[2], theta[1]], [theta[2], 0, -theta[0]], [-theta[1], theta[0], 0]])
    R = np.eye(3) + np.sin(angle) / angle * K + (1 - np.cos(angle)) / angle**2 * K @ K
    return points @ (R - np.eye(3)).T + np.array([1.0, -2.0, 0.5]), theta


@pytest.mark.quick
@pytest.mark.parametrize("changes", [{}, NO_SKIN], ids=["foot and bond", "foot"])
def test_a_foot_takes_over_a_rigid_motion_of_the_elastomer_without_energy(changes):
    scene = wing(**changes)
    move_elastomer(scene, lambda points: rigid_motion(points, 0.7)[0])
    apart, _ = glue_and_rib_energy(scene)
    ribs = scene.ribs.function
    u, theta = rigid_motion(ribs.function_space.tabulate_dof_coordinates(), 0.7)
    ribs.x.array[:] = np.concatenate([u, np.broadcast_to(theta, u.shape)], axis=1).ravel()
    together, bending = glue_and_rib_energy(scene)
    assert apart > 1.0
    assert abs(together) < 1e-12 * apart
    assert abs(bending) < 1e-12 * apart


@pytest.mark.parametrize("fidelity", ["draft", "standard"])
def test_glue_is_as_stiff_as_the_area_of_the_foot_and_its_second_moment(fidelity):
    scene = Wing(replace(GEOMETRY, skin_thickness=None), fidelity=fidelity, comm=MPI.COMM_SELF)
    height, width = scene.geometry.foot()
    area = {0: width * height, 5: width * height**3 / 12.0}  # pulled along x, turned about z
    for component, expected in area.items():
        small = 1e-4
        scene.ribs.function.x.array[:] = 0.0
        scene.ribs.function.x.array.reshape(-1, 6)[:, component] = small
        energy, _ = glue_and_rib_energy(scene)
        found = energy / (0.5 * scene.geometry.glue_stiffness * small**2)
        assert found == pytest.approx(expected, rel=0.05)


def test_stiffer_glue_tends_to_perfect_glue_with_the_reciprocal_of_its_stiffness():
    found = [actuated(wing(**NO_SKIN, glue_stiffness=k), cable=0.1)[-1].measures
             for k in (50.0, 500.0, 5e3, 5e4, 5e5)]
    rotation = np.array([measures["rib_1_rotation_deg"] for measures in found])
    changes = -np.diff(rotation) / rotation[1:]
    assert (changes > 0).all() and (np.diff(changes) < 0).all()
    assert changes[-2] / changes[-1] == pytest.approx(10.0, rel=0.1)
    assert changes[-1] < 1e-3
