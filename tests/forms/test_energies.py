"""Energy, residual and tangent come from one functional, for every element."""

import numpy as np
import pytest
import ufl
from dolfinx import fem

from morphing_wing import compat
from morphing_wing.elements import ELEMENTS
from morphing_wing.forms.hyperelasticity import (
    mixed_volumetric_energy,
    volumetric_energy,
    yeoh_energy,
)
from morphing_wing.forms.kinematics import cofactor, deformation_gradient
from tests.forms.bodies import MATERIAL, deformed_body, direction

EACH_ELEMENT = pytest.mark.parametrize("element", list(ELEMENTS))
DISPLACEMENT_FORMS = pytest.mark.parametrize(
    "element", [name for name, e in ELEMENTS.items() if e.pressure is None])
PRESSURE = 0.07
STEPS = [1e-3, 5e-4, 2.5e-4, 1.25e-4]

_built = {}


def under_pressure(element):
    """Return the body and its system, with pressure work included, built once an element."""
    if element not in _built:
        body, system = deformed_body(element)
        pressure = fem.Constant(body.mesh, compat.scalar_type(PRESSURE))
        energy = body.energy - pressure * body.chamber_volume("chamber")
        system.set_energies([energy], [body.tangent_correction])
        _built[element] = (body, system, body.function.x.array.copy())
    body, system, values = _built[element]
    body.function.x.array[:] = values
    keep_last(body)
    return body, system


def keep_last(body):
    """Let the iterate before be the present one: the mixed-point correction is nothing."""
    if body.iterate is not None:
        body.iterate.accept()
        body.iterate.before_tangent(0)


def orders(errors):
    return np.log2(np.array(errors[:-1]) / np.array(errors[1:]))


@EACH_ELEMENT
def test_residual_is_the_energys_derivative(element):
    _, system = under_pressure(element)
    x, d, residual = system.x.duplicate(), direction(system), system.x.duplicate()
    system.push(x)
    system.residual(x, residual)
    [start], slope = system.energies(), residual.dot(d)
    errors = []
    for h in STEPS:
        system.pull(x + d * h)
        errors.append(abs(system.energies()[0] - start - h * slope))
    assert slope != 0.0
    assert orders(errors) == pytest.approx(2.0, abs=0.1)


@EACH_ELEMENT
def test_tangent_is_the_residuals_derivative(element):
    _, system = under_pressure(element)
    x, d = system.x.duplicate(), direction(system)
    start, moved = system.x.duplicate(), system.x.duplicate()
    system.push(x)
    system.residual(x, start)
    slope = system.tangent() * d
    errors = []
    for h in STEPS:
        system.residual(x + h * d, moved)
        errors.append((moved - start - slope * h).norm())
    assert orders(errors) == pytest.approx(2.0, abs=0.1)


@EACH_ELEMENT
def test_tangent_is_symmetric_with_a_closed_chamber(element):
    _, system = under_pressure(element)
    A = system.tangent()
    difference = A - A.duplicate(copy=True).transpose()
    assert difference.norm() < 1e-13 * A.norm()


@pytest.mark.parametrize("element", ["Q2 reduced", "Q1 reduced"])
def test_mixed_point_correction_takes_the_linearised_pressure(element):
    body, system = under_pressure(element)
    consistent = system.tangent().copy()
    now, before = body.function.x.array.copy(), _perturbed(body, 0.02)
    body.iterate.last.x.array[:] = before
    body.iterate.step.x.array[:] = now - before
    corrected = system.tangent().copy()

    u, old, step = body.u, body.iterate.last, body.iterate.step
    F, F_old = deformation_gradient(u), deformation_gradient(old)
    p_linear = 20.0 * (ufl.det(F_old) - 1.0 + ufl.inner(cofactor(F_old), ufl.grad(step)))
    p_error = p_linear - 20.0 * (ufl.det(F) - 1.0)
    V = body.function.function_space
    v, w = ufl.TestFunction(V), ufl.TrialFunction(V)
    term = p_error * ufl.derivative(ufl.derivative(ufl.det(F), u, v), u, w)
    by_hand = fem.petsc.assemble_matrix(compat.form(
        term * body.volume_measure(body.element.volumetric_quadrature)))
    by_hand.assemble()
    assert by_hand.norm() > 1e-3 * consistent.norm()
    # The numbers of unknowns are the function's: one block, one rank, nothing constrained.
    d = direction(system)
    difference = corrected * d - consistent * d - by_hand * d
    assert difference.norm() < 1e-12 * (consistent * d).norm()


@DISPLACEMENT_FORMS
def test_mixed_point_correction_vanishes_with_the_square_of_the_last_step(element):
    body, system = under_pressure(element)
    consistent, now = system.tangent().copy(), body.function.x.array.copy()
    errors = []
    for size in (2e-2, 1e-2, 5e-3, 2.5e-3):
        before = _perturbed(body, size)
        body.iterate.last.x.array[:] = before
        body.iterate.step.x.array[:] = now - before
        errors.append((system.tangent() - consistent).norm())
    assert orders(errors) == pytest.approx(2.0, abs=0.1)


@DISPLACEMENT_FORMS
def test_mixed_point_correction_leaves_the_residual_alone(element):
    body, system = under_pressure(element)
    x, first, second = (system.x.duplicate() for _ in range(3))
    system.push(x)
    system.residual(x, first)
    body.iterate.last.x.array[:] = _perturbed(body, 0.05)
    body.iterate.step.x.array[:] = 0.1
    system.residual(x, second)
    np.testing.assert_array_equal(first.array, second.array)


def _perturbed(body, size):
    random = np.random.default_rng(7)
    return body.function.x.array + size * random.standard_normal(len(body.function.x.array))


def _number(expression):
    return float(expression(()))


@pytest.mark.quick
def test_yeoh_energy_is_the_sum_of_its_terms():
    F = ufl.as_matrix([[1.4, 0.2, 0.0], [0.0, 0.9, 0.1], [0.3, 0.0, 1.1]])
    f = np.array([[1.4, 0.2, 0.0], [0.0, 0.9, 0.1], [0.3, 0.0, 1.1]])
    invariant = np.linalg.det(f) ** (-2 / 3) * np.sum(f * f) - 3.0
    C = MATERIAL.coefficients
    expected = sum(c * invariant**i for i, c in enumerate(C, start=1))
    assert _number(yeoh_energy(F, C)) == pytest.approx(expected, rel=1e-14)


@pytest.mark.quick
def test_swelling_stores_volumetric_energy_alone():
    F = 1.1 * ufl.Identity(3)
    assert _number(yeoh_energy(F, MATERIAL.coefficients)) == pytest.approx(0.0, abs=1e-15)
    assert _number(volumetric_energy(F, 20.0)) == pytest.approx(10.0 * (1.1**3 - 1) ** 2)


@pytest.mark.quick
def test_mixed_volumetric_energy_is_the_displacement_forms_at_its_stationary_pressure():
    F, J = 1.1 * ufl.Identity(3), 1.1**3
    p = 20.0 * (J - 1.0)
    value = _number(mixed_volumetric_energy(F, p, 1.0 / 20.0))
    assert value == pytest.approx(_number(volumetric_energy(F, 20.0)))
    for other in (0.9 * p, 1.1 * p):
        assert _number(mixed_volumetric_energy(F, other, 1.0 / 20.0)) < value


@pytest.mark.quick
def test_cofactor_is_the_inverses_transpose_times_the_determinant():
    f = np.array([[1.4, 0.2, 0.0], [0.0, 0.9, 0.1], [0.3, 0.0, 1.1]])
    cof = cofactor(ufl.as_matrix(f.tolist()))
    values = [[_number(cof[i, j]) for j in range(3)] for i in range(3)]
    np.testing.assert_allclose(values, np.linalg.det(f) * np.linalg.inv(f).T, atol=1e-14)
