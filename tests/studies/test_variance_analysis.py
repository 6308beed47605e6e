"""Analysis of variance against what is known of it."""

import itertools

import numpy as np
import pandas as pd
import pytest
from scipy.stats import f_oneway

from morphing_wing.errors import InputError
from morphing_wing.studies.variance_analysis import variance_analysis

pytestmark = pytest.mark.quick


def test_one_factor_with_repeated_tests_has_the_f_and_p_of_a_one_way_analysis():
    chance = np.random.default_rng(1)
    groups = [chance.normal(mean, 1.0, 6) for mean in (0.0, 0.5, 1.2)]
    table = pd.DataFrame({"a": np.repeat(["x", "y", "z"], 6), "y": np.concatenate(groups)})
    found = variance_analysis(table, ["a"], "y").set_index("source")
    expected = f_oneway(*groups)
    assert found.loc["a", "F"] == pytest.approx(expected.statistic, rel=1e-12)
    assert found.loc["a", "p"] == pytest.approx(expected.pvalue, rel=1e-10)
    assert found["degrees_of_freedom"].tolist() == [2, 15]


def full(levels, response):
    rows = list(itertools.product(*(range(n) for n in levels)))
    table = pd.DataFrame(rows, columns=list("abc")[: len(levels)])
    return table.assign(y=[response(*row) for row in rows])


def test_squares_of_factors_pairs_and_rest_make_up_those_of_all_tests():
    table = full([2, 3, 4], lambda a, b, c: a + b**2 + a * c + 0.1 * a * b * c)
    found = variance_analysis(table, list("abc"), "y", interactions=True).set_index("source")
    total = ((table["y"] - table["y"].mean()) ** 2).sum()
    assert found["sum_of_squares"].sum() == pytest.approx(total, rel=1e-12)
    assert found["share"].sum() == pytest.approx(1.0) == found["contribution"].sum()
    assert found["degrees_of_freedom"].to_dict() == {
        "a": 1, "b": 2, "c": 3, "a x b": 2, "a x c": 3, "b x c": 6, "residual": 6}


def test_a_product_of_centred_factors_is_owed_to_their_pair_alone():
    found = variance_analysis(full([3, 3, 2], lambda a, b, c: (a - 1) * (b - 1)), list("abc"), "y",
                              interactions=True).set_index("source")
    assert found.loc["a x b", "share"] == pytest.approx(1.0)
    assert found["share"].drop("a x b").abs().max() < 1e-12


def test_where_nothing_is_left_over_there_is_no_f():
    for response in (lambda a, b: a + 2 * b, lambda a, b: 3.0):
        found = variance_analysis(full([2, 3], response), ["a", "b"], "y")
        assert found[["F", "p"]].isna().all().all()
        assert np.isfinite(found["share"]).all()


def test_a_missing_response_is_refused():
    table = full([2, 2], lambda a, b: np.nan if a and b else 1.0)
    with pytest.raises(InputError, match="y: must be known of every test"):
        variance_analysis(table, ["a", "b"], "y")
