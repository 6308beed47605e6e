"""The inverse: loads for wanted angles, by the sensitivities of the model's own tangent."""

import re

import numpy as np
import pytest

from morphing_wing import aim
from morphing_wing.errors import InputError
from morphing_wing.sensitivity import sensitivities
from tests.scenes.small_wing import NO_RIBS, NO_SKIN, SPAR, actuated, angles, wing

WORDS = {"upper_MPa": "upper", "lower_MPa": "lower", "cable_N": "cable"}
STEP = {"upper_MPa": 1e-4, "lower_MPa": 1e-4, "cable_N": 1e-4}


class Killed(Exception):
    """What ends a run from outside."""


def wanted(state):
    return {"span": state.measures["span_angle_deg"], "chord": state.measures["chord_angle_deg"]}


def loads(trimmed):
    return {word: trimmed.loads[name] for name, word in WORDS.items()}


@pytest.mark.parametrize("changes, at", [
    ({}, {"upper": 0.02, "cable": 0.1}), (NO_SKIN, {"lower": 0.03, "cable": 0.3}),
], ids=["all", "no skin"])
def test_sensitivities_are_the_differences_of_full_solves(changes, at):
    scene = wing(**changes)
    before = actuated(scene, **at)[-1]
    used = [name for name, word in WORDS.items() if word in at]
    found = sensitivities(scene, used)
    assert scene.angles() == angles(before)
    for name in used:
        ends = [actuated(scene, **at | {WORDS[name]: at[WORDS[name]] + sign * STEP[name]})[-1]
                for sign in (1.0, -1.0)]
        assert found[name].keys() == angles(before).keys()
        for angle, rate in found[name].items():
            ahead, behind = (end.measures[angle] for end in ends)
            assert rate == pytest.approx((ahead - behind) / (2.0 * STEP[name]), rel=1e-5), angle


def test_a_load_that_is_not_in_use_has_sensitivities_too():
    scene = wing(**NO_SKIN)
    actuated(scene, upper=0.02)
    rate = sensitivities(scene, ["cable_N"])["cable_N"]["chord_angle_deg"]
    behind, ahead = actuated(scene, upper=0.02, cable=[0.0, 1e-4])
    change = ahead.measures["chord_angle_deg"] - behind.measures["chord_angle_deg"]
    assert rate == pytest.approx(change / 1e-4, rel=1e-3)


@pytest.mark.parametrize("changes, given", [
    ({}, {"upper": 0.03, "lower": 0.0, "cable": 0.2}),
    (NO_SKIN, {"upper": 0.03, "lower": 0.0, "cable": 0.2}),
    (NO_SKIN, {"upper": 0.0, "lower": 0.02, "cable": 0.4}),
], ids=["all", "no skin", "no skin, down"])
def test_angles_of_a_forward_run_give_its_loads_back(changes, given):
    end = actuated(wing(**changes), **given)[-1]
    scene = wing(**changes)
    trimmed = scene.trim(**wanted(end))
    assert trimmed.converged and trimmed.reason == "the wanted angles were reached"
    assert loads(trimmed) == pytest.approx(given, rel=1e-4)
    assert trimmed.iterations <= 8
    assert trimmed.path.converged and trimmed.path[-1].load == trimmed.loads
    assert len(trimmed.path) == trimmed.iterations + 1
    # The wing stands there: what it measures now is what is returned.
    assert scene.angles() == angles(trimmed.path[-1])
    table = sensitivities(scene, [name for name in WORDS if trimmed.loads[name]])
    np.testing.assert_allclose(trimmed.sensitivities, np.transpose([
        [factor * rates[f"{angle}_angle_deg"] for angle in ("span", "chord")]
        for rates, factor in zip(table.values(), (1e-3, 1.0), strict=True)]), rtol=1e-6)


def test_a_span_angle_alone_leaves_the_cables_as_they_are():
    scene = wing(**NO_SKIN)
    actuated(scene, cable=0.1)
    trimmed = scene.trim(span=1.0)
    assert trimmed.converged and trimmed.angles["span_angle_deg"] == pytest.approx(1.0, abs=1e-4)
    assert trimmed.loads["cable_N"] == 0.1 and trimmed.loads["upper_MPa"] > 0.01
    assert np.isfinite(trimmed.sensitivities[:, 0]).all()
    assert np.isnan(trimmed.sensitivities[:, 1]).all()


def test_a_chord_angle_alone_leaves_the_pressures_as_they_are():
    scene = wing(**NO_SKIN)
    actuated(scene, upper=0.01, lower=0.02)
    trimmed = scene.trim(chord=35.0)
    assert trimmed.converged and trimmed.angles["chord_angle_deg"] == pytest.approx(35, abs=1e-4)
    assert (trimmed.loads["upper_MPa"], trimmed.loads["lower_MPa"]) == (0.01, 0.02)
    assert np.isnan(trimmed.sensitivities[:, 0]).all()


def test_a_negative_span_angle_is_of_the_lower_chambers_wherever_the_wing_stands():
    scene, fresh = wing(**SPAR), wing(**SPAR)
    actuated(scene, upper=0.02)
    for trimmed in (scene.trim(span=-1.5), fresh.trim(span=-1.5)):
        assert trimmed.converged and trimmed.loads["upper_MPa"] == 0.0
        assert trimmed.angles == {"span_angle_deg": pytest.approx(-1.5, abs=1e-4)}
        assert trimmed.loads["lower_MPa"] == pytest.approx(0.0306, abs=1e-3)


@pytest.mark.parametrize("changes, ask, met, reason", [
    (SPAR, {"span": 12}, None,
     r"^span = 3\.\d+ of 12 deg is the nearest: upper is at max_pressure = 0\.06 MPa$"),
    (SPAR, {"span": -2, "max_pressure": 0.01}, None, r": lower is at max_pressure = 0\.01 MPa$"),
    (NO_SKIN, {"span": 1, "chord": 30, "max_cable": 0.1}, "span",
     r"^span = 1 of 1 deg, chord = 20\.\d+ of 30 deg is .*: cable is at max_cable = 0\.1 N$"),
    (NO_SKIN, {"span": 10, "chord": 20}, "chord", r": upper is at max_pressure = 0\.06 MPa$"),
    (NO_SKIN, {"span": 1, "chord": 80}, "span",
     r"^span = 1 of 1 deg, chord = 6\d\.\d+ of 80 deg .*: no change of the loads brings it"),
    ({}, {"span": 1, "chord": -3}, "span", r": cable is at 0 N$"),
    (NO_SKIN, {"span": 1, "chord": 30, "max_iterations": 2}, None, "max_iterations = 2 are used"),
], ids=["pressure", "lower", "cable", "pressure of two", "saturated", "slack", "iterations"])
def test_what_cannot_be_reached_is_said_from_the_nearest_state(changes, ask, met, reason):
    scene = wing(**changes)
    trimmed = scene.trim(**ask)
    assert not trimmed.converged and not trimmed.path.converged
    assert trimmed.reason == trimmed.path.reason
    assert re.search(reason, trimmed.reason), trimmed.reason
    assert scene.angles() == angles(trimmed.path[-1]) and trimmed.path[-1].load == trimmed.loads
    assert min(trimmed.loads.values()) >= 0.0
    if met:
        assert trimmed.angles[f"{met}_angle_deg"] == pytest.approx(ask[met], abs=1e-4)


def test_cables_that_at_rest_turn_the_chord_the_other_way_are_pulled_all_the_same(monkeypatch):
    def misled(scene, loads):
        rates = sensitivities(scene, loads)
        if scene.loads["cable_N"][0].value == 0.0:
            rates["cable_N"]["chord_angle_deg"] *= -1.0
        return rates

    monkeypatch.setattr(aim, "sensitivities", misled)
    trimmed = wing(**NO_SKIN).trim(chord=20.0)
    assert trimmed.converged, trimmed.reason
    assert trimmed.angles["chord_angle_deg"] == pytest.approx(20.0, abs=1e-4)


def test_a_limit_point_of_the_elastomer_is_told_and_not_raised():
    scene, cuts = wing(**SPAR), []
    trimmed = scene.trim(span=60, max_pressure=2.0, on_cut=lambda load, reason: cuts.append(reason))
    assert not trimmed.converged and cuts
    assert "is the nearest: stopped after upper = 0.1" in trimmed.reason
    assert trimmed.angles["span_angle_deg"] > 5.0
    assert np.isfinite(trimmed.sensitivities[0, 0])


def test_far_beyond_its_maximum_the_angle_is_found_from_without_load():
    scene = wing(**NO_SKIN)
    actuated(scene, cable=5.0)
    trimmed = scene.trim(chord=20.0)
    assert trimmed.converged and trimmed.loads["cable_N"] == pytest.approx(0.0929, abs=1e-3)


def test_a_killed_trim_goes_on_from_its_last_step(tmp_path):
    steps = []

    def kill_at_the_third(state):
        steps.append(state)
        if len(steps) == 3:
            raise Killed

    with pytest.raises(Killed):
        wing(**NO_SKIN).trim(span=1.0, chord=30.0, restart=tmp_path, on_step=kill_at_the_third)
    resumed = wing(**NO_SKIN).trim(span=1.0, chord=30.0, restart=tmp_path, resume=tmp_path)
    assert [state.load for state in resumed.path[:3]] == [state.load for state in steps]
    whole = wing(**NO_SKIN).trim(span=1.0, chord=30.0)
    assert resumed.converged and loads(resumed) == pytest.approx(loads(whole), rel=1e-4)
    assert resumed.path[-1].external_work_Nmm == pytest.approx(
        whole.path[-1].external_work_Nmm, rel=1e-2)


@pytest.mark.quick
@pytest.mark.parametrize("changes, ask, text", [
    ({}, {}, "^span and chord are both None: one or both must be an angle in deg$"),
    ({}, {"span": "12 deg"}, "^span = '12 deg' deg: must be an angle between -180 and 180 deg, or"),
    ({}, {"span": float("nan")}, "^span = nan deg: must be an angle"),
    ({}, {"chord": 200}, "^chord = 200 deg: must be an angle"),
    ({}, {"chord": -5}, "^chord = -5 deg: must be 0 deg or more: that way the cables pull$"),
    ({"cable_guide": (0.0, 100.0, 0.0)}, {"chord": 5}, "^chord = 5 deg: must be 0 deg or less"),
    (NO_RIBS, {"chord": 5}, "^chord = 5 deg: must be left out in a wing without ribs, at whose"),
    ({}, {"span": 1, "max_pressure": 0}, "^max_pressure = 0 MPa: must be greater than 0 MPa$"),
    ({}, {"span": 1, "max_cable": -1}, "^max_cable = -1 N: must be greater than 0 N$"),
    ({}, {"span": 1, "tolerance": 0}, "^tolerance = 0 deg: must be greater than 0 deg$"),
    ({}, {"span": 1, "max_iterations": 0}, "^max_iterations = 0: must be a whole number"),
])
def test_angles_that_are_none_are_refused_in_one_sentence(changes, ask, text):
    with pytest.raises(InputError, match=text) as refusal:
        wing(**changes).trim(**ask)
    assert "\n" not in str(refusal.value)
