"""Studies of functions whose answer is known, and of scenes."""

import os
import subprocess
import sys

import numpy as np
import pandas as pd
import pytest

from morphing_wing.analytic_spar import SparFormula
from morphing_wing.built_in import built_in_studies
from morphing_wing.errors import InputError
from morphing_wing.geometry import SparGeometry
from morphing_wing.materials import DRAGON_SKIN_30
from morphing_wing.studies.case import Case
from morphing_wing.studies.designs import Design
from morphing_wing.studies.factors import Factor
from morphing_wing.studies.pictures import label
from morphing_wing.studies.study import Study
from morphing_wing.studies.study_file import parse_study

pytestmark = pytest.mark.quick

INSTANT = Case.of("spar-n4", {"fidelity": "instant", "loads.upper": 0.02})
THICKNESS = Factor("geometry.top_thickness", low=0.9, high=1.4, column="top_thickness_mm")
WALL = Factor("geometry.wall_length", low=1.8, high=2.6, column="wall_length_mm")


def ishigami(x):
    return np.sin(x["x1"]) + 7.0 * np.sin(x["x2"]) ** 2 + 0.1 * x["x3"] ** 4 * np.sin(x["x1"])


def test_sobol_indices_of_ishigamis_function_are_the_analytic_ones_within_5_percent():
    a, b = 7.0, 0.1
    of_1, of_2 = 0.5 * (1 + b * np.pi**4 / 5) ** 2, a**2 / 8
    of_13 = b**2 * np.pi**8 * (1 / 18 - 1 / 50)
    total = of_1 + of_2 + of_13
    factors = [Factor(f"x{i}", low=-np.pi, high=np.pi) for i in (1, 2, 3)]
    study = Study(ishigami, factors, Design("sobol", points=4096, second_order=True), ["y"])
    found = study.run().analysis_of("indices", "y").set_index("factor")
    for name, index, exact in (
            ("x1", "S1", of_1), ("x2", "S1", of_2), ("x1", "ST", of_1 + of_13),
            ("x2", "ST", of_2), ("x3", "ST", of_13), ("x1 x x3", "S2", of_13)):
        assert found.loc[name, index] == pytest.approx(exact / total, rel=0.05)
    for name, index in (("x3", "S1"), ("x1 x x2", "S2"), ("x2 x x3", "S2")):
        assert abs(found.loc[name, index]) < 0.01
    for name, exact in (("x1", of_1 + of_13), ("x2", of_2), ("x3", of_13)):
        assert abs(found.loc[name, "ST"] - exact / total) < found.loc[name, "ST_conf"]


def formula(x):
    geometry = SparGeometry(2.8, x["wall"], x["top"], 6.0, 2.8, 1.2, 40.0, 4)
    return SparFormula(geometry, DRAGON_SKIN_30).angle(0.02)


def test_sobol_indices_of_the_formulas_spar_are_those_of_integrals_over_its_dimensions():
    places, weights = np.polynomial.legendre.leggauss(8)
    tops, walls = 1.15 + 0.25 * places, 2.2 + 0.4 * places
    y = np.array([[formula({"top": t, "wall": w}) for w in walls] for t in tops])
    w = weights / 2.0
    mean = w @ y @ w
    variance = w @ (y - mean) ** 2 @ w
    first = np.array([w @ (y @ w - mean) ** 2, w @ (w @ y - mean) ** 2]) / variance
    factors = [Factor("top", low=0.9, high=1.4), Factor("wall", low=1.8, high=2.6)]
    found = Study(formula, factors, Design("sobol", points=512), ["angle"]).run()
    indices = found.analysis_of("indices", "angle")
    assert indices["S1"].to_numpy() == pytest.approx(first, rel=0.05)
    assert indices["ST"].to_numpy() == pytest.approx(1.0 - first[::-1], rel=0.05)


def test_a_study_of_a_scene_computes_what_the_scene_computes():
    found = Study(INSTANT, [THICKNESS, WALL], Design("latin_hypercube", points=5),
                  ["span_angle_deg", "mass_g"]).run().table
    assert list(found) == ["top_thickness_mm", "wall_length_mm", "span_angle_deg", "mass_g", "dofs",
                           "newton_iterations", "seconds", "refused", "stopped", "warned"]
    for row in found.itertuples():
        geometry = SparGeometry(2.8, row.wall_length_mm, row.top_thickness_mm, 6.0, 2.8, 1.2,
                                40.0, 4)
        assert row.span_angle_deg == SparFormula(geometry, DRAGON_SKIN_30).angle(0.02)
        assert row.mass_g == pytest.approx(1080e-6 * geometry.volume, rel=1e-12)


def test_the_built_in_l9_study_has_table_2s_rows_and_level_means():
    from morphing_wing.table2 import table2

    result = parse_study(built_in_studies()["spar-l9"], "spar-l9").run()
    paper = table2(fidelities=("instant",))
    rows = next(iter(paper.parts.values())).dropna(subset="printed_deg")
    angles = {tuple(float(row[c].split()[0]) for c in paper.printed.factors): row["span_angle_deg"]
              for row in rows.to_dict("records")}
    ours = result.table
    keys = ours[["wall_length_mm", "cavity_length_mm", "top_thickness_mm"]].itertuples(index=False)
    assert [angles[tuple(key)] for key in keys] == pytest.approx(ours["span_angle_deg"], rel=1e-12)
    expected = paper.levels().query("fidelity == 'instant'")
    levels = result.analysis_of("levels", "span_angle_deg")
    for name in ("mean", "range"):
        assert sorted(levels[name]) == pytest.approx(sorted(expected[f"{name}_deg"]), rel=1e-12)


def test_bad_cases_are_recorded_and_the_others_are_computed():
    thin = Factor("geometry.top_thickness", levels=(-1.0, 1.0, 1.2), column="t")
    pressure = Factor("loads.upper", levels=(0.02, 0.9), column="p")
    result = Study(INSTANT, [thin, pressure], Design("full_factorial"), ["span_angle_deg"]).run()
    table = result.table
    assert (table["refused"] != "").tolist() == [True, True, False, False, False, False]
    assert (table["stopped"] != "").tolist() == [False, False, False, True, False, True]
    assert np.isfinite(table["span_angle_deg"]).tolist() == [False, False, True, False, True, False]
    said = result.sentences()
    assert any("geometry.top_thickness = -1 mm: must be a finite length" in s for s in said)
    assert any("span_angle_deg: must be known of every test" in s for s in said)
    assert result.analyses == {}


def test_blocks_with_bad_cases_are_left_out_of_sobol_indices():
    def broken(x):
        if x["a"] > 0.97:
            raise ValueError("too large")
        return x["a"] + 2.0 * x["b"]

    factors = [Factor("a", low=0.0, high=1.0), Factor("b", low=0.0, high=1.0)]
    result = Study(broken, factors, Design("sobol", points=256), ["y"]).run()
    assert set(result.bad["stopped"]) == {"unexpected ValueError: too large"}
    found = result.analysis_of("indices", "y")
    assert found["ST"].to_numpy() == pytest.approx([0.2, 0.8], abs=0.05)
    assert "blocks of cases with bad ones among them are left out" in result.sentences()[-1]


def test_rank_correlation_is_one_where_a_response_rises_and_effects_are_slopes():
    factors = [Factor("a", low=1.0, high=2.0), Factor("word", levels=("x", "y"))]
    sample = Study(lambda x: np.exp(x["a"]), factors, Design("latin_hypercube", points=30), ["y"])
    found = sample.run().analysis_of("correlations", "y").set_index("factor")
    assert found.loc["a", "spearman"] == pytest.approx(1.0)
    assert np.isnan(found.loc["word", "spearman"])
    alone = Study(lambda x: 3.0 * x["a"] + (x["word"] == "y"), factors,
                  Design("one_at_a_time", levels=3), ["y"])
    effects = alone.run().analysis_of("effects", "y").set_index("factor")
    assert effects.loc["a", ["change", "slope", "elasticity"]].tolist() == pytest.approx([3, 3, 1])
    assert effects.loc["word", "change"] == 1.0


def test_a_linear_response_has_its_slopes_times_spreads_as_standardized_coefficients():
    factors = [Factor("a", low=0.0, high=1.0), Factor("b", low=0.0, high=3.0)]
    result = Study(lambda x: 2.0 * x["a"] - 5.0 * x["b"], factors,
                   Design("latin_hypercube", points=40), ["y"]).run()
    found = result.analysis_of("correlations", "y").set_index("factor")
    spread = result.table[["a", "b", "y"]].std()
    assert found["standardized_coefficient"].tolist() == pytest.approx(
        [2.0 * spread["a"] / spread["y"], -5.0 * spread["b"] / spread["y"]])
    assert found["r_squared"].tolist() == pytest.approx([1.0, 1.0])


@pytest.mark.parametrize(("kind", "pictures"), [
    ({"kind": "orthogonal", "levels": 3}, {"main_effects.png", "variance.png"}),
    ({"kind": "full_factorial", "levels": 2}, {"main_effects.png", "variance.png"}),
    ({"kind": "one_at_a_time", "levels": 3}, {"one_at_a_time.png"}),
    ({"kind": "latin_hypercube", "points": 9}, {"scatter.png"}),
    ({"kind": "sobol", "points": 16}, {"sobol.png", "scatter.png"}),
])
def test_a_study_writes_its_table_its_analyses_and_its_pictures(kind, pictures, tmp_path):
    factors = [Factor("a_mm", low=0.5, high=1.0), Factor("b", low=1.0, high=2.0),
               Factor("c", low=0.0, high=1.0)]
    study = Study(lambda x: {"y_deg": x["a_mm"] * x["b"] + x["c"] ** 2, "z": x["b"]}, factors,
                  Design(**kind), ["y_deg", "z"])
    result = study.run()
    result.save(tmp_path)
    names = {file.name for file in tmp_path.iterdir()}
    assert names == pictures | {"table.csv", "summary.json"} | {
        f"{name}.csv" for name in result.analyses}
    read = pd.read_csv(tmp_path / "table.csv", index_col="case", keep_default_na=False,
                       float_precision="round_trip")
    pd.testing.assert_frame_equal(read, result.table, check_dtype=False)


def test_a_study_that_is_all_bad_writes_its_table_all_the_same(tmp_path):
    def broken(x):
        raise InputError("a: must be another")

    result = Study(broken, [Factor("a", low=0.0, high=1.0)], Design("latin_hypercube", points=3),
                   ["y"]).run()
    result.save(tmp_path)
    assert (result.table["refused"] == "a: must be another").all()
    assert {file.name for file in tmp_path.iterdir()} >= {"table.csv", "summary.json"}


def test_columns_become_words_with_units():
    assert [label(name) for name in ("top_thickness_mm", "elastomer_coefficients_0_MPa", "n_cells",
                                     "resin_density_kg_m3")] == [
        "top thickness, mm", "elastomer C10, MPa", "n cells", "resin density, kg/m³"]


@pytest.mark.parametrize("name", built_in_studies())
def test_built_in_studies_can_be_computed_case_by_case(name):
    study = parse_study(built_in_studies()[name], name)
    for row in study.inputs().sample(3, random_state=1).to_dict("records"):
        study.case.changed({f.key: row[f.column] for f in study.factors}).file  # noqa: B018


SCRIPT = """
import os
from morphing_wing.studies.designs import Design
from morphing_wing.studies.factors import Factor
from morphing_wing.studies.study import Study

def deadly(x):
    if x["a"] == 3:
        os._exit(9)
    return 2.0 * x["a"]

def surroundings(x):
    from mpi4py import MPI
    return {"ranks": MPI.COMM_WORLD.size, "threads": float(os.environ["OMP_NUM_THREADS"]),
            "parent": os.getppid()}

if __name__ == "__main__":
    from mpi4py import MPI
    factor = Factor("a", levels=(1, 2, 3, 4, 5))
    table = Study(deadly, [factor], Design("full_factorial"), ["y"]).run(workers=2).table
    print(table["y"].fillna(-1.0).tolist(), (table["stopped"] != "").tolist())
    print(table["stopped"].max())
    table = Study(surroundings, [factor], Design("full_factorial"), ["ranks", "threads", "parent"]
                  ).run(workers=2).table
    print(set(table["ranks"]), set(table["threads"]), set(table["parent"]) == {os.getpid()})
"""


def test_a_case_that_kills_its_process_is_recorded_and_each_process_has_its_own_mpi(tmp_path):
    (tmp_path / "script.py").write_text(SCRIPT)
    alone = {name: value for name, value in os.environ.items()
             if not name.startswith(("OMPI_", "PMIX_"))} | {
        "OMPI_ALLOW_RUN_AS_ROOT": "1", "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM": "1"}
    run = subprocess.run([sys.executable, "script.py"], cwd=tmp_path, env=alone, text=True,
                         capture_output=True, timeout=300)
    assert run.returncode == 0, run.stderr[-2000:]
    said = run.stdout.splitlines()
    assert said[0] == "[2.0, 4.0, -1.0, 8.0, 10.0] [False, False, True, False, False]"
    assert "the process that computed it was gone" in said[1]
    assert said[2] == "{1.0} {1.0} True"
