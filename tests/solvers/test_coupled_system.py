"""The wing's equations, elastomer, ribs, glue, cables and pressure together, are one functional."""

import numpy as np
import pytest
from mpi4py import MPI

from tests.scenes.small_wing import small_wing

STEPS = [1e-3, 5e-4, 2.5e-4, 1.25e-4]


@pytest.fixture(scope="module")
def wing():
    """A loaded wing, shaken out of its equilibrium."""
    wing = small_wing(MPI.COMM_SELF)
    path = wing.actuate(upper=0.005, cable=0.02)
    assert path.converged
    system = wing.system
    x = system.x.duplicate()
    system.push(x)
    x.axpy(1.0, direction(system, seed=1, size=0.02))
    system.pull(x)
    keep_last(wing)
    return wing


def keep_last(wing):
    """Let the iterates before be the present ones: no correction of the tangent."""
    wing.accept()
    wing.before_tangent(0)


def direction(system, seed=2, size=1.0):
    """A random direction that leaves alone what is held."""
    d, marked, free = (system.x.duplicate() for _ in range(3))
    d.array[:] = size * np.random.default_rng(seed).standard_normal(len(d.array))
    marked.array[:] = np.arange(len(d.array)) + 0.5
    saved = [block.function.x.array.copy() for block in system.blocks]
    # What is held takes nothing from the vector.
    system.pull(marked)
    system.push(free)
    d.array[free.array != marked.array] = 0.0
    for block, values in zip(system.blocks, saved, strict=True):
        block.function.x.array[:] = values
    return d


def orders(errors):
    return np.log2(np.array(errors[:-1]) / np.array(errors[1:]))


def at(system, x, d, h):
    """Functions at x + h d."""
    moved = x.copy()
    moved.axpy(h, d)
    system.pull(moved)
    return moved


def test_residual_is_the_derivative_of_the_whole_energy(wing):
    system, x = wing.system, wing.system.x.duplicate()
    system.push(x)
    d, residual = direction(system), x.duplicate()
    system.residual(x, residual)
    start, slope = sum(system.energies()), residual.dot(d)
    errors = []
    for h in STEPS:
        at(system, x, d, h)
        errors.append(abs(sum(system.energies()) - start - h * slope))
    system.pull(x)
    assert orders(errors) == pytest.approx(2.0, abs=0.1)


def test_tangent_is_the_derivative_of_the_whole_residual(wing):
    system, x = wing.system, wing.system.x.duplicate()
    system.push(x)
    d, start, now = direction(system), x.duplicate(), x.duplicate()
    system.residual(x, start)
    slope = system.tangent() * d
    errors = []
    for h in STEPS:
        system.residual(at(system, x, d, h), now)
        now.axpy(-1.0, start)
        now.axpy(-h, slope)
        errors.append(now.norm())
    system.pull(x)
    assert orders(errors) == pytest.approx(2.0, abs=0.1)


def test_tangent_is_symmetric(wing):
    A = wing.system.tangent()
    assert (A - A.duplicate(copy=True).transpose()).norm() < 1e-13 * A.norm()


@pytest.mark.parametrize("part", ["body", "ribs", "glue"])
def test_each_correction_vanishes_with_the_square_of_its_last_step(wing, part):
    owner, system = getattr(wing, part), wing.system
    consistent = system.tangent().copy()
    step = np.random.default_rng(4).standard_normal(len(owner.iterate.step.x.array))
    present, errors = owner.function.x.array.copy(), []
    for size in (1e-2, 5e-3, 2.5e-3):
        owner.iterate.last.x.array[:] = present - size * step
        owner.iterate.step.x.array[:] = size * step
        errors.append((system.tangent() - consistent).norm())
    keep_last(wing)
    assert errors[0] > 0.0
    assert orders(errors) == pytest.approx(2.0, abs=0.15)


def test_corrections_leave_the_residual_alone(wing):
    system, x = wing.system, wing.system.x.duplicate()
    system.push(x)
    first, second = x.duplicate(), x.duplicate()
    system.residual(x, first)
    for owner in (wing.body, wing.ribs, wing.glue):
        owner.iterate.last.x.array[:] += 0.1
        owner.iterate.step.x.array[:] = 0.3
    system.residual(x, second)
    keep_last(wing)
    np.testing.assert_array_equal(first.array, second.array)


def test_glued_points_move_with_the_ribs_ends(wing):
    root, tail = (wing.ribs.end_values(kind, 0) for kind in ("root", "tail"))
    size = wing.glue.function.function_space.dofmap.index_map_bs
    feet = wing.glue.function.x.array.reshape(-1, size)[:, -6:]
    assert {tuple(row) for row in feet} == {tuple(root), tuple(tail)}
