"""The parts of an optimisation: search of a box, layers of a model, what limits cost."""

import numpy as np
import pytest

from morphing_wing.optimization.box_search import best_in_box
from morphing_wing.optimization.layered_model import LayeredModel, unknown_direction
from morphing_wing.optimization.prices import prices
from morphing_wing.optimization.problem import Constraint
from morphing_wing.optimization.problem_file import parse_problem

pytestmark = pytest.mark.quick

PROBLEM = parse_problem({
    "scene": "spar-validation", "maximize": "span_angle_deg",
    "base": {"loads.upper": "20 kPa"},
    "variables": {"geometry.cavity_length": {"low": "2 mm", "high": "3 mm"},
                  "geometry.wall_length": {"low": "2 mm", "high": "2.5 mm"}},
    "constraints": {"mass_g": {"max": "base"}}})


def test_the_best_of_many_hollows_is_found():
    def rastrigin(x):
        y = 10.0 * (x - 0.7)
        return (y**2 - 10 * np.cos(2 * np.pi * y) + 10).sum(axis=1), np.zeros((len(x), 0))

    found = best_in_box(rastrigin, np.zeros(2), np.ones(2))
    np.testing.assert_allclose(found, 0.7, atol=1e-6)


def test_rosenbrocks_valley_in_a_disc_has_its_known_end():
    def pieces(x):  # Rosenbrock's function within x^2 + y^2 <= 1.5, minimum at (0.9072, 0.8228)
        a, b = (3.0 * x - 1.5).T
        return (1 - a) ** 2 + 100 * (b - a**2) ** 2, (a**2 + b**2 - 1.5)[:, None]

    a, b = 3.0 * best_in_box(pieces, np.zeros(2), np.ones(2)) - 1.5
    assert (a, b) == pytest.approx((0.9072, 0.8228), abs=2e-4)
    assert a**2 + b**2 == pytest.approx(1.5, abs=1e-6)


def test_where_nothing_holds_the_limits_the_least_violation_is_found():
    def pieces(x):
        return -x.sum(axis=1), (x - 0.3).sum(axis=1)[:, None] + 1.0

    np.testing.assert_allclose(best_in_box(pieces, np.zeros(2), np.ones(2)), 0.0, atol=1e-6)


def test_where_the_model_ends_the_rest_is_searched():
    def pieces(x):
        cost = np.where(x[:, 0] > 0.5, np.nan, -x[:, 0])
        return cost, np.zeros((len(x), 0))

    assert best_in_box(pieces, np.zeros(2), np.ones(2))[0] == pytest.approx(0.5, abs=1e-3)


def test_a_layer_has_what_the_finer_rung_told_and_keeps_a_linear_difference():
    model = LayeredModel(PROBLEM)
    random = np.random.default_rng(3)
    points, others = random.random((5, 2)), random.random((4, 2))

    def finer(at):
        return model(at) + np.stack([1.0 + 2.0 * at[:, 0] - at[:, 1], 0.0 * at[:, 0]], axis=1)

    corrected = model.with_layer(points, finer(points))
    np.testing.assert_allclose(corrected(points), finer(points), rtol=1e-9)
    np.testing.assert_allclose(corrected(others), finer(others), rtol=1e-9)
    twice = corrected.with_layer(points[:1], finer(points[:1]) + 0.5)
    np.testing.assert_allclose(twice(others), finer(others) + 0.5, rtol=1e-9)


def test_what_the_formula_does_not_know_is_told_by_layers_alone():
    rib = parse_problem({
        "scene": "rib-validation", "maximize": "chord_angle_deg", "rungs": ["instant", "draft"],
        "variables": {"geometry.shaft_thickness": {"low": "1 mm", "high": "1.5 mm"}},
        "constraints": {"rib_stress_MPa": {"max": "17 MPa"}}})
    model = LayeredModel(rib)
    assert list(model.known) == [True, False]
    points, outputs = np.array([[0.2], [0.5], [0.9]]), np.array([[9.0, 17.0], [8.0, 16.0], [7, 14]])
    corrected = model.with_layer(points, outputs)
    assert corrected.known.all()
    np.testing.assert_allclose(corrected(points), outputs, rtol=1e-9)
    assert np.isfinite(corrected(np.array([[0.7]]))).all()


def test_values_of_points_have_six_digits_and_stay_between_the_bounds():
    model = LayeredModel(PROBLEM)
    values = model.values(np.array([1.0 / 3.0, 1.0]))
    assert list(values) == [2.33333, 2.5]
    np.testing.assert_allclose(model.inside(values), [1.0 / 3.0, 1.0], atol=1e-5)


def test_directions_without_points_are_named_one_variable_at_a_time():
    centre = np.full(3, 0.5)
    points = [centre]
    for _ in range(3):
        direction = unknown_direction(np.array(points), centre, 0.1)
        assert np.linalg.norm(direction) == pytest.approx(1.0)
        points.append(centre + 0.1 * direction)
    assert unknown_direction(np.array(points), centre, 0.1) is None
    assert unknown_direction(np.array(points), centre, 0.01) is not None  # all too far away
    flat = np.array([centre, centre + [0.1, 0.1, 0.0], centre + [0.1, -0.1, 0.0]])
    np.testing.assert_allclose(np.abs(unknown_direction(flat, centre, 0.1)), [0, 0, 1], atol=1e-12)


def test_prices_are_the_multipliers_of_a_known_programme():
    # max 3 a + 2 b with a + b <= 1.2 and a <= 1 (the bound): multipliers 2 and 1, at (1, 0.2).
    c = Constraint("mass_g", "max", 1.2)

    def pieces(x):
        return -(3 * x[:, 0] + 2 * x[:, 1]), ((x.sum(axis=1) - 1.2) / 1.2)[:, None]

    found, residual = prices(PROBLEM, {c: 1.2}, 1.0, np.array([1.0, 0.2]), pieces)
    assert found == pytest.approx({"mass_g max": 2.0, "geometry.cavity_length max": 1.0}, rel=1e-6)
    assert residual == pytest.approx(0.0, abs=1e-8)
    # Half a degree per mm, for the second variable's range is half a mm.
    found, _ = prices(PROBLEM, {c: 1.2}, 1.0, np.array([0.1, 0.0]),
                      lambda x: (x[:, 1], pieces(x)[1]))
    assert found == {"geometry.wall_length min": pytest.approx(2.0)}
    inside, residual = prices(PROBLEM, {c: 1.2}, 1.0, np.array([0.5, 0.5]), pieces)
    assert inside == {} and residual == 1.0
