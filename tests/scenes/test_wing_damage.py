"""Glue that gives way in a wing: where first, for good, and through a restart."""

import numpy as np
import pytest

from morphing_wing.materials import Adhesive
from tests.scenes.small_wing import NO_SKIN, actuated, wing

GLUE = Adhesive(stiffness=50.0, strength=1.0, toughness=0.5)
IN_CONTACT = {"n_cells": 4, "skin_thickness": 0.3, "rib_positions": (0.75,)}


def test_the_foot_gives_way_where_its_strength_is_reached_and_not_before():
    path = actuated(wing(adhesive=GLUE, **NO_SKIN), cable=[0.02, 0.04, 0.1, 0.15])
    used = np.array([state.measures["rib_1_foot_use"] for state in path])
    damage = np.array([state.measures["glue_damage"] for state in path])
    assert used[0] < 1.0 < used[-1]
    np.testing.assert_array_equal(damage > 0.0, used > 1.0)
    elastic = actuated(wing(**NO_SKIN), cable=[0.02, 0.15])
    assert path[0].measures["rib_1_rotation_deg"] == pytest.approx(
        elastic[0].measures["rib_1_rotation_deg"], rel=1e-8)
    assert path[-1].measures["rib_1_rotation_deg"] > elastic[-1].measures["rib_1_rotation_deg"]


def test_damage_stays_and_its_energy_with_it():
    loads = np.concatenate([np.linspace(0.0, 0.15, 7), np.linspace(0.15, 0.0, 4)[1:]])
    path = actuated(wing(adhesive=GLUE, **NO_SKIN), cable=loads)
    taken = [state.measures["glue_dissipated_Nmm"] for state in path]
    assert taken[-1] > 0.0 and (np.diff(taken) >= 0.0).all()
    most = max(state.external_work_Nmm for state in path)
    for state, energy in zip(path, taken, strict=True):
        assert state.external_work_Nmm == pytest.approx(state.energy_Nmm + energy, abs=5e-3 * most)


@pytest.mark.parametrize("options, loads, sign", [
    (IN_CONTACT, [0.1, 0.15, 0.3], "touching"),
    (NO_SKIN | {"adhesive": GLUE}, [0.02, 0.06, 0.1], "glue_damage"),
], ids=["contact", "damage"])
def test_it_goes_on_from_a_restart_as_if_nothing_had_been(options, loads, sign, tmp_path):
    whole = actuated(wing(**options), cable=loads)
    assert whole[-1].measures[sign] > 0.0
    begun = wing(**options).actuate(cable=loads[:2], restart=tmp_path)
    assert begun.converged
    resumed = wing(**options).actuate(cable=loads, resume=tmp_path)
    assert resumed.converged and len(resumed) == len(whole)
    for name, value in whole[-1].measures.items():
        assert resumed[-1].measures[name] == pytest.approx(value, rel=1e-10, abs=1e-10), name
    assert resumed[-1].external_work_Nmm == pytest.approx(whole[-1].external_work_Nmm, rel=1e-8)
