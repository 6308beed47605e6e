"""Range analysis: by hand, and on the paper's two tables, which finds what they misprint."""

import numpy as np
import pandas as pd
import pytest

from morphing_wing.errors import InputError
from morphing_wing.printed_tables import TABLE_2, TABLE_3
from morphing_wing.range_analysis import best_levels, range_analysis

pytestmark = pytest.mark.quick

TESTS = pd.DataFrame({"a": ["low", "low", "high", "high"], "b": [1, 2, 1, 2],
                      "y": [1.0, 2.0, 5.0, 8.0]})


def test_means_ranges_and_squares_by_hand():
    levels = range_analysis(TESTS, ["a", "b"], "y")
    assert list(levels["level"]) == ["low", "high", "1", "2"]
    assert list(levels["mean"]) == [1.5, 6.5, 3.0, 5.0]
    assert list(levels["range"]) == [5.0, 5.0, 2.0, 2.0]
    # The mean is 4: 4 rows 2.5 away, 4 rows 1 away; 9 + 4 + 1 + 16 in all.
    assert list(levels["sum_of_squares"]) == [25.0, 25.0, 4.0, 4.0]
    assert levels["share"].to_numpy() == pytest.approx(np.array([25, 25, 4, 4]) / 30)
    assert best_levels(levels) == {"a": "high", "b": "2"}


def test_levels_are_told_without_rounding_errors():
    levels = range_analysis(TESTS.assign(a=[0.9 * 2.2, 0.9 * 2.2, 2.2, 2.2]), ["a", "b"], "y")
    assert 0.9 * 2.2 != 1.98 and list(levels["level"]) == ["1.98", "2.2", "1", "2"]


def test_squares_of_factors_without_interaction_make_up_all():
    added = TESTS.assign(y=[1.0, 4.0, 3.0, 6.0])
    levels = range_analysis(added, ["a", "b"], "y")
    assert levels.groupby("factor")["share"].first().sum() == pytest.approx(1.0)


def test_alike_tests_have_no_effects():
    assert (range_analysis(TESTS.assign(y=2.0), ["a", "b"], "y")[["range", "share"]] == 0.0).all(
        axis=None)


def test_tests_that_are_not_orthogonal_are_refused():
    with pytest.raises(InputError, match="a and b: must have each pair of levels in equally many"):
        range_analysis(TESTS.iloc[:3], ["a", "b"], "y")
    with pytest.raises(InputError, match="y: must be known of every test"):
        range_analysis(TESTS.assign(y=[1.0, np.nan, 1.0, 1.0]), ["a", "b"], "y")


@pytest.mark.parametrize("printed", [TABLE_2, TABLE_3], ids=["table2", "table3"])
def test_printed_means_and_ranges_are_those_of_the_rows_but_for_one_misprint(printed):
    both = printed.levels.merge(printed.stated, on=["factor", "level"])
    assert len(printed.rows) == len(both) == 9
    sound = both[~both["level"].isin(printed.misprints["level"])]
    assert sound["stated_mean_deg"].to_numpy() == pytest.approx(sound["mean"], abs=0.0051)
    wrong = both[(both["stated_range_deg"] - both["range"]).abs() > 0.01]
    assert set(wrong["factor"]) == set(printed.misprints["factor"])


def test_table_3_misprints_a_mean_by_three_degrees():
    [slip] = TABLE_3.misprints.itertuples()
    assert (slip.factor, slip.level, slip.stated_mean_deg) == ("T_rs/l_cs", "2/5", 24.354)
    assert slip.mean == pytest.approx(21.354, abs=5e-4)
    assert slip.range == pytest.approx(22.723, abs=5e-4)
    assert TABLE_3.slips() == [
        "Misprint: Table 3 has 24.354 as the mean of T_rs/l_cs = 2/5; its rows give 21.354, so "
        "that R is 22.723, not 19.723."]


def test_table_2_best_combination_is_not_that_of_the_largest_means():
    assert TABLE_2.untested == {"l_s1": "2.4", "l_c": "2.8", "h_t": "1.0"}
    [slip] = TABLE_2.slips()
    assert "is the best of the rows tested (8, 18.22 deg)" in slip
    assert TABLE_3.untested is None and best_levels(TABLE_3.levels) == TABLE_3.stated_best


def test_h_t_and_T_rs_are_what_matters_most():
    share = TABLE_2.levels.groupby("factor")["share"].first()
    assert share["h_t"] == pytest.approx(0.63, abs=0.01)
    assert share["l_s1"] == pytest.approx(0.36, abs=0.01)
    assert TABLE_3.levels.groupby("factor")["share"].first().idxmax() == "T_rs/l_cs"
