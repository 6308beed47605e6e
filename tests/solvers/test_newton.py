"""Newton's method where the tangent is indefinite: counts of pivots, regularisation by inertia."""

import numpy as np
import pytest
from petsc4py import PETSc

from tests.solvers.strip import Strip

BEYOND_BUCKLING = 0.2


@pytest.mark.parametrize("element", ["Q2 reduced", "Q2/P1disc"])
def test_negative_pivots_are_the_negative_eigenvalues(element):
    short, buckled = Strip(0.0, False, element), Strip(0.0, False, element)
    assert short.push(0.01).negative_pivots == short.negative_eigenvalues() == 0
    assert buckled.push(BEYOND_BUCKLING).negative_pivots == buckled.negative_eigenvalues() > 0


def test_plain_newton_ends_on_the_unstable_branch_and_says_so():
    strip = Strip(0.1, regularised=False)
    result = strip.push(BEYOND_BUCKLING)
    assert result.converged and result.negative_pivots > 0
    assert strip.bow() < 0.5


def test_regularised_newton_ends_buckled_and_stable_in_an_unregularised_equilibrium():
    plain, strip = Strip(0.1, regularised=False), Strip(0.1, regularised=True)
    plain.push(BEYOND_BUCKLING)
    result = strip.push(BEYOND_BUCKLING)
    assert result.converged and result.negative_pivots == 0 == strip.negative_eigenvalues()
    # Inextensible, it would bow by about 2/pi sqrt(0.2 * 20) mm.
    assert strip.bow() > 0.9
    assert strip.system.energies()[0] < 0.5 * plain.system.energies()[0]
    residual, x = strip.system.x.duplicate(), strip.system.x.duplicate()
    strip.system.push(x)
    strip.system.residual(x, residual)
    assert residual.norm() < 1e-10
    # Plain Newton, started there, has nothing left to do.
    other = Strip(0.1, regularised=False)
    other.body.function.x.array[:] = strip.body.function.x.array
    assert other.push(BEYOND_BUCKLING).iterations == 0


def test_negative_pivots_that_the_mass_cannot_cure_end_the_solve_at_once():
    strip = Strip(0.1, regularised=True)
    far = strip.body.function.function_space.tabulate_dof_coordinates()[:, 0] > 2.0
    strip.newton.factor.regularisation.mass[np.repeat(far, 3)] = 0.0  # what is left is of one end
    result = strip.push(BEYOND_BUCKLING)
    assert not result.converged
    assert result.reason == "the way is unstable, and mass on the thin part does not help"
    assert result.iterations <= 3 and strip.newton.factor.factorisations <= 10


def test_a_solve_does_not_inherit_the_mass_of_one_that_failed():
    failed, fresh = Strip(0.1, regularised=True), Strip(0.1, regularised=True)
    failed.newton.factor.amount = 1e6
    results = [strip.push(0.01) for strip in (failed, fresh)]
    assert results[0].iterations == results[1].iterations


def test_regularisation_leaves_a_stable_problem_alone():
    plain, strip = Strip(0.1, regularised=False), Strip(0.1, regularised=True)
    results = [s.push(0.01) for s in (plain, strip)]
    assert results[0].iterations == results[1].iterations
    np.testing.assert_array_equal(plain.body.function.x.array, strip.body.function.x.array)
    assert strip.newton.factor.factorisations == results[1].iterations


def test_a_saddle_reached_with_regularisation_is_not_called_stable():
    strip = Strip(0.0, regularised=True)
    result = strip.push(BEYOND_BUCKLING)
    # Nothing breaks the symmetry of a straight strip: what converges is the saddle.
    assert result.converged and strip.bow() < 0.01
    assert result.negative_pivots == strip.negative_eigenvalues() > 0


def test_cells_turned_inside_out_stop_newton_with_a_reason():
    result = Strip(0.0, regularised=False).push(3.0)
    assert not result.converged
    assert result.reason == "an element turned inside out (J <= 0)"


@pytest.fixture
def mumps():
    """Return the PETSc options of the strip's factorisation; what is set is taken back."""
    options = PETSc.Options("test_strip_factor_")
    yield options
    for name in ("mat_mumps_icntl_14", "mat_mumps_icntl_23"):
        options.delValue(name)


@pytest.mark.quick
def test_options_of_mumps_are_open_under_the_solvers_prefix(mumps):
    mumps.setValue("mat_mumps_icntl_14", 77)
    strip = Strip(0.0, regularised=False)
    strip.push(0.01)
    factor = strip.newton.factor._inner.matrix
    assert (factor.getMumpsIcntl(14), factor.getMumpsIcntl(13)) == (77, 1)


@pytest.mark.quick
@pytest.mark.parametrize("regularised", [False, True])
def test_a_factorisation_without_memory_is_no_solution_and_no_cell_inside_out(mumps, regularised):
    mumps.setValue("mat_mumps_icntl_23", 1)  # MB
    result = Strip(0.0, regularised, cells=40).push(0.01)
    assert not result.converged
    assert result.reason.startswith("the tangent could not be factorised (MUMPS error -")


@pytest.mark.quick
@pytest.mark.parametrize("regularised", [False, True])
def test_after_a_factorisation_that_failed_the_next_solve_factorises_anew(mumps, regularised):
    strip = Strip(0.1, regularised, cells=40)
    at_rest = strip.body.function.x.array.copy()
    mumps.setValue("mat_mumps_icntl_14", -90)
    assert strip.push(0.01).reason.startswith("the tangent could not be factorised (MUMPS error -")
    strip.body.function.x.array[:] = at_rest
    strip.body.iterate.accept()
    mumps.delValue("mat_mumps_icntl_14")
    assert strip.push(0.01).converged


@pytest.mark.quick
def test_a_state_whose_own_tangent_has_no_factor_is_not_called_converged(monkeypatch):
    strip = Strip(0.1, regularised=True)
    assert strip.push(0.01).converged
    factor = strip.newton.factor
    monkeypatch.setattr(factor, "inspect", lambda _: setattr(factor, "error", -13))
    result = strip.push(0.01)  # nothing to do but to inspect
    assert not result.converged
    assert result.reason == "the tangent could not be factorised (MUMPS error -13)"


def test_all_solves_share_one_matrix():
    strip = Strip(0.1, regularised=True)
    handle = strip.system.matrix.handle
    for by in (0.01, BEYOND_BUCKLING):
        strip.push(by)
        strip.system.set_energies([strip.body.energy], [strip.body.tangent_correction])
    assert strip.system.tangent().handle == handle == strip.system.matrix.handle
