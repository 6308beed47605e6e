"""The weight of a wing: how much, where it acts, what it costs, how the wing sags."""

import numpy as np
import pytest

from morphing_wing import compat
from morphing_wing.forms.gravity import specific_weight
from morphing_wing.geometry.wing import WingGeometry
from morphing_wing.geometry.wing_mesh import WingMeshing, wing_mesh
from morphing_wing.materials import DRAGON_SKIN_30, RESIN
from morphing_wing.weight import Weight
from tests.geometry import hexahedra
from tests.scenes.small_wing import NO_RIBS, NO_SKIN, SPAR, actuated, angles, move_elastomer, wing


def elastomers_weight(geometry, meshing):
    """Weight in N under standard gravity."""
    volume = hexahedra.volume(wing_mesh(geometry, meshing))
    return volume * specific_weight(DRAGON_SKIN_30.density)


@pytest.mark.quick
def test_elastomer_of_the_prototype_weighs_about_one_newton():
    bare, whole = (elastomers_weight(WingGeometry.prototype(**changes), WingMeshing.fine())
                   for changes in (NO_SKIN, {}))
    assert 0.85 < bare < 0.9 and 1.05 < whole < 1.1


@pytest.mark.quick
@pytest.mark.parametrize("changes", [{}, NO_RIBS], ids=["ribs", "no ribs"])
def test_work_of_a_rise_is_the_weight_of_all_parts(changes):
    scene = wing(**changes)
    weight = hexahedra.volume(scene.body.grid) * specific_weight(1080.0)
    move_elastomer(scene, lambda points: np.tile([5.0, 3.0, -4.0], (len(points), 1)))
    if scene.ribs is not None:
        scene.ribs.function.x.array.reshape(-1, 6)[:, 1] = 3.0
        points, areas = scene.ribs.frame.points[scene.ribs.frame.bars], scene.ribs.frame.areas()
        lengths = np.linalg.norm(points[:, 1] - points[:, 0], axis=1)
        weight += (lengths * areas).sum() * specific_weight(RESIN.density)
    assert Weight(scene.body, scene.ribs).fall() == pytest.approx(-3.0 * weight, rel=1e-9)


@pytest.mark.parametrize("changes", [SPAR, {"skin_root": "free"}], ids=["spar alone", "all"])
def test_a_wing_sags_in_proportion_to_small_multiples_of_its_weight(changes):
    small, more, up = (actuated(wing(**changes), gravity=g)[-1] for g in (0.01, 0.02, -0.01))
    found = angles(small)
    assert found["span_angle_deg"] > 0.0 and found.get("chord_angle_deg", 1.0) > 0.0
    for name, value in found.items():
        assert angles(more)[name] == pytest.approx(2.0 * value, rel=1e-2), name
        assert angles(up)[name] == pytest.approx(-value, rel=1e-2), name


def test_the_work_of_the_weight_is_stored():
    path = actuated(wing(**NO_SKIN), gravity=[0.0, 0.5, 1.0])
    assert path[-1].external_work_Nmm == pytest.approx(path[-1].energy_Nmm, rel=1e-3)
    assert path.table()["gravity_g"].tolist() == [0.0, 0.5, 1.0]


def test_weight_and_pressure_do_the_same_work_on_each_others_small_displacements():
    loads = {"gravity": 1e-3}, {"upper": 1e-6}
    falls, volumes = [], []
    for load in loads:
        scene = wing(**SPAR)
        at_rest = scene.body.chamber_volume("upper_chambers")
        before = compat.assemble_scalar(scene.comm, compat.form(at_rest))
        actuated(scene, **load)
        falls.append(Weight(scene.body, None).fall())
        volumes.append(compat.assemble_scalar(scene.comm, compat.form(at_rest)) - before)
    assert 1e-3 * falls[1] == pytest.approx(1e-6 * volumes[0], rel=1e-3)


def test_a_weight_compiles_no_tangent_and_without_one_nothing(monkeypatch):
    compiled, form = [], compat.form

    def noted(expression):
        compiled.append((expression.signature(), len(expression.arguments())))
        return form(expression)

    monkeypatch.setattr(compat, "form", noted)
    scene = wing(**NO_SKIN)
    actuated(scene, upper=0.001, gravity=0.0)
    assert set(scene.loads) == {"upper_MPa"}
    few = set(compiled)
    compiled.clear()
    actuated(wing(**NO_SKIN), upper=0.001, gravity=0.1)
    # Of elastomer and ribs the potential's derivative, and the potential to measure work.
    assert sorted(rank for _, rank in set(compiled) - few) == [0, 0, 1, 1]
