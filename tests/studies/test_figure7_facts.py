"""The facts of Figure 7, told from tables whose answers are known."""

import numpy as np
import pandas as pd
import pytest

from morphing_wing.figure7_facts import facts, reached_at, words
from tests.studies.made_up import curve, study

pytestmark = pytest.mark.quick


def only(table, kind="curves"):
    (found,) = facts(table)[kind]
    return found


def test_pressure_of_12_degrees_is_interpolated_between_points():
    fact = only(curve("pressure"))  # 600 degrees per MPa
    assert fact["reached_at"] == pytest.approx(0.02)
    assert words(fact) == "12 deg at 20 kPa"


def test_the_trailing_edge_in_space_may_be_what_the_protractor_read():
    table = curve("cables", trailing_edge_deg=[0.0, 20.0, 40.0, 80.0])
    fact = only(table)
    assert words(fact, "space_") == "35 deg at 0.175 N"
    assert words(only(curve("pressure")), "space_") == "-"


def test_an_angle_that_is_not_reached_is_told_with_the_last_load():
    fact = only(curve("pressure"))
    assert fact["line_reached_at"] is None
    assert words(fact, "line_") == "not reached, 9 deg at 30 kPa"


def test_tension_of_35_degrees_is_interpolated_and_upwards_alike():
    for direction, sign in (("down", 1), ("up", -1)):
        fact = only(curve("cables", direction=direction))
        assert fact["reached_at"] == pytest.approx(0.35)
        assert fact["last_angle_deg"] == pytest.approx(40.0 * sign)


def test_the_least_load_counts_where_a_curve_passes_its_limit_twice():
    assert reached_at(np.array([1.0, 2.0, 3.0, 4.0]), np.array([10, 20, 5, 30]), 15) == 1.5


def test_a_curve_that_begins_beyond_its_limit_is_interpolated_from_rest():
    assert reached_at(np.array([4.0]), np.array([24.0]), 12.0) == pytest.approx(2.0)


def test_coupling_is_the_other_angle_over_the_main_one_at_the_last_load():
    by_pressure, by_cables = facts(study(curve("pressure"), curve("cables")))["curves"]
    assert by_pressure["coupling"] == pytest.approx(12.0 / 600.0)
    assert by_pressure["coupling_deg"] == pytest.approx(0.36)
    assert by_cables["coupling"] == pytest.approx(-0.1)


def test_a_wing_without_chord_angle_has_no_coupling():
    fact = only(curve("pressure").drop(columns=["chord_angle_deg", "chord_line_deg"]))
    assert fact["coupling"] is None and fact["coupling_deg"] is None


def test_contact_and_instability_are_told_from_the_first_load_on():
    table = curve("cables", contact=[False, False, True, True], negative_pivots=[0, 0, 0, 1])
    fact = only(table)
    assert (fact["contact_from"], fact["unstable_from"]) == (0.2, 0.4)
    assert only(table.drop(columns="contact"))["contact_from"] is None


def test_resin_yields_where_the_stress_passes_35_MPa():
    assert only(curve("cables"))["resin_yields_at"] is None
    fact = only(curve("cables", rib_stress_MPa=[0.0, 20.0, 30.0, 50.0]))
    assert fact["resin_yields_at"] == pytest.approx(0.25)


def test_fidelities_are_compared_with_the_finest_load_by_load():
    coarse = curve("pressure", span_angle_deg=[0.0, 6.3, 18.18])
    fact = only(study(curve("pressure", fidelity="standard"), coarse), "fidelities")
    assert (fact["fidelity"], fact["against"]) == ("draft", "standard")
    assert fact["largest_difference"] == pytest.approx(0.05)
    assert fact["at_load"] == pytest.approx(0.01)


def test_fidelities_are_compared_at_loads_that_both_were_asked_for_and_reached():
    stopped = curve("pressure", fidelity="standard", factor=1.25, loads=[0.0, 0.01])
    between = curve("pressure", loads=[0.0, 0.005, 0.01, 0.03],
                    requested=[True, False, True, True])
    fact = only(study(stopped, between), "fidelities")
    assert fact["largest_difference"] == pytest.approx(0.2)
    assert fact["at_load"] == pytest.approx(0.01)


def test_skin_stiffens_by_the_ratio_of_the_angles_at_the_last_common_load():
    bare = curve("cables", factor=4.0, skin=False, loads=[0.0, 0.1, 0.2])
    fact = only(study(curve("cables"), bare), "skin")
    assert fact["load"] == pytest.approx(0.2)
    assert (fact["with_deg"], fact["without_deg"]) == (pytest.approx(20.0), pytest.approx(80.0))
    assert fact["without_over_with"] == pytest.approx(4.0)


def test_one_curve_is_compared_with_nothing():
    found = facts(curve("pressure"))
    assert found["fidelities"] == [] and found["skin"] == []


def test_nothing_has_no_facts():
    assert facts(pd.DataFrame()) == {"curves": [], "fidelities": [], "skin": []}
