"""A case is a scene file with changes: the same checks, the same figures."""

import dataclasses
import math
import pickle
import subprocess
import sys

import numpy as np
import pytest

from morphing_wing.errors import InputError
from morphing_wing.geometry import RibGeometry, SparGeometry, WingGeometry, WingMeshing
from morphing_wing.geometry.wing_mesh import wing_mesh
from morphing_wing.mass import mass
from morphing_wing.scene_dimensions import as_value, column_of, kind_of, unit_of
from morphing_wing.scene_file import parse_scene
from morphing_wing.studies import case_outputs
from morphing_wing.studies.case import Case, run_case
from morphing_wing.studies.case_outputs import check_outputs
from morphing_wing.wing_rungs import FIDELITIES

pytestmark = pytest.mark.quick

INSTANT = Case.of("spar-n4", {"fidelity": "instant", "loads.upper": 0.02})


def changed(**changes):
    return INSTANT.changed({key.replace("__", "."): value for key, value in changes.items()})


def test_numbers_in_the_packages_units_are_what_the_file_would_say_in_text():
    numbers = changed(geometry__top_thickness=1.2, geometry__n_cells=3.0, loads__upper=0.015,
                      elastomer__density=1100)
    texts = changed(geometry__top_thickness="1.2 mm", geometry__n_cells=3,
                    loads__upper="15 kPa", elastomer__density="1100 kg/m^3")
    assert numbers.file == texts.file
    assert numbers.file.geometry == SparGeometry(2.8, 2.2, 1.2, 6.0, 2.8, 1.2, 40.0, 3)
    assert numbers.file.loads == {"upper": (0.015,)}


@pytest.mark.parametrize(("key", "value", "sentence"), [
    ("geometry.top_thicknes", 1.0, "geometry.top_thicknes: unknown key, must be one of preset, "),
    ("geometry.top_thickness", -1.0, "geometry.top_thickness = -1 mm: must be a finite length"),
    ("geometry.top_thickness", "1 kPa", "geometry.top_thickness = '1 kPa': must be a length"),
    ("geometry.top_thickness", math.nan, "must be a finite length"),
    ("geometry.n_cells", 2.5, "geometry.n_cells = 2.5: must be"),
    ("geometry.n_cells.0", 2, "geometry.n_cells.0: unknown key, geometry.n_cells has no such part"),
    ("loads.upper", math.inf, "loads.upper = 'inf MPa': must be a finite pressure"),
    ("loads.cable", 1.0, "loads.cable: unknown key, must be one of upper, lower of loads"),
    ("elastomer.coefficients.2", 1.0, "elastomer.coefficients.2: must be one of 2 entries, 0 to 1"),
    ("fidelity", "best", "fidelity = 'best': must be one of instant"),
    ("geometry", 1.0, "geometry: is a table, must be one of its keys: preset, cavity_length"),
    ("scene", "rib", "scene: cannot be changed, must remain 'spar'"),
])
def test_a_wrong_change_is_refused_by_its_key_in_one_sentence(key, value, sentence):
    with pytest.raises(InputError) as refused:
        INSTANT.changed({key: value}).file  # noqa: B018
    said = str(refused.value)
    assert sentence in said and said.startswith("spar-n4: ") and said.count("spar-n4") == 1


def test_entries_of_a_list_change_alone():
    case = changed(elastomer__coefficients__0=0.12, elastomer__coefficients__1=-0.0005)
    assert case.file.materials["material"].coefficients == (0.12, -0.0005)
    assert changed(elastomer__coefficients__1=0.0).file.materials["material"].coefficients == (
        0.117, 0.0)


def test_a_scene_file_is_looked_for_in_its_folder(tmp_path):
    (tmp_path / "mine.toml").write_text('scene = "spar"\ngeometry.preset = "validation"\n'
                                        'loads.upper = "20 kPa"\n')
    assert Case.of("mine.toml", folder=tmp_path).value("loads.upper") == 0.02
    with pytest.raises(InputError, match="mine.toml: cannot be read, no such file"):
        Case.of("mine.toml", folder=tmp_path / "elsewhere")


def test_the_value_of_a_key_that_the_file_leaves_out_is_the_presets():
    wing = Case.of("wing-cables")
    assert [INSTANT.value(key) for key in (
        "geometry.cavity_length", "loads.upper", "loads.lower", "elastomer.coefficients.0",
        "elastomer.density", "fidelity")] == [2.8, 0.02, 0.0, 0.117, 1080.0, "instant"]
    assert wing.value("geometry.rib.shaft_length") == RibGeometry.prototype().shaft_length
    assert wing.value("resin.E") == 2500.0
    with pytest.raises(InputError, match=r"geometry.rib.n_shafts: unknown key"):
        wing.value("geometry.rib.n_shafts")


def test_columns_carry_the_units_of_keys_and_text_with_them_is_read_back_exactly():
    columns = {key: column_of("wing", key) for key in (
        "geometry.rib.pivot_diameter", "geometry.rib.crossing_angle", "loads.cable", "resin.E",
        "loads.gravity", "geometry.n_cells", "adhesive.toughness", "elastomer.coefficients.0")}
    assert list(columns.values()) == [
        "rib_pivot_diameter_mm", "rib_crossing_angle_deg", "cable_N", "resin_E_MPa", "gravity_g",
        "n_cells", "adhesive_toughness_N_mm", "elastomer_coefficients_0_MPa"]
    assert (kind_of("wing", "geometry.spar_fraction"), unit_of("rib", "loads.torque")) == (
        None, "N mm")
    for value in np.random.default_rng(3).uniform(0.5, 3.0, 50):
        assert changed(geometry__top_thickness=value).file.geometry.top_thickness == value
    assert as_value("wing", "geometry.rib_positions", (0.25, 0.75)) == [0.25, 0.75]


def test_a_case_can_be_pickled_and_describing_it_loads_no_dolfinx():
    case = changed(geometry__top_thickness=1.3)
    assert case.file == pickle.loads(pickle.dumps(case)).file
    code = ("import sys, morphing_wing.studies.case as c; c.Case.of('spar-n4').file; "
            "sys.exit('dolfinx' in sys.modules)")
    assert subprocess.run([sys.executable, "-c", code], timeout=60).returncode == 0


def test_a_case_ends_where_the_scene_file_ends():
    text = ('scene = "spar"\nfidelity = "draft"\n[geometry]\npreset = "validation"\nn_cells = 1\n'
            '[loads]\nupper = ["10 kPa", "20 kPa"]\n')
    file = parse_scene(text, "spar.toml")
    path = file.run(file.build())
    asked = ["span_angle_deg", "energy_Nmm", "largest_stretch", "external_work_Nmm",
             "material_stability"]
    found = run_case(Case.of("spar-n4", {
        "geometry.n_cells": 1, "fidelity": "draft", "loads.upper": ["10 kPa", "20 kPa"]}), asked)
    last = path.table().iloc[-1]
    assert [found[name] for name in asked] == pytest.approx(list(last[asked]), rel=1e-12)
    assert found["newton_iterations"] == path.table()["newton_iterations"].sum()
    assert (found["dofs"], found["refused"], found["stopped"]) == (path.scene.dofs, "", "")


def test_what_cannot_be_computed_is_told_and_not_raised():
    refused = run_case(changed(geometry__wall_length=-1), ["span_angle_deg"])
    assert refused["refused"].startswith("spar-n4: geometry.wall_length = -1 mm: must be")
    stopped = run_case(changed(loads__upper=0.5), ["span_angle_deg", "mass_g"])
    assert "the formula goes to" in stopped["stopped"] and math.isnan(stopped["span_angle_deg"])
    unknown = run_case(INSTANT, ["span_angle"])
    assert "output 'span_angle': must be one of span_angle_deg, " in unknown["refused"]
    fieldless = run_case(Case.of("rib-validation", {"fidelity": "instant"}), ["rib_stress_MPa"])
    assert "must be left out where fidelity is 'instant'" in fieldless["refused"]


@pytest.mark.parametrize("scene, changes, key", [
    ("rib-validation", {"fidelity": "cell"}, "fidelity is 'cell'"),
    ("wing-no-skin", {"rib_model": "cell"}, "rib_model is 'cell'"),
    ("wing-no-skin", {"fidelity": "reference"}, "fidelity is 'reference'"),
])
def test_chains_of_cells_are_asked_for_no_stress_before_they_are_condensed(scene, changes, key):
    with pytest.raises(InputError, match=f"'rib_stress_MPa': must be left out where {key}, of a"):
        check_outputs(Case.of(scene, changes).file, ["rib_stress_MPa"])
    frame = changes | ({"rib_model": "frame"} if scene.startswith("wing") else
                       {"fidelity": "draft"})
    check_outputs(Case.of(scene, frame).file, ["rib_stress_MPa"])


def test_the_rungs_of_wings_with_cell_ribs_are_known_without_building_any():
    assert case_outputs._RIB_MODELS == {name: "cell" for name, rung in FIDELITIES.items()
                                        if rung.rib_model == "cell"}


def test_a_wings_rib_model_has_a_value():
    assert Case.of("wing-no-skin", {"rib_model": "cell"}).value("rib_model") == "cell"
    assert Case.of("wing-no-skin").value("rib_model") is None


def test_mass_is_density_times_the_meshes_volume():
    spar = changed(geometry__wall_lengths=[2.0, 1.0, 2.5, 2.2, 3.0]).changed({"fidelity": "draft"})
    assert mass(spar.file) == pytest.approx(
        1080e-6 * spar.file.geometry.mesh(half=False).volume(), rel=1e-12)
    wing = WingGeometry.prototype()
    elastomer = 1080e-6 * wing_mesh(wing, WingMeshing.coarse()).volume()
    assert mass(Case.of("wing-pressure").file) == pytest.approx(
        elastomer + 3 * 1180e-6 * wing.rib.volume, rel=1e-12)
    bare = dataclasses.replace(wing, rib=None)
    assert mass(Case.of("wing-pressure", {"geometry.rib": "none"}).file) == pytest.approx(
        1080e-6 * wing_mesh(bare, WingMeshing.coarse()).volume(), rel=1e-12)


def test_a_ribs_volume_is_that_of_its_shafts_and_the_free_part_of_its_pivots():
    rib = RibGeometry(6.0, 1.0, 1.5, 5.0, 90.0, 3, "square")
    shafts, pivots = 3 * 3, 2 * (2 + 2 + 3)
    expected = shafts * 6.0 * 1.0 + pivots * 5.0 * np.pi * 1.5**2 / 4
    assert rib.volume == pytest.approx(expected, rel=1e-12)


def asked(name, **changes):
    return run_case(changed(geometry__n_cells=2, **changes), [name])[name]


def test_the_ballooning_margin_falls_from_one_towards_zero_at_the_limit_point():
    # Draft's limit point is at 92 kPa (README, Extremes).
    margins = [asked("ballooning_margin", fidelity="draft", loads__upper=pressure)
               for pressure in (1e-4, 0.044, 0.088)]
    assert margins[0] == pytest.approx(1.0, abs=5e-3)
    assert 0.0 < margins[2] < 0.3 < margins[1] < 0.8


def test_the_formulas_ballooning_margin_is_the_slope_of_its_pressure_over_that_at_rest():
    low, high, step = 1e-7, 0.15, 1e-5
    at_rest = asked("span_angle_deg", loads__upper=low) / low
    there = (asked("span_angle_deg", loads__upper=high + step)
             - asked("span_angle_deg", loads__upper=high - step)) / (2 * step)
    assert asked("ballooning_margin", loads__upper=high) == pytest.approx(at_rest / there, rel=1e-4)
