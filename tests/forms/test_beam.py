"""The beam's energy: rotations, objectivity, consistency, known solutions."""

import numpy as np
import pytest
import ufl
from dolfinx import fem
from mpi4py import MPI
from scipy.spatial.transform import Rotation

from morphing_wing import compat
from morphing_wing.angles import turned_x
from morphing_wing.forms.beam import rotation, tangent_map
from morphing_wing.forms.cable import cable_potential
from morphing_wing.frame import BeamFrame
from morphing_wing.geometry.rib import RibGeometry
from morphing_wing.materials import RESIN, Elastic
from morphing_wing.verification.cantilever import Cantilever

pytestmark = pytest.mark.quick


def evaluated(matrix):
    return np.array([[matrix[i, j](()) for j in range(3)] for i in range(3)], dtype=float)


def vectors():
    axis = np.array([0.36, -0.48, 0.8])
    return [angle * axis for angle in (1e-12, 1e-6, 1e-3, 0.5, np.pi, 4.0, 5.0)]


@pytest.mark.parametrize("theta", vectors(), ids=lambda v: f"{np.linalg.norm(v):.3g}")
def test_rotation_is_the_exponential_and_its_map_its_derivative(theta):
    R = Rotation.from_rotvec(theta).as_matrix()
    assert np.allclose(evaluated(rotation(ufl.as_vector(theta))), R, atol=1e-14)
    assert np.allclose(turned_x(theta), R[:, 0], atol=1e-14)
    T = evaluated(tangent_map(ufl.as_vector(theta)))
    direction, h = np.array([0.3, 0.7, -0.2]), 1e-5
    ends = [Rotation.from_rotvec(theta + sign * h * direction) for sign in (1, -1)]
    turn = (ends[0] * ends[1].inv()).as_rotvec() / (2 * h)
    assert np.allclose(T @ direction, turn, atol=1e-9)


def test_quarter_circle_under_end_moment():
    bar = Cantilever(MPI.COMM_SELF, 20)
    EI = 2500.0 / 12.0
    M = 2.0 * np.pi / 4.0 * EI / 10.0
    tail = bar.tip_after([0, 0, 0, 0, 0, M])
    radius = EI / M
    assert tail[:2] == pytest.approx([radius - 10.0, radius], rel=1e-3)
    assert tail[5] == pytest.approx(np.pi / 2, rel=1e-9)


def test_rolled_up_position_converges_with_order_above_3():
    EI = 2500.0 / 12.0
    M = 1.2 * np.pi * EI / 10.0
    exact = np.array([np.sin(1.2 * np.pi), 1.0 - np.cos(1.2 * np.pi)]) * EI / M - [10.0, 0.0]
    errors = []
    for n in (4, 8, 16):
        bar = Cantilever(MPI.COMM_SELF, n)
        tail = bar.tip_after([0, 0, 0, 0, 0, M])
        errors.append(np.linalg.norm(tail[:2] - exact))
    rates = np.log2(np.array(errors[:-1]) / errors[1:])
    assert np.all(rates > 3.0), (errors, rates)


@pytest.mark.parametrize("length", [5.0, 100.0, 2000.0])
def test_one_cell_bends_under_end_force_as_timoshenko_says_at_any_slenderness(length):
    bar = Cantilever(MPI.COMM_SELF, 1, length, material=Elastic(2500.0, 0.0))
    EI, GA = 2500.0 / 12.0, 5.0 / 6.0 * 1250.0
    P = 1e-6 * EI / length**2
    tail = bar.tip_after([0, -P, 0, 0, 0, 0])
    assert -tail[1] == pytest.approx(P * length**3 / (3 * EI) + P * length / GA, rel=1e-6)


def test_direction_of_the_bar_does_not_matter():
    turn = Rotation.from_rotvec([0.3, -1.1, 0.7])
    M, P = 20.0, 3.0
    tails = []
    for R in (Rotation.identity(), turn):
        bar = Cantilever(MPI.COMM_SELF, 8, direction=R.apply([1.0, 0.0, 0.0]))
        load = R.apply([[0.0, P, 1.0], [0.5 * M, 0.0, M]]).ravel()
        tails.append(R.inv().apply(bar.tip_after(load).reshape(2, 3)))
    assert np.allclose(tails[0], tails[1], atol=1e-7)


def rib_of_two_cells():
    return BeamFrame(MPI.COMM_SELF, RibGeometry.prototype(2).frame(), RESIN)


def rigidly_moved(beams, theta, shift):
    x = beams.function.function_space.tabulate_dof_coordinates()
    R = Rotation.from_rotvec(theta).as_matrix()
    values = np.hstack([x @ (R.T - np.eye(3)) + shift, np.tile(theta, (len(x), 1))])
    beams.function.x.array[:] = values.ravel()


@pytest.mark.parametrize("theta", vectors()[3:], ids=lambda v: f"{np.linalg.norm(v):.3g}")
def test_rigid_motion_of_a_whole_rib_is_free_of_stress(theta):
    beams = rib_of_two_cells()
    rigidly_moved(beams, theta, [1.0, -2.0, 3.0])
    v = ufl.TestFunction(beams.function.function_space)
    residual = np.zeros_like(beams.function.x.array)
    compat.assemble_vector(compat.form(ufl.derivative(beams.energy, beams.function, v)), residual)
    stiffest = beams.frame.stiffness(RESIN.E, RESIN.nu).max()
    assert compat.assemble_scalar(beams.comm, compat.form(beams.energy)) < 1e-20 * stiffest
    assert np.abs(residual).max() < 1e-12 * stiffest


def orders(error, steps=(1e-2, 5e-3, 2.5e-3)):
    errors = np.array([error(h) for h in steps])
    return np.log2(errors[:-1] / errors[1:])


@pytest.mark.parametrize("size", [0.0, 0.3])
def test_residual_and_tangent_are_derivatives_of_the_energy(size):
    beams = rib_of_two_cells()
    w = beams.function
    V = w.function_space
    v, dw = ufl.TestFunction(V), ufl.TrialFunction(V)
    residual_ufl = ufl.derivative(beams.energy, w, v)
    energy, residual = compat.form(beams.energy), compat.form(residual_ufl)
    direction = fem.Function(V)
    product = compat.form(ufl.action(ufl.derivative(residual_ufl, w, dw), direction))
    random = np.random.default_rng(1)
    start = size * random.standard_normal(len(w.x.array))
    direction.x.array[:] = random.standard_normal(len(start))

    def vector(form):
        out = np.zeros(len(start))
        compat.assemble_vector(form, out)
        return out

    w.x.array[:] = start
    e0, r0, Kd = compat.assemble_scalar(beams.comm, energy), vector(residual), vector(product)
    assert np.isfinite(Kd).all()
    d = direction.x.array.copy()

    def moved(h):
        w.x.array[:] = start + h * d
        return compat.assemble_scalar(beams.comm, energy), vector(residual)

    assert np.all(orders(lambda h: abs(moved(h)[0] - e0 - h * r0 @ d)) > 1.9)
    assert np.all(orders(lambda h: np.linalg.norm(moved(h)[1] - r0 - h * Kd)) > 1.9)


def test_tangent_correction_vanishes_where_the_last_iterate_is_the_present_one():
    beams = rib_of_two_cells()
    w = beams.function
    w.x.array[:] = 0.1 * np.random.default_rng(2).standard_normal(len(w.x.array))
    beams.iterate.accept()
    beams.iterate.before_tangent(0)
    direction = fem.Function(w.function_space)
    direction.x.array[:] = 1.0 + np.arange(len(w.x.array)) % 7
    form = compat.form(ufl.action(beams.tangent_correction, direction))

    def largest():
        out = np.zeros(len(w.x.array))
        compat.assemble_vector(form, out)
        return np.abs(out).max()

    assert largest() == 0.0
    w.x.array[:] *= 1.01
    beams.iterate.before_tangent(1)
    assert largest() > 1.0


def test_cable_pulls_with_its_tension_towards_the_guide():
    point, guide, h = np.array([3.0, 1.0, -2.0]), np.array([0.0, -1.0, 4.0]), 1e-5

    def potential(x):
        return cable_potential(2.5, ufl.as_vector(x), ufl.as_vector(guide))(())

    steps = h * np.eye(3)
    pull = [(potential(point - step) - potential(point + step)) / (2 * h) for step in steps]
    assert pull == pytest.approx(2.5 * (guide - point) / np.linalg.norm(guide - point), abs=1e-8)
