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
STEPS = [1e-3, 5e-4, 2.5e-4, 1.25e-4]


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


def squeezed(contact, by):
    """The C with its lower jaw held from below, the end of its upper jaw lowered by ``by`` mm."""
    part = pressing(*BOTH_JAWS, stiffness=20.0) if contact else (lambda body: None)
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
    return system, x, d


def orders(errors):
    return np.log2(np.array(errors[:-1]) / np.array(errors[1:]))


def test_contact_residual_is_the_energys_derivative_and_tangent_the_residuals():
    scene = squeezed(contact=True, by=1.1)
    system, x, d = disturbed(scene)
    residual, moved = system.x.duplicate(), system.x.duplicate()
    system.residual(x, residual)
    [start], tangent = system.energies(), system.tangent() * d
    # Nodes whose gap is next to nothing would come and go in between.
    contact = scene.part
    gaps = np.concatenate([gap for _, gap, _ in contact._found()])
    assert np.abs(gaps).min() > 4 * STEPS[0]
    energy_errors, residual_errors = [], []
    for h in STEPS:
        system.residual(x + h * d, moved)
        energy_errors.append(abs(system.energies()[0] - start - h * residual.dot(d)))
        residual_errors.append((moved - residual - tangent * h).norm())
    assert orders(energy_errors) == pytest.approx(2.0, abs=0.1)
    assert orders(residual_errors) == pytest.approx(2.0, abs=0.1)


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
