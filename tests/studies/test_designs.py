"""Designs put together what they promise to."""

import itertools

import numpy as np
import pandas as pd
import pytest

from morphing_wing.errors import InputError
from morphing_wing.studies.designs import Design
from morphing_wing.studies.factors import Factor
from morphing_wing.studies.orthogonal_arrays import array_names, orthogonal_array

pytestmark = pytest.mark.quick

LEVELS = {"L4": [2] * 3, "L8": [2] * 7, "L9": [3] * 4, "L12": [2] * 11, "L16(2^15)": [2] * 15,
          "L16(4^5)": [4] * 5, "L18": [2] + [3] * 7, "L25": [5] * 6, "L27": [3] * 13,
          "L32(2^31)": [2] * 31, "L32(2^1 4^9)": [2] + [4] * 9, "L36": [2] * 11 + [3] * 12,
          "L50": [2] + [5] * 11, "L54": [2] + [3] * 25, "L64": [4] * 21, "L81": [3] * 40}


def ranges(n, **more):
    return [Factor(f"x{i}", low=0.0, high=1.0 + i, **more) for i in range(n)]


@pytest.mark.parametrize("name", LEVELS)
def test_each_pair_of_columns_of_an_array_has_each_pair_of_levels_equally_often(name):
    array = orthogonal_array(LEVELS[name], name)
    assert len(array) == int(name[1:].split("(")[0])
    for a, b in itertools.combinations(range(array.shape[1]), 2):
        counts = np.zeros((LEVELS[name][a], LEVELS[name][b]))
        np.add.at(counts, (array[:, a], array[:, b]), 1)
        assert np.ptp(counts) == 0 and counts[0, 0] > 0


def test_the_arrays_above_are_all_that_there_are():
    assert array_names() == list(LEVELS)


@pytest.mark.parametrize(("levels", "tests"), [
    ([2, 2, 2], 4), ([3, 3, 3], 9), ([3] * 5, 18), ([2, 3, 3], 18), ([3] * 8, 27),
    ([6, 3, 3], 18), ([4, 4], 16), ([5] * 3, 25), ([2] * 4, 8)])
def test_the_shortest_array_that_fits_is_taken(levels, tests):
    assert len(orthogonal_array(levels)) == tests


@pytest.mark.parametrize(("levels", "name", "sentence"), [
    ([3] * 5, "L9", "array = 'L9' has not a column for each factor (5 of 3 levels)"),
    ([7, 7], None, "no array has a column for each factor (2 of 7 levels)"),
    ([3], "L10", "array = 'L10': must be one of L4, L8, L9"),
])
def test_what_no_array_has_is_refused(levels, name, sentence):
    with pytest.raises(InputError) as refused:
        orthogonal_array(levels, name)
    assert sentence in str(refused.value)


def test_a_full_factorial_has_each_combination_once():
    factors = [Factor("a", levels=("x", "y")), Factor("b", low=0, high=4, whole=True),
               Factor("c", low=1.0, high=2.0)]
    table = Design("full_factorial", levels=3).table(factors, {})
    assert len(table.drop_duplicates()) == len(table) == 2 * 3 * 3
    assert sorted(set(table["b"])) == [0, 2, 4] and sorted(set(table["c"])) == [1.0, 1.5, 2.0]


def test_a_latin_hypercube_has_one_point_in_each_slice_of_each_factor():
    table = Design("latin_hypercube", points=20, seed=3).table(ranges(4), {})
    for i, column in enumerate(table):
        assert sorted(np.floor(table[column] * 20 / (1.0 + i)).astype(int)) == list(range(20))
    assert table.equals(Design("latin_hypercube", points=20, seed=3).table(ranges(4), {}))
    assert not table.equals(Design("latin_hypercube", points=20, seed=4).table(ranges(4), {}))


def test_levels_share_a_latin_hypercube_evenly():
    factors = [Factor("f", levels=("a", "b", "c")), Factor("n", low=2, high=5, whole=True)]
    table = Design("latin_hypercube", points=12).table(factors, {})
    assert table["f"].value_counts().tolist() == [4, 4, 4]
    assert table["n"].value_counts().to_dict() == {2: 3, 3: 3, 4: 3, 5: 3}


def test_one_factor_at_a_time_leaves_the_others_as_they_are():
    base = {"x0": 0.25, "x1": 2.0}
    table = Design("one_at_a_time", levels=3).table(ranges(2), base)
    assert table["varied"].tolist() == ["none", "x0", "x0", "x0", "x1", "x1"]  # 2.0 is the base's
    for name, other in (("x0", "x1"), ("x1", "x0")):
        assert set(table.loc[table["varied"] != name, name]) == {base[name]}
        assert set(table.loc[table["varied"] == name, other]) == {base[other]}


def test_sobols_sample_has_blocks_that_differ_in_one_factor_from_each_other():
    table = Design("sobol", points=8).table(ranges(3), {}).to_numpy().reshape(8, 5, 3)
    for i in range(3):
        from_a = table[:, 0] != table[:, 1 + i]
        assert from_a[:, i].all() and not np.delete(from_a, i, axis=1).any()
    assert len(Design("sobol", points=8, second_order=True).table(ranges(3), {})) == 8 * 8


@pytest.mark.parametrize(("make", "sentence"), [
    (lambda: Design("best"), "design.kind = 'best': must be one of orthogonal, full_factorial, "),
    (lambda: Design("sobol", points=100), "design.points = 100: must be a power of two"),
    (lambda: Design("latin_hypercube"), "design.points = None: must be a whole number"),
    (lambda: Design("latin_hypercube", points=1), "design.points = 1: must be 2 or more"),
    (lambda: Design("full_factorial", points=9), "design.points = 9: must be left out where kind"),
    (lambda: Design("orthogonal", seed=1), "design.seed = 1: must be left out where kind"),
    (lambda: Design("full_factorial").table(ranges(2), {}), "x0: must have levels, or design."),
    (lambda: Design("full_factorial", levels=200).table(ranges(3), {}), "of cases = 8000000: must"),
    (lambda: Factor("x", low=1.0), "x: high is missing, must have levels, or low and high"),
    (lambda: Factor("x", low=2.0, high=1.0, unit="mm"), "x: high = 1 mm: must be more than low"),
    (lambda: Factor("x", low=0.0, high=float("nan")), "x: high = nan: must be a finite number"),
    (lambda: Factor("x", levels=(1, 1)), "x: levels = [1, 1]: must be two or more different"),
    (lambda: Factor("x", low=1, high=2, levels=(1, 2)), "x: must have levels, or low and high, no"),
    (lambda: Factor("x", low=1.5, high=3, whole=True), "x: low = 1.5: must be a whole number"),
    (lambda: Factor("x", low=1, high=2, whole=True).chosen(3), "must have 3 whole numbers from 1"),
])
def test_designs_and_factors_that_cannot_be_are_refused(make, sentence):
    with pytest.raises(InputError) as refused:
        make()
    assert sentence in str(refused.value)


def test_tables_of_designs_have_a_column_for_each_factor():
    for design in (Design("orthogonal", levels=2), Design("full_factorial", levels=2),
                   Design("latin_hypercube", points=4), Design("sobol", points=2)):
        table = design.table(ranges(3), {})
        assert isinstance(table, pd.DataFrame) and list(table) == ["x0", "x1", "x2"]
