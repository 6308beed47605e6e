"""A rib of one condensed cell: any length, large turns, its energy; see also `verification`."""

from dataclasses import replace

import numpy as np
import pytest
from mpi4py import MPI

from morphing_wing import compat, condensation, condensed_rib
from morphing_wing.condensation import condensed
from morphing_wing.condensed_rib import CondensedRib
from morphing_wing.cut_fields import COLUMNS, rigid
from morphing_wing.errors import InputError
from morphing_wing.geometry.rib import RibGeometry
from morphing_wing.geometry.rib_cell import HALF, PIECES, cut
from morphing_wing.linked_ribs import LinkedRibs
from morphing_wing.materials import Elastic
from morphing_wing.modes import modes
from morphing_wing.path import load_table
from morphing_wing.rib import Rib
from morphing_wing.rib_links import DEFORMATIONS
from morphing_wing.rib_stiffness import tail_compliance

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


class LinkedRib(Rib):
    """The same in space."""

    def _made(self):
        return LinkedRibs(self.comm, self.geometry, self.material, 6, clamped=True)


@pytest.fixture(params=[0, 1], ids=["mirrored", "reversed"])
def parity(request):
    return request.param


def stiffness_of_pieces(parity):
    return condensed(MPI.COMM_SELF, GEOMETRY, RESIN.nu, 6, "pieces_", parity).stiffness


def last(path):
    assert path.converged, path.reason
    return path[-1]


def joined(n, parity):
    """Return the tail's compliance, pieces joined in fixed axes."""
    pieces, size = stiffness_of_pieces(parity), len(COLUMNS[parity])
    total = np.zeros((size * n + 3, size * n + 3))
    first = [cut(GEOMETRY, layer, 1) for layer in HALF]
    seen = np.hstack([np.eye(size), -rigid(first, [GEOMETRY.pitch, 0.0, 0.0], parity)])
    parts = [(0, pieces["root"]), *((size * k, pieces["cell"]) for k in range(n - 1))]
    for start, part in [*parts, (size * (n - 1), seen.T @ pieces["tail"] @ seen)]:
        span = slice(start, start + len(part))
        total[span, span] += 2.0 * RESIN.E * part
    return np.linalg.inv(total)[-3:, -3:]


@pytest.mark.parametrize("n", [1, 2, 4])
def test_to_any_load_of_the_tail_links_comply_as_their_pieces_joined(n, parity):
    chosen = DEFORMATIONS[parity]
    geometry = replace(GEOMETRY, n_cells=n)
    found = tail_compliance(LinkedRib(geometry, RESIN, comm=MPI.COMM_SELF))
    expected = joined(n, parity)
    size = np.sqrt(np.diag(expected))
    np.testing.assert_allclose((found[np.ix_(chosen, chosen)] - expected) / np.outer(size, size),
                               0.0, atol=1e-8)
    others = DEFORMATIONS[1 - parity]
    assert np.abs(found[np.ix_(chosen, others)]).max() < 1e-12 * np.abs(expected).max()


def test_each_further_cell_of_a_long_rib_adds_the_same_angle():
    angles = [last(rib(n).bend(torque=1.0)).measures["chord_angle_deg"] for n in (8, 9, 10)]
    assert angles[2] - angles[1] == pytest.approx(angles[1] - angles[0], rel=1e-6)


def test_a_rib_that_turns_by_90_degrees_about_any_axis_stores_nothing():
    scene = LinkedRib(replace(GEOMETRY, n_cells=3), RESIN, comm=MPI.COMM_SELF)
    space = scene.ribs.function.function_space
    x = space.tabulate_dof_coordinates()
    w = scene.ribs.function.x.array.reshape(-1, 6)
    energy = compat.form(scene.ribs.energy)
    for turn, e in (([0.0, 0.5 * np.pi, 0.0], [0, 0, -1]), ([0.0, 0.0, 0.5 * np.pi], [0, 1, 0])):
        w[:, :3] = [3.0, -2.0, 1.0] + np.outer(x[:, 0], e) - x  # x turns to e
        w[:, 3:] = turn
        assert abs(compat.assemble_scalar(scene.comm, energy)) < 1e-20
    w[:, 3:] = 0.0
    assert compat.assemble_scalar(scene.comm, energy) > 1.0


def test_condensed_pieces_are_stable_and_hold_no_rigid_motion(parity):
    pieces = stiffness_of_pieces(parity)
    for piece in PIECES:
        values = np.linalg.eigvalsh(pieces[piece])
        assert (values < 1e-9).sum() == (3 if piece == "cell" else 0)
        assert values[0] > -1e-9
    both = [rigid([cut(GEOMETRY, layer, k) for layer in HALF], np.zeros(3), parity)
            for k in (1, 2)]
    assert np.abs(pieces["cell"] @ np.vstack(both)).max() < 1e-9


def test_angle_is_linear_in_the_moment_at_any_turn():
    bent = rib(4)
    first = last(bent.bend(torque=0.1)).measures["chord_angle_deg"] / 0.1
    found = last(bent.bend(torque=120.0 / first))
    assert found.measures["chord_angle_deg"] == pytest.approx(120.0, rel=1e-9)
    assert found.newton_iterations <= 5
    assert found.negative_pivots == 0


def test_a_step_from_a_bent_state_takes_no_more_iterations_than_one_from_rest():
    path = rib(6).bend(torque=[12.0, 24.0])  # without a cut: no step between
    rest = last(rib(6).bend(torque=24.0)).newton_iterations
    assert [state.newton_iterations for state in path] == [rest, rest]


def test_stored_energy_is_the_work_of_moment_and_cable():
    pulled = rib(4)
    state = last(pulled.bend(torque=[20.0, 40.0]))
    assert state.external_work_Nmm == pytest.approx(state.energy_Nmm, rel=1e-6)
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


def test_cells_are_condensed_once_for_all_lengths_and_moduli(monkeypatch):
    rib(1)
    monkeypatch.setattr(condensation, "rib_piece", None)
    soft = last(rib(4, Elastic(1250.0, 0.35)).bend(torque=1.0)).measures["chord_angle_deg"]
    assert soft == pytest.approx(2.0 * last(rib(4).bend(torque=1.0)).measures["chord_angle_deg"])


def test_it_is_saved_drawn_and_resumed(tmp_path):
    scene = rib(2)
    assert type(scene) is CondensedRib and scene.fidelity == "cell"
    path = scene.bend(torque=[0.0, 5.0], restart=tmp_path / "run")
    path.save(tmp_path / "run")
    assert len(load_table(tmp_path / "run")) == 2
    assert list((tmp_path / "run" / "fields").iterdir())
    resumed = rib(2).bend(torque=[0.0, 5.0, 8.0], resume=tmp_path / "run")
    assert len(resumed) == 3
    assert last(resumed).measures == pytest.approx(last(rib(2).bend(torque=8.0)).measures)


def test_it_vibrates():
    scene = rib(4)
    last(scene.bend(torque=1.0))
    first, second = modes(scene, 2)
    assert 0.0 < first.frequency_Hz < second.frequency_Hz


@pytest.mark.parametrize("call, sentence", [
    (lambda r: r.bend(torque=[1.0, np.nan]), "torque = "),
    (lambda r: r.pull(cable=-0.1), "cable = -0.1 N: must be 0 N or more"),
    (lambda r: r.pull(cable=0.1, guide=(0.0, 0.0)), "guide = "),
])
def test_loads_that_cannot_be_are_refused(call, sentence):
    with pytest.raises(InputError) as refused:
        call(rib(2))
    assert str(refused.value).startswith(sentence)
