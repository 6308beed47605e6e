"""Pressure work is pressure times the enclosed deformed volume."""

import numpy as np
import pytest
import ufl
from dolfinx import fem
from mpi4py import MPI

from morphing_wing import compat
from morphing_wing.elastomer import Elastomer
from morphing_wing.elements import ELEMENTS
from morphing_wing.forms.pressure import enclosed_volume, pressure_work
from morphing_wing.geometry.hexmesh import swept_blocks, uniform
from morphing_wing.materials import DRAGON_SKIN_30
from tests.forms.bodies import distorted, hollow_box

pytestmark = pytest.mark.quick

A = np.array([[1.3, 0.4, -0.2], [0.1, 0.8, 0.3], [-0.2, 0.25, 1.1]])
SHIFT = np.array([3.0, -2.0, 0.5])


def body_of(grid, **options):
    return Elastomer(MPI.COMM_SELF, grid, DRAGON_SKIN_30, ELEMENTS["Q2 reduced"], **options)


def moved(body, position):
    """Set the displacement that takes X to ``position(X)`` (3, n)."""
    body.function.interpolate(lambda X: position(X) - X)


def value(body, functional):
    return compat.assemble_scalar(body.comm, compat.form(functional))


def half_hollow_box(mapping=None):
    """The half x >= 0 of a box whose middle is hollow; the cut goes through the chamber."""
    kind = np.ones((2, 3, 3), dtype=int)
    kind[0, 1, 1] = -1
    lines = (np.array([0.0, 1 / 6, 0.5]), uniform(3), uniform(3))

    def cut(midpoints, normals):
        return {"symmetry": (normals[:, 0] < 0) & (midpoints[:, 0] < 1e-9)}

    return swept_blocks(lines, kind, {1: "body", -1: "chamber"}, mapping, cut)


def chamber_of(mapping):
    """Volume of the chamber of a mapped hollow box, by the determinant on a fine grid."""
    n, h = 60, 1e-5
    s = 1 / 3 + (np.arange(n) + 0.5) / (3 * n)
    x = np.stack(np.meshgrid(s, s, s), axis=-1).reshape(-1, 3)
    columns = [(mapping(x + h * e) - mapping(x - h * e)) / (2 * h) for e in np.eye(3)]
    return np.linalg.det(np.stack(columns, axis=-1)).mean() / 27.0


def test_chamber_has_its_volume_before_it_is_deformed():
    body = body_of(hollow_box(None))
    assert value(body, body.chamber_volume("chamber")) == pytest.approx(1 / 27, rel=1e-13)


def test_affine_map_multiplies_the_volume_by_its_determinant():
    body = body_of(hollow_box())
    before = value(body, body.chamber_volume("chamber"))
    moved(body, lambda X: A @ X + SHIFT[:, None])
    after = value(body, body.chamber_volume("chamber"))
    assert after == pytest.approx(np.linalg.det(A) * before, rel=1e-12)


def test_rigid_motion_leaves_the_volume():
    body = body_of(hollow_box())
    before = value(body, body.chamber_volume("chamber"))
    Q, _ = np.linalg.qr(A)
    Q *= np.linalg.det(Q)
    moved(body, lambda X: Q @ X + SHIFT[:, None])
    assert value(body, body.chamber_volume("chamber")) == pytest.approx(before, rel=1e-12)


def test_shearing_quadratically_leaves_the_volume():
    body = body_of(hollow_box(None))
    moved(body, lambda X: X + np.stack([0.8 * X[1] ** 2, 0.3 * X[2] ** 2, 0.0 * X[0]]))
    assert value(body, body.chamber_volume("chamber")) == pytest.approx(1 / 27, rel=1e-12)


def test_nonlinear_map_gives_the_integral_of_its_determinant():
    body = body_of(hollow_box(None))
    # x = X (1 + X), y = Y (1 + Z / 2): det = (1 + 2 X) (1 + Z / 2).
    moved(body, lambda X: np.stack([X[0] * (1 + X[0]), X[1] * (1 + X[2] / 2), X[2]]))
    expected = (1 + 2 * 0.5) * (1 + 0.5 / 2) / 27
    assert value(body, body.chamber_volume("chamber")) == pytest.approx(expected, rel=1e-12)


def test_half_model_encloses_half():
    whole, half = body_of(hollow_box(lambda x: x - [0.5, 0, 0])), body_of(half_hollow_box())

    def mirrored(X):
        return np.stack([X[0] * (1 + 0.4 * X[1]), X[1] + 0.5 * X[2] ** 2, X[2]])

    for body in (whole, half):
        moved(body, mirrored)
    volumes = [value(body, body.chamber_volume("chamber")) for body in (whole, half)]
    expected = (1 + 0.4 * 0.5) / 27
    assert volumes == pytest.approx([expected, expected / 2], rel=1e-12)


def test_work_is_pressure_times_volume():
    body = body_of(hollow_box())
    moved(body, lambda X: A @ X)
    work = body.on_face("chamber", pressure_work(0.02, body.u, body.X, body.normal))
    volume = body.on_face("chamber", enclosed_volume(body.u, body.X, body.normal))
    assert value(body, work) == pytest.approx(0.02 * value(body, volume), rel=1e-14)


def test_load_is_the_pressure_along_the_deformed_normal():
    body = body_of(hollow_box())
    moved(body, lambda X: A @ X)
    V = body.function.function_space
    v = fem.Function(V)
    v.interpolate(lambda X: np.stack([X[0] ** 2, X[1] * X[2], 0.0 * X[0]]))
    work = body.on_face("chamber", pressure_work(0.02, body.u, body.X, body.normal))
    load = value(body, ufl.derivative(work, body.function, v))
    # cof F N of an affine map, out of the solid: pressure pushes against it.
    normal = ufl.as_matrix((np.linalg.det(A) * np.linalg.inv(A).T).tolist()) * body.normal
    expected = value(body, body.on_face("chamber", -0.02 * ufl.inner(normal, v)))
    assert load == pytest.approx(expected, rel=1e-11)
    assert abs(load) > 1e-5


def test_pressure_in_a_closed_chamber_neither_pushes_nor_turns_the_whole():
    body = body_of(hollow_box())
    moved(body, lambda X: A @ X + 0.2 * np.sin(X))
    x = fem.Function(body.function.function_space)
    x.interpolate(lambda X: X)
    x.x.array[:] += body.function.x.array
    points, v = x.x.array.reshape(-1, 3), fem.Function(x.function_space)
    load = compat.form(ufl.derivative(body.chamber_volume("chamber"), body.function, v))
    for axis in np.eye(3):
        for motion in (np.tile(axis, (len(points), 1)), np.cross(axis, points)):
            v.x.array[:] = motion.ravel()
            assert compat.assemble_scalar(body.comm, load) == pytest.approx(0.0, abs=1e-13)


def test_volume_of_a_curved_chamber_converges_to_the_maps():
    exact = chamber_of(distorted)
    errors = []
    for n in (3, 6):
        lines = (uniform(n),) * 3
        kind = np.ones((n, n, n), dtype=int)
        kind[(slice(n // 3, -n // 3),) * 3] = -1
        body = body_of(swept_blocks(lines, kind, {1: "body", -1: "chamber"}, distorted))
        errors.append(abs(value(body, body.chamber_volume("chamber")) - exact))
    assert errors[0] / errors[1] == pytest.approx(4.0, rel=0.15)
