"""Optimisation: optima on the formula, and corrected by finer rungs that disagree with it."""

import dataclasses
import json
import tomllib

import numpy as np
import pandas as pd
import pytest

from morphing_wing.errors import InputError
from morphing_wing.optimization import optimum as study
from morphing_wing.optimization.optimum import described, optimize
from morphing_wing.optimization.problem import Goal
from morphing_wing.optimization.problem_file import parse_problem, read_problem
from morphing_wing.optimization.report import report
from morphing_wing.optimization.rung_search import climb
from morphing_wing.studies.case import Case, run_case
from morphing_wing.studies.formula_outputs import formula_outputs

pytestmark = pytest.mark.quick

RIB = {
    "scene": "rib-validation", "rungs": ["instant", "draft"], "maximize": "chord_angle_deg",
    "base": {"loads.torque": "10 N mm", "geometry": {"section": "square",
                                                      "shaft_thickness": "1.4 mm"}},
    "variables": {"geometry.shaft_thickness": {"low": "1.0 mm", "high": "1.5 mm"},
                  "geometry.crossing_angle": {"low": "70 deg", "high": "110 deg"}},
    "constraints": {"rib_stress_MPa": {"max": "17 MPa"}, "length_mm": {"min": "base"}},
}


def on(name, *rungs, **changes):
    return dataclasses.replace(read_problem(name), rungs=rungs, **changes)


def random_best(problem, told, n=200_000):
    """Return the best of a dense random sample that holds all limits."""
    random = np.random.default_rng(5)
    values = {v.key: random.uniform(v.lowest, v.highest, n) for v in problem.variables}
    outputs, start = told(values), told({v.key: np.array([x]) for v, x in zip(
        problem.variables, problem.first, strict=True)})
    holds = np.ones(n, dtype=bool)
    for c in problem.constraints:
        limit = start[c.output][0] if c.limit is None else c.limit
        holds &= c.violation(outputs[c.output], limit) <= 0.0
    assert holds.sum() > 20
    return outputs[problem.goal.output][holds].max()


def by_formula(problem):
    case = problem.start.changed({"fidelity": "instant"})
    return lambda values: formula_outputs(case, values)


def driven(problem, finer, finest=None):
    """Return the designs of a search whose rungs after the formula are made up."""
    told = {"instant": by_formula(problem), "cell": finer, "standard": finest or finer}
    found, rows = [], []
    search = climb(problem, found)
    request = next(search)
    while True:
        outputs = told[request.rung]({v.key: np.array([x]) for v, x in zip(
            problem.variables, request.values, strict=True)})
        sent = np.array([outputs[name][0] for name in problem.outputs])
        rows.append((request, sent))
        try:
            request = search.send(sent if np.isfinite(sent).all() else None)
        except StopIteration:
            return found, rows


@pytest.mark.parametrize("name", ["spar", "table2"])
def test_the_optimum_of_the_formula_beats_a_dense_random_sample_and_is_a_kkt_point(name):
    problem = on(name, "instant")
    found = optimize(problem)
    best = found.best()
    assert found.converged and best["feasible"]
    assert best["span_angle_deg"] > random_best(problem, by_formula(problem)) - 2e-3
    assert found.found[0].residual < 1e-5
    assert all(price >= 0.0 for price in found.found[0].prices.values())


def test_at_its_mass_the_papers_choice_is_the_formulas_optimum():
    best = optimize(on("table2", "instant")).best()
    design = best["wall_length_mm"], best["cavity_length_mm"], best["top_thickness_mm"]
    assert design == pytest.approx((2.4, 2.4, 1.0), abs=5e-4)


def test_a_wing_can_be_a_problem_too():
    problem = parse_problem({
        "scene": "wing-no-skin", "match": "chord_angle_deg", "target": "20 deg",
        "rungs": ["draft", "standard"], "base": {"loads.cable": "0.1 N"},
        "variables": {"geometry.rib.shaft_thickness": {"low": "0.8 mm", "high": "1.2 mm"},
                      "elastomer.coefficients.0": {"low": "0.1 MPa", "high": "0.2 MPa"},
                      "loads.cable": {"low": "0 N", "high": "0.2 N"}},
        "constraints": {"mass_g": {"max": "base"}, "rib_2_rotation_deg": {"max": "40 deg"}}})
    assert [v.column for v in problem.variables] == [
        "rib_shaft_thickness_mm", "elastomer_coefficients_0_MPa", "cable_N"]
    assert list(problem.first) == [1.0, 0.117, 0.1]
    assert problem.case(problem.first, "draft").file.loads["cable"] == (0.1,)


def test_a_price_is_what_a_moved_limit_gains():
    problem = on("spar", "instant")
    found = optimize(problem)
    length = next(c for c in problem.constraints if c.output == "length_mm")
    longer = tuple(dataclasses.replace(c, limit=98.4 + 0.2) if c is length else c
                   for c in problem.constraints)
    gained = optimize(dataclasses.replace(problem, constraints=longer)).best()
    gain = gained["span_angle_deg"] - found.best()["span_angle_deg"]
    assert gain / 0.2 == pytest.approx(found.found[0].prices["length_mm max"], rel=0.02)


def disagreeing(problem):
    """Return a finer rung to which long chambers and thick middles mean what they do not here."""
    first = by_formula(problem)

    def told(values):
        outputs = dict(first(values))
        shape = next(iter(values.values())).shape
        chamber = values.get("geometry.cavity_length", np.full(shape, 2.4))
        wall = values.get("geometry.wall_length", np.full(shape, 2.4))
        outputs["span_angle_deg"] = (
            outputs["span_angle_deg"] * (1.0 + 0.5 * (chamber - 2.4)) * (2.4 / wall) ** 1.5)
        if "largest_stretch" in outputs:
            outputs["largest_stretch"] = outputs["largest_stretch"] + 0.05 * chamber**2
        return outputs

    return told


@pytest.mark.parametrize("name, most", [("table2", 25), ("spar", 60)])
def test_a_finer_rung_that_disagrees_is_followed_to_its_own_optimum(name, most):
    problem = on(name, "instant", "standard", evaluations=80)
    finer = disagreeing(problem)
    found, rows = driven(problem, finer)
    best = found[-1]
    values = {v.key: np.array([x]) for v, x in zip(problem.variables, best.values, strict=True)}
    angle = finer(values)["span_angle_deg"][0]
    assert best.settled and best.residual < 0.05
    assert angle > 0.998 * random_best(problem, finer)
    assert sum(request.rung == "standard" for request, _ in rows) <= most
    start = rows[[r.rung for r, _ in rows].index("standard")][1]
    for c, limit in ((c, start[problem.outputs.index(c.output)] if c.limit is None else c.limit)
                     for c in problem.constraints):
        assert c.violation(finer(values)[c.output][0], limit) <= 0.0


def test_a_third_rung_that_agrees_with_the_second_takes_few_designs():
    problem = on("spar", "instant", "cell", "standard", evaluations=80)
    _, rows = driven(problem, disagreeing(problem))
    counts = pd.Series([request.rung for request, _ in rows]).value_counts()
    assert counts["standard"] <= 3 < 20 < counts["cell"]


def test_a_third_rung_that_disagrees_as_well_is_followed_by_its_own_slopes():
    problem = on("table2", "instant", "cell", "standard", evaluations=80, own_slopes=True)
    second = disagreeing(problem)

    def third(values):  # with its own mind about the top
        outputs = dict(second(values))
        outputs["span_angle_deg"] = outputs["span_angle_deg"] * (
            0.5 + 3.0 * (values["geometry.top_thickness"] - 1.0))
        return outputs

    found, _ = driven(problem, second, third)
    values = {v.key: np.array([x]) for v, x in zip(
        problem.variables, found[-1].values, strict=True)}
    assert found[-2].values[2] == 1.0 < found[-1].values[2]
    assert third(values)["span_angle_deg"][0] > 0.998 * random_best(problem, third)


def test_designs_that_cannot_be_computed_are_gone_round():
    problem = on("table2", "instant", "standard")
    finer = disagreeing(problem)

    def told(values):
        outputs = finer(values)
        lost = values["geometry.cavity_length"] > 2.55
        outputs["span_angle_deg"] = np.where(lost, np.nan, outputs["span_angle_deg"])
        return outputs

    found, rows = driven(problem, told)
    assert any(np.isnan(sent).any() for _, sent in rows)
    assert 2.5 < found[-1].values[1] <= 2.55


def test_a_start_that_cannot_be_computed_is_refused():
    problem = on("table2", "instant", "standard")
    with pytest.raises(InputError, match="base: must be a design that can be computed on the "
                                         "rung 'standard'"):
        driven(problem, lambda values: {name: np.array([np.nan]) for name in problem.outputs})


def test_a_target_is_met():
    table = {key: RIB[key] for key in ("scene", "base", "variables")} | {
        "match": "chord_angle_deg", "target": "25 deg", "rungs": ["instant"]}
    found = optimize(parse_problem(table))
    assert found.best()["chord_angle_deg"] == pytest.approx(25.0, abs=2e-3)
    assert found.converged and found.found[0].prices == {}


def test_a_target_is_met_on_a_finer_rung_that_disagrees():
    problem = dataclasses.replace(
        on("table2", "instant", "standard"), goal=Goal("match", "span_angle_deg", 17.0))
    finer = disagreeing(problem)
    found, rows = driven(problem, finer)
    values = {v.key: np.array([x]) for v, x in zip(
        problem.variables, found[-1].values, strict=True)}
    assert finer(values)["span_angle_deg"][0] == pytest.approx(17.0, rel=2e-3)
    assert sum(request.rung == "standard" for request, _ in rows) < 20


def test_a_start_that_passes_a_limit_is_led_back():
    problem = on("table2", "instant")
    lighter = dataclasses.replace(problem.constraints[0], limit=49.0)
    found = optimize(dataclasses.replace(problem, constraints=(lighter,)))
    assert not found.rows[0]["feasible"] and found.converged
    assert 48.99 < found.best()["mass_g"] <= 49.0


def test_limits_that_nothing_holds_end_without_a_design_and_say_so(tmp_path):
    problem = on("table2", "instant")
    impossible = dataclasses.replace(problem.constraints[0], limit=10.0)
    found = optimize(dataclasses.replace(problem, constraints=(impossible,)))
    assert found.best() is None and found.design() is None and not found.converged
    assert found.reason() == "no design that holds all constraints was found"
    found.save(tmp_path)
    assert sorted(file.name for file in tmp_path.iterdir()) == [
        "optimum.png", "summary.json", "table.csv"]
    assert report(found)[-1] == found.reason()


@pytest.fixture(scope="module")
def rib():
    """Return an optimum whose limit on stress the formula does not know."""
    return optimize(parse_problem(RIB))


def test_a_limit_that_only_the_finer_rung_knows_is_held_there(rib):
    first, best = rib.start("draft"), rib.best("draft")
    assert rib.converged
    assert np.isnan(rib.start("instant")["rib_stress_MPa"])
    assert best["chord_angle_deg"] > 1.005 * first["chord_angle_deg"]
    assert 16.9 < best["rib_stress_MPa"] <= 17.0
    assert best["length_mm"] >= first["length_mm"] - 1e-9
    assert rib.found[-1].residual < 0.1


def test_without_a_formula_the_cheapest_rung_is_searched_from_the_start(rib):
    alone = optimize(parse_problem(RIB | {"rungs": ["draft"]}))
    assert alone.converged
    assert alone.best()["chord_angle_deg"] == pytest.approx(
        rib.best("draft")["chord_angle_deg"], rel=3e-3)


def test_what_is_saved_is_read_again_and_solved(rib, tmp_path):
    rib.save(tmp_path)
    table = pd.read_csv(tmp_path / "table.csv")
    assert len(table) == len(rib.rows) and set(table["rung"]) == {"instant", "draft"}
    summary = json.loads((tmp_path / "summary.json").read_text())
    assert summary["converged"] and summary["best"]["feasible"]
    assert summary["seconds"] == pytest.approx(table["seconds"].sum())
    assert summary["dofs"] == table["dofs"].max()
    assert summary["chord_angle_deg"] == list(rib.table()["chord_angle_deg"])
    assert {row["output"] for row in summary["limits"]} == {"rib_stress_MPa", "length_mm"}
    assert summary["problem"] == described(rib.problem)
    assert (tmp_path / "optimum.png").stat().st_size > 20_000
    text = (tmp_path / "design.toml").read_text()
    again = run_case(Case(tomllib.loads(text)), ("chord_angle_deg", "rib_stress_MPa"))
    for name in ("chord_angle_deg", "rib_stress_MPa"):
        assert again[name] == pytest.approx(rib.best()[name], rel=1e-12)


def test_designs_that_are_known_are_not_computed_again(rib, tmp_path, monkeypatch):
    rib.save(tmp_path, picture=False)
    table = pd.read_csv(tmp_path / "table.csv", float_precision="round_trip")
    table[["refused", "stopped", "warned"]] = table[["refused", "stopped", "warned"]].fillna("")
    computed = []
    monkeypatch.setattr(study, "run_case", lambda *given: computed.append(given) or run_case(
        *given))
    again = optimize(rib.problem, known=table.to_dict("records")[:-3])
    assert len(computed) == 3
    pd.testing.assert_frame_equal(again.table().drop(columns="seconds"),
                                  rib.table().drop(columns="seconds"))
