"""A block pulled off its foot evenly: traction against separation, damage, energy in balance."""

import numpy as np
import pytest
import ufl
from mpi4py import MPI

from morphing_wing import compat
from morphing_wing.forms.adhesive import separation_energies, used
from morphing_wing.geometry.hexmesh import swept_blocks, uniform
from morphing_wing.materials import Adhesive, Yeoh
from morphing_wing.points import PointMesh
from tests.verification.moved import Moved, glued

SIDE, HEIGHT = 2.0, 1.0
AREA = SIDE**2
LAW = Adhesive(stiffness=2.0, strength=0.02, toughness=6e-4)
FIRST, LAST = 0.02 / 2.0, 2.0 * 6e-4 / 0.02  # separations in mm at the strength and at the end
BLOCK = Yeoh((5.0,), bulk=20.0 / 3.0)  # Poisson's ratio is nothing: the pull stays even


def block(n=2, law=LAW):
    """A block glued by its underside, its sides sliding, its top held."""
    def faces(midpoints, normals):
        return {"glued": normals[:, 1] < 0, "top": normals[:, 1] > 0,
                "x": normals[:, 0] < 0, "z": normals[:, 2] < 0}

    lines = SIDE * uniform(n), HEIGHT * uniform(1), SIDE * uniform(n)
    grid = swept_blocks(lines, np.ones((n, 1, n), int), {1: "body"}, faces=faces)
    return Moved(grid, BLOCK, "Q1 enhanced", glued("glued", law),
                 symmetry={"x": 0, "z": 2, "top": 1})


def traction(separation, largest):
    """The law: in MPa at a separation in mm after the ``largest`` one."""
    if separation < 0.0:
        return LAW.stiffness * separation
    s = max(separation, largest)
    envelope = LAW.stiffness * s if s <= FIRST else max(
        LAW.strength * (LAST - s) / (LAST - FIRST), 0.0)
    return envelope * separation / s if s > 0.0 else 0.0


def pulled(scene, tops):
    """Move the top through displacements in mm; return of each separation, pull, history, work."""
    rows, work, before = [], 0.0, (0.0, 0.0)
    for top in tops:
        scene.move("top", 1, top)
        scene.solve()
        force = scene.reaction("top", 1)
        work += 0.5 * (force + before[1]) * (top - before[0])
        before = top, force
        rows.append((scene.body.mean_displacement("glued")[1], force, scene.part.history.max(),
                     work - scene.stored() - scene.part.dissipated(), work))
    return np.array(rows)


WAY = np.concatenate([
    np.linspace(0.0, 0.03, 11)[1:], np.linspace(0.03, -0.01, 6)[1:],
    np.linspace(-0.01, 0.045, 9)[1:], np.linspace(0.045, 0.0, 4)[1:]])


@pytest.fixture(scope="module")
def there_and_back():
    return pulled(block(), WAY)


def test_pull_follows_the_law_there_and_back(there_and_back):
    separation, force, *_ = there_and_back.T
    largest = np.maximum.accumulate(separation)
    expected = [AREA * traction(*pair) for pair in zip(separation, largest, strict=True)]
    assert max(separation) > 3 * FIRST and min(separation) < -0.5 * FIRST
    np.testing.assert_allclose(force, expected, atol=1e-8 * AREA * LAW.strength)


def test_damage_never_heals(there_and_back):
    separation, force, history, *_ = there_and_back.T
    assert (np.diff(history) >= 0.0).all()
    assert history[-1] == pytest.approx(separation.max() / FIRST, rel=1e-6)
    opening = separation > 1e-6
    stiffness = force[opening] / separation[opening] / AREA
    assert stiffness[-1] < 0.2 * LAW.stiffness
    assert (np.diff(stiffness) < 1e-9).all()


def test_pressing_together_has_the_virgin_stiffness_however_damaged(there_and_back):
    separation, force, history, *_ = there_and_back.T
    closed = separation < -1e-6
    assert closed.any() and (history[closed] > 1.5).all()
    np.testing.assert_allclose(
        force[closed], AREA * LAW.stiffness * separation[closed], rtol=1e-8)


def test_fully_debonded_glue_has_dissipated_its_toughness_and_lets_go():
    scene = block(law=LAW)
    rows = pulled(scene, np.linspace(0.0, 1.05 * LAST, 12)[1:])
    assert scene.part.dissipated() == pytest.approx(LAW.toughness * AREA, rel=1e-12)
    assert (scene.part.damage() == 1.0).all()
    assert abs(rows[-1, 1]) < 1e-10 * AREA * LAW.strength


def test_work_of_debonding_is_stored_or_dissipated_the_better_the_smaller_the_steps():
    # Steps that end at the strength: the law has a kink there.
    errors = []
    for n in (5, 10):
        scene = block()
        kink = FIRST * (1.0 + LAW.stiffness * HEIGHT / 20.0)
        tops = np.concatenate([np.linspace(0.0, kink, n + 1)[1:],
                               np.linspace(kink, 1.02 * LAST, n + 1)[1:]])
        rows = pulled(scene, tops)
        errors.append(np.abs(rows[:, 3]).max() / rows[-1, 4])
    assert errors[1] < 0.5 * errors[0] < 2.5e-3


@pytest.mark.parametrize("by, kappa", [(0.5, 1.0), (2.0, 1.0), (2.0, 3.0), (3.5, 3.0)])
def test_glues_residual_is_its_potentials_derivative_and_tangent_the_residuals(by, kappa):
    scene = block()
    system, part = scene.system, scene.part
    part.recall(np.full(len(part.history), kappa))
    system.set_energies([part.energy], [None, None])
    u = scene.body.displacement_part(scene.body.function)
    u.interpolate(lambda x: by * FIRST * np.stack(
        [0.3 + 0.02 * x[2], 0.9 + 0.03 * x[0], 0.1 + 0.02 * x[2]]))
    x, d, residual, moved = (system.x.duplicate() for _ in range(4))
    system.push(x)
    d.array[:] = FIRST * np.random.default_rng(3).standard_normal(len(d.array))
    d.array[system._constrained_rows] = 0.0
    system.residual(x, residual)
    [start], tangent = system.energies(), system.tangent() * d
    energy_errors, residual_errors = [], []
    steps = [2e-2, 1e-2, 5e-3]
    for h in steps:
        system.residual(x + h * d, moved)
        energy_errors.append(abs(system.energies()[0] - start - h * residual.dot(d)))
        residual_errors.append((moved - residual - tangent * h).norm())
    orders = [np.log2(np.array(e[:-1]) / np.array(e[1:])) for e in (energy_errors, residual_errors)]
    assert orders[0] == pytest.approx(2.0, abs=0.1)
    linear = by < kappa
    if linear:  # damage stands still: the tangent is constant
        assert max(residual_errors) < 1e-10 * residual.norm()
    else:
        assert orders[1] == pytest.approx(2.0, abs=0.15)


def test_glue_that_is_pressed_is_not_used_whichever_way_its_face_looks():
    normals = np.random.default_rng(0).normal(size=(500, 3))
    normals /= np.linalg.norm(normals, axis=1)[:, None]
    mesh = PointMesh(MPI.COMM_SELF, len(normals), 1, 6, "pressed")
    mesh.set_data(np.concatenate([-0.01 * normals, normals], axis=1)[mesh.mine])
    s, normal = (ufl.as_vector([mesh.data[3 * k + i] for i in range(3)]) for k in range(2))
    stiffness, shear = compat.constant(mesh.mesh, 50.0), compat.constant(mesh.mesh, 50.0)
    e, _ = separation_energies(s, normal, stiffness, shear)
    use = mesh.each(used(e, compat.constant(mesh.mesh, 1e-3)))()
    assert (np.abs(use) < 1e-6).all()  # what is not a number is not small


def test_another_law_compiles_nothing(monkeypatch):
    signatures, form = [], compat.form

    def noted(expression):
        signatures.append(expression.signature())
        return form(expression)

    monkeypatch.setattr(compat, "form", noted)
    found = []
    for law in (LAW, Adhesive(stiffness=5.0, strength=0.03, toughness=1e-3, shear_strength=0.02)):
        signatures.clear()
        block(law=law).solve()
        found.append(list(signatures))
    assert found[0] == found[1]
