"""A C of elastomer whose jaws are squeezed together: they meet, in balance, and cost no more."""

import numpy as np
import pytest
import ufl

from morphing_wing import compat
from morphing_wing.geometry.hexmesh import swept_blocks, uniform
from morphing_wing.materials import Yeoh
from tests.verification.moved import Moved, pressing

WALL, SLOT, LENGTH = 1.0, 1.0, 6.0
MATERIAL = Yeoh((0.117, -0.0006865), bulk=2.0)
BOTH_JAWS = [("upper_jaw", "lower_jaw"), ("lower_jaw", "upper_jaw")]
STEPS = [2e-4, 1e-4, 5e-5]


def jaws():
    """A C open to the right: its back at x = 0, a jaw above and a longer one below the slot."""
    lines = (np.arange(9.0), np.array([0.0, 0.5, 1.0, 2.0, 2.5, 3.0]), uniform(2))
    kind = np.ones((8, 5, 2), int)
    kind[1:, 2, :] = 0
    kind[int(LENGTH):, 2:, :] = 0

    def faces(midpoints, normals):
        x, y, _ = midpoints.T
        in_slot = (x > 1.0) & (y > 0.9) & (y < 2.1)
        return {"base": (normals[:, 1] < 0) & (y == 0.0),
                "grip": (normals[:, 1] > 0) & (y == 3.0) & (x > 5.0),
                "upper_jaw": in_slot & (normals[:, 1] < 0),
                "lower_jaw": in_slot & (normals[:, 1] > 0)}

    return swept_blocks(lines, kind, {1: "body"}, faces=faces)


def squeezed(contact, by, pairs=BOTH_JAWS):
    """The C with its lower jaw held from below, the end of its upper jaw lowered by ``by`` mm."""
    part = pressing(*pairs, stiffness=20.0) if contact else (lambda body: None)
    scene = Moved(jaws(), MATERIAL, "Q1 enhanced", part, clamped=("base",), symmetry={"grip": 1})
    for start, end in zip(np.linspace(0.0, by, 11)[:-1], np.linspace(0.0, by, 11)[1:], strict=True):
        scene.lead("grip", 1, -start, -end)
    return scene


def smallest_gap(scene):
    """Distance in mm of the jaws, with or without contact."""
    return pressing(*BOTH_JAWS, stiffness=1.0)(scene.body).smallest_gap()


@pytest.fixture(scope="module")
def closed():
    return squeezed(contact=True, by=1.1)


def test_without_contact_the_jaws_pass_through_each_other():
    assert smallest_gap(squeezed(contact=False, by=1.1)) < -0.05


def test_with_contact_the_jaws_stop_each_other(closed):
    assert 0.0 < closed.part.penetration() < 0.01 * WALL
    assert smallest_gap(closed) == pytest.approx(-closed.part.penetration(), abs=1e-9)


def test_contact_forces_and_their_moments_are_in_balance(closed):
    contact, body = closed.part, closed.body
    local = np.zeros_like(contact.function.x.array)
    compat.assemble_vector(compat.form(ufl.derivative(
        contact.energy, contact.function,
        ufl.TestFunction(contact.function.function_space))), local)
    out = closed.system.x.duplicate()
    closed.system.gather([None, local], out)
    forces = np.zeros_like(body.function.x.array)
    forces[body.block.owned] = out.array
    space, dofs = body.displacement_space()
    f = forces[dofs].reshape(-1, 3)
    x = space.tabulate_dof_coordinates() + body.displacement().x.array.reshape(-1, 3)
    size, arm = np.abs(f).sum(), LENGTH
    assert size > 0.01
    np.testing.assert_allclose(f.sum(axis=0), 0.0, atol=1e-13 * size)
    np.testing.assert_allclose(np.cross(x, f).sum(axis=0), 0.0, atol=1e-12 * size * arm)


def disturbed(closed):
    """State with jaws that are well inside each other, and a direction that moves all of it."""
    system = closed.system
    system.set_energies([closed.part.energy], [None, None])
    x, d = system.x.duplicate(), system.x.duplicate()
    system.push(x)
    random = np.random.default_rng(3)
    x.array[:] += 0.02 * random.standard_normal(len(x.array))
    d.array[:] = random.standard_normal(len(d.array))
    d.array[system._constrained_rows] = 0.0
    # Nodes whose gap is next to nothing would come and go in between.
    system.pull(x)
    [(_, gap, _)] = closed.part._found()
    assert (gap < 0.0).sum() >= 3 and np.abs(gap).min() > 5 * STEPS[0]
    return system, x, d


def orders(errors):
    return np.log2(np.array(errors[:-1]) / np.array(errors[1:]))


def test_contact_residual_is_the_energys_derivative_while_the_places_move():
    scene = squeezed(contact=True, by=1.1, pairs=BOTH_JAWS[:1])
    system, x, d = disturbed(scene)
    residual, moved = system.x.duplicate(), system.x.duplicate()
    system.residual(x, residual)
    [start], errors = system.energies(), []
    for h in STEPS:
        system.residual(x + h * d, moved)
        errors.append(abs(system.energies()[0] - start - h * residual.dot(d)))
    assert orders(errors) == pytest.approx(2.0, abs=0.1)


def test_contact_tangent_is_the_residuals_derivative_while_the_places_stand():
    scene = squeezed(contact=True, by=1.1, pairs=BOTH_JAWS[:1])
    system, x, d = disturbed(scene)
    residual, moved = system.x.duplicate(), system.x.duplicate()
    system.residual(x, residual)
    refresh, scene.part.block.refresh = scene.part.block.refresh, None
    tangent, errors = system.tangent() * d, []
    for h in STEPS:
        system.residual(x + h * d, moved)
        errors.append((moved - residual - tangent * h).norm())
    assert orders(errors) == pytest.approx(2.0, abs=0.1)
    # What the places' motion adds is left out: a small part, for it grows with the force only.
    scene.part.block.refresh = refresh
    system.residual(x + STEPS[-1] * d, moved)
    left_out = (moved - residual) * (1.0 / STEPS[-1]) - tangent
    assert left_out.norm() < 0.05 * tangent.norm()


def test_jaws_that_are_far_apart_cost_no_entry_of_the_matrix():
    def entries(contact, slot):
        part = pressing(*BOTH_JAWS, stiffness=20.0) if contact else (lambda body: None)
        grid = jaws()
        grid.points[grid.points[:, 1] > 1.5, 1] += slot - SLOT
        scene = Moved(grid, MATERIAL, "Q1 enhanced", part, clamped=("base",))
        if contact:
            scene.part.prepare(scene.system)
        return scene.system.matrix.getInfo()["nz_used"]

    assert entries(True, 5.0) == entries(False, 5.0)
    assert entries(True, 1.0) > entries(False, 1.0)
