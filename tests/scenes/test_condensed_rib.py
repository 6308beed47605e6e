"""A rib of one condensed cell: any length, large turns, its energy; see also `verification`."""

from dataclasses import replace

import numpy as np
import pytest
from mpi4py import MPI

from morphing_wing import condensation, condensed_rib
from morphing_wing.condensed_rib import CondensedRib
from morphing_wing.cut_fields import SIZE, shift, turn
from morphing_wing.errors import InputError
from morphing_wing.geometry.rib import RibGeometry
from morphing_wing.geometry.rib_cell import HALF, PIECES, cut
from morphing_wing.materials import Elastic
from morphing_wing.modes import modes
from morphing_wing.path import load_table
from morphing_wing.pulled_chain import Pull, potential
from morphing_wing.rib import Rib
from morphing_wing.rib_chain import RibChain, chord_stiffness, section_deformations

pytestmark = pytest.mark.quick

GEOMETRY = RibGeometry.validation("square", True)
RESIN = Elastic(2500.0, 0.35)


@pytest.fixture(autouse=True)
def coarse(monkeypatch):
    """Mesh coarsely."""
    monkeypatch.setitem(condensed_rib.AROUND, "cell", 6)


def rib(n_cells, material=RESIN):
    geometry = replace(GEOMETRY, n_cells=n_cells)
    return Rib(geometry, material, fidelity="cell", comm=MPI.COMM_SELF)


@pytest.fixture
def pieces(coarse):
    return rib(1)._pieces


@pytest.fixture
def chain(pieces):
    return RibChain(replace(GEOMETRY, n_cells=3), pieces, RESIN.E)


def last(path):
    assert path.converged, path.reason
    return path[-1]


def in_fixed_axes(pieces, n):
    """Return the small turn of the tail by a unit moment, pieces joined in fixed axes."""
    size = SIZE * n + 3
    stiffness = np.zeros((size, size))
    seen = np.hstack([np.eye(SIZE), -shift(0)[:, None], -shift(1)[:, None], -turn(
        [cut(GEOMETRY, layer, 1) for layer in HALF], [GEOMETRY.pitch, 0.0, 0.0])[:, None]])
    parts = [(0, pieces.stiffness["root"])]
    parts += [(SIZE * k, pieces.stiffness["cell"]) for k in range(n - 1)]
    parts += [(SIZE * (n - 1), seen.T @ pieces.stiffness["tail"] @ seen)]
    for start, part in parts:
        span = slice(start, start + len(part))
        stiffness[span, span] += 2.0 * RESIN.E * part
    return np.linalg.solve(stiffness, np.eye(size)[-1])[-1]


@pytest.mark.parametrize("n", [1, 2, 4])
def test_a_chain_of_any_length_is_its_pieces_joined(n, pieces):
    turned = np.radians(last(rib(n).bend(torque=1.0)).measures["chord_angle_deg"])
    assert turned == pytest.approx(in_fixed_axes(pieces, n), rel=1e-9)


def test_each_further_cell_of_a_long_rib_adds_the_same_angle():
    angles = [last(rib(n).bend(torque=1.0)).measures["chord_angle_deg"] for n in (8, 9, 10)]
    assert angles[2] - angles[1] == pytest.approx(angles[1] - angles[0], rel=1e-6)


@pytest.mark.parametrize("piece", ["cell", "tail"])
def test_a_piece_that_turns_by_90_degrees_stores_nothing(piece, pieces):
    stiffness = chord_stiffness(
        GEOMETRY, piece, pieces.stiffness[piece], section_deformations(GEOMETRY))
    own = 1 + section_deformations(GEOMETRY).shape[1]
    turns = np.zeros(len(stiffness))
    turns[[0, 2, 2 + own]] = 0.5 * np.pi  # chord, and both sides
    assert abs(turns @ stiffness @ turns) < 1e-10 * np.trace(stiffness)
    turns[0] = 0.0
    assert turns @ stiffness @ turns > 1e-3 * np.trace(stiffness)


def test_condensed_pieces_are_stable_and_hold_no_translation(pieces):
    for piece in PIECES:
        values = np.linalg.eigvalsh(pieces.stiffness[piece])
        assert (values < 1e-9).sum() == (3 if piece == "cell" else 0)
        assert values[0] > -1e-9
    along = np.tile(shift(0), 2)
    assert np.abs(pieces.stiffness["cell"] @ along).max() < 1e-9


def test_gradient_and_hessian_are_the_potentials_derivatives(chain):
    rng = np.random.default_rng(0)
    y, way = rng.normal(size=(2, len(chain.stiffness)))
    pull = Pull(3.0, 50.0, np.array([10.0, -30.0, 5.0]))
    _, gradient, hessian = potential(chain, y, pull)
    errors = []
    for step in (1e-2, 5e-3):
        ahead, behind = (potential(chain, y + side * step * way, pull) for side in (1, -1))
        slope = (ahead[0] - behind[0]) / (2.0 * step)
        force = (ahead[1] - behind[1]) / (2.0 * step)
        errors.append([abs(slope - gradient @ way), np.linalg.norm(force - hessian @ way)])
    np.testing.assert_allclose(np.divide(*errors), 4.0, rtol=0.05)  # second order


def test_angle_is_linear_in_the_moment_at_any_turn():
    bent = rib(4)
    first = last(bent.bend(torque=0.1)).measures["chord_angle_deg"] / 0.1
    found = last(bent.bend(torque=120.0 / first))
    assert found.measures["chord_angle_deg"] == pytest.approx(120.0, rel=1e-9)
    assert found.newton_iterations <= 2
    assert found.negative_pivots == 0


def test_stored_energy_is_the_work_of_moment_and_cable():
    pulled = rib(4)
    state = last(pulled.bend(torque=[20.0, 40.0]))
    assert state.external_work_Nmm == pytest.approx(state.energy_Nmm, rel=1e-9)
    state = last(pulled.follow({"torque_Nmm": 40.0, "cable_N": np.linspace(0.0, 1.0, 9)}))
    assert state.external_work_Nmm == pytest.approx(state.energy_Nmm, rel=1e-4)


def test_a_cable_pulls_down_as_the_equal_moment_at_small_load():
    bare = rib(3)
    tiny = last(bare.pull(cable=1e-4)).measures
    bare.pull(cable=0.0)
    moment = last(bare.bend(torque=1e-4)).measures
    # Maxwell, Betti: deflection by a unit moment is rotation by a unit force.
    deflection = np.tan(np.radians(moment["chord_line_deg"])) * bare.geometry.length
    assert np.radians(tiny["chord_angle_deg"]) == pytest.approx(deflection, rel=1e-4)


def test_cells_are_condensed_once_for_all_lengths_and_moduli(monkeypatch, pieces):
    monkeypatch.setattr(condensation, "rib_piece", None)
    soft = last(rib(4, Elastic(1250.0, 0.35)).bend(torque=1.0)).measures["chord_angle_deg"]
    assert soft == pytest.approx(2.0 * last(rib(4).bend(torque=1.0)).measures["chord_angle_deg"])


def test_it_is_saved_without_fields(tmp_path):
    scene = rib(2)
    assert type(scene) is CondensedRib and scene.fidelity == "cell"
    path = scene.bend(torque=[0.0, 5.0])
    path.save(tmp_path / "run")
    assert len(load_table(tmp_path / "run")) == 2
    assert not (tmp_path / "run" / "fields").exists()
    assert path.summary()["dofs"] == scene.dofs > 0


def test_what_needs_a_field_is_refused(tmp_path):
    scene = rib(2)
    state = last(scene.bend(torque=1.0))
    with pytest.raises(InputError, match="a chain of condensed cells or a formula has none"):
        state.render(tmp_path / "rib.png")
    with pytest.raises(InputError, match="'cell': must be another one here, a chain of condensed"):
        modes(scene, 1)
    with pytest.raises(InputError, match='left out where fidelity is "cell"; it leaves nothing'):
        scene.bend(torque=1.0, resume=tmp_path)


@pytest.mark.parametrize("call, sentence", [
    (lambda r: r.bend(torque=[1.0, np.nan]), "torque = "),
    (lambda r: r.pull(cable=-0.1), "cable = -0.1 N: must be 0 N or more"),
    (lambda r: r.pull(cable=0.1, guide=(0.0, 0.0)), "guide = "),
])
def test_loads_that_cannot_be_are_refused(call, sentence):
    with pytest.raises(InputError) as refused:
        call(rib(2))
    assert str(refused.value).startswith(sentence)
