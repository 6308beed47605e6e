"""Scene files: keys are the fields of the classes, values arrive in the package's units."""

import dataclasses
import re

import numpy as np
import pytest

from morphing_wing.cli import built_in_scenes
from morphing_wing.errors import InputError
from morphing_wing.geometry.rib import RibGeometry
from morphing_wing.geometry.spar import SparGeometry
from morphing_wing.geometry.wing import WingGeometry
from morphing_wing.materials import DRAGON_SKIN_30, RESIN, Adhesive, Elastic, Yeoh
from morphing_wing.scene_file import parse_scene
from morphing_wing.scene_keys import ElastomerKeys, ResinKeys, RibKeys, SparKeys, WingKeys

pytestmark = pytest.mark.quick

BUILT_IN = built_in_scenes()


def scene(text):
    return parse_scene(text, "scene.toml")


def spar(geometry='preset = "validation"', loads='upper = "1 kPa"', more=""):
    return scene(f'scene = "spar"\n[geometry]\n{geometry}\n[loads]\n{loads}\n{more}')


def wing(geometry, loads='upper = "1 kPa"'):
    return scene(f'scene = "wing"\n[geometry]\n{geometry}\n[loads]\n{loads}').geometry


@pytest.mark.parametrize(
    ("keys", "shape"),
    [(SparKeys, SparGeometry), (RibKeys, RibGeometry), (WingKeys, WingGeometry),
     (ElastomerKeys, Yeoh), (ResinKeys, Elastic)],
)  # fmt: skip
def test_keys_of_a_table_are_the_fields_of_its_class(keys, shape):
    fields = {field.name for field in dataclasses.fields(shape)}
    assert set(keys.model_fields) - {"preset"} == fields


def test_preset_alone_is_the_papers_set_and_materials():
    read = spar()
    assert read.geometry == SparGeometry.validation()
    assert read.materials == {"material": DRAGON_SKIN_30}
    assert read.fidelity == "standard"


def test_values_replace_those_of_the_preset_in_mm():
    geometry = spar('preset = "validation"\nn_cells = 4\ntop_thickness = "0.14 cm"').geometry
    expected = dataclasses.replace(SparGeometry.validation(), n_cells=4, top_thickness=1.4)
    assert geometry.top_thickness == pytest.approx(1.4, rel=1e-14)
    assert dataclasses.replace(geometry, top_thickness=1.4) == expected


def test_geometry_without_preset_is_given_in_full():
    fields = [f.name for f in dataclasses.fields(SparGeometry)[:-2]]
    lines = [f'{name} = "{i + 1} mm"' for i, name in enumerate(fields)]
    walls = 'wall_lengths = ["1 mm", "0.2 mm", "1 mm", "1 mm"]'
    geometry = spar("\n".join([*lines, "n_cells = 3", walls])).geometry
    assert dataclasses.astuple(geometry) == (1, 2, 3, 4, 5, 6, 7, 3, (1.0, 0.2, 1.0, 1.0))


def test_fidelity_of_the_caller_takes_the_place_of_the_files():
    text = 'scene = "spar"\nfidelity = "standard"\n[geometry]\npreset = "validation"\n[loads]\n'
    assert parse_scene(text + 'upper = "1 kPa"', "file", "draft").fidelity == "draft"


def test_loads_are_one_value_a_list_or_evenly_spaced():
    assert spar(loads='upper = "20 kPa"').loads == {"upper": pytest.approx((0.02,))}
    listed = spar(loads='upper = ["0 kPa", "5 kPa", "0.02 MPa"]\nlower = "1 kPa"').loads
    assert listed == {"upper": pytest.approx((0.0, 0.005, 0.02)), "lower": pytest.approx((1e-3,))}
    spaced = spar(loads='upper = { to = "40 kPa", points = 9 }').loads["upper"]
    np.testing.assert_allclose(spaced, np.linspace(0.0, 0.04, 9), rtol=1e-14)
    spaced = spar(loads='upper = { from = "40 kPa", to = "10 kPa", points = 4 }').loads["upper"]
    np.testing.assert_allclose(spaced, [0.04, 0.03, 0.02, 0.01], rtol=1e-14)
    assert spaced[-1] == 0.01


def test_elastomer_takes_the_default_bulk_modulus_of_its_own_shear_modulus():
    read = spar(more='[elastomer]\ncoefficients = ["0.2 MPa", "-1 kPa", "10 Pa"]')
    assert read.materials["material"].coefficients == pytest.approx((0.2, -1e-3, 1e-5))
    assert read.materials["material"].bulk == pytest.approx(400.0)
    stiff = spar(more='[elastomer]\nbulk = "1 GPa"').materials["material"]
    assert spar(more='[elastomer]\ndensity = "1.2 g/cm^3"').materials["material"].density == (
        pytest.approx(1200.0))
    assert stiff == Yeoh(DRAGON_SKIN_30.coefficients, bulk=1000.0)


def test_resin_takes_one_constant_and_keeps_the_other():
    head = 'scene = "rib"\n[geometry]\npreset = "prototype"\n[loads]\ncable = "1 N"\n[resin]\n'
    assert scene(head + 'E = "2.37 GPa"').materials["material"].E == pytest.approx(2370.0)
    assert scene(head + "nu = 0.4").materials["material"] == Elastic(RESIN.E, 0.4)


def test_none_switches_skin_and_ribs_off():
    bare = wing('preset = "prototype"\nskin_thickness = "none"\nrib = "none"')
    assert bare.skin_thickness is None and bare.rib is None


def test_skin_of_a_wing_is_built_as_the_file_says():
    lines = ('skin_root = "free"', "tip_wall = true", "skin_over_spar = true",
             'skin_slit = "lower"', "skin_prestretch = [1.1, 1]")
    assert wing("\n".join(lines)) == WingGeometry.prototype(
        skin_root="free", tip_wall=True, skin_over_spar=True, skin_slit="lower",
        skin_prestretch=(1.1, 1.0))


def test_ribs_of_a_wing_change_from_those_of_its_preset():
    rib = wing('[geometry.rib]\nn_cells = 12\ncrossing_angle = "80 deg"').rib
    base = WingGeometry.prototype().rib
    assert rib == dataclasses.replace(base, n_cells=12, crossing_angle=80.0)


def test_gravity_is_a_plain_number_a_list_or_evenly_spaced():
    head = 'scene = "wing"\n[geometry]\npreset = "prototype"\n[loads]\ngravity = '
    assert scene(head + "1").loads == {"gravity": (1.0,)}
    assert scene(head + "[0.0, -1.5]").loads["gravity"] == (0.0, -1.5)
    assert scene(head + "{ to = 1.0, points = 3 }").loads["gravity"] == (0.0, 0.5, 1.0)


def test_guide_of_a_rib_is_a_point_in_mm():
    text = 'scene = "rib"\n[geometry]\npreset = "prototype"\n[loads]\ncable = "0.1 N"\n'
    read = scene(text + 'guide = ["1 cm", "-50 mm", "0 mm"]')
    assert read.loads["guide"] == pytest.approx((10.0, -50.0, 0.0))


def test_the_nine_built_in_scenes_are_there():
    assert set(BUILT_IN) == {
        "spar-validation", "spar-n4", "rib-validation", "rib-prototype", "wing-pressure",
        "wing-cables", "wing-combined", "wing-spar-only", "wing-no-skin",
    }  # fmt: skip


@pytest.mark.parametrize("name", BUILT_IN)
def test_built_in_scene_is_read_and_describes_itself_in_its_first_line(name):
    read = scene(BUILT_IN[name])
    assert read.scene == name.split("-")[0]
    assert re.match(r"# \w.{20,90}\.\n", BUILT_IN[name])
    assert max(map(len, BUILT_IN[name].splitlines())) <= 100


@pytest.mark.parametrize("name", BUILT_IN)
def test_values_in_a_built_in_scenes_comments_are_the_defaults(name):
    """A reader who uncomments a line must not change the scene by that."""
    # The adhesive's table is an example: by default there is none.
    text = re.sub(r"(?ms)^# \[adhesive\].*?\n\n", "", BUILT_IN[name])
    text = re.sub(r'(?m)^# (?=\w+ = (?!"none"))(?!guide|torque|lower|upper|cable|gravity =)', "",
                  text)
    text = re.sub(r"(?m)^# (?=\[)", "", text)
    assert text.count("#") < BUILT_IN[name].count("#") - 5
    plain, spelled = scene(BUILT_IN[name]), scene(text)
    assert spelled.materials.pop("rib_model", "frame") == "frame"  # draft's
    assert spelled.materials == plain.materials and spelled.loads == plain.loads
    for field in dataclasses.fields(plain.geometry):
        expected, given = (getattr(s.geometry, field.name) for s in (plain, spelled))
        if field.name.startswith("foot_") and expected is None:
            height, width = plain.geometry.foot() if plain.geometry.rib else (given, given)
            expected = height if field.name == "foot_height" else width
            assert given == pytest.approx(expected, abs=0.005)
        elif field.name == "rib_positions":
            assert given == pytest.approx(expected, abs=1e-4)
        else:
            assert given == expected, field.name


GLUED = '''scene = "wing"
[geometry]
preset = "prototype"
{}
[adhesive]
{}
[loads]
upper = "1 kPa"
'''


def test_an_adhesive_takes_its_stiffness_from_the_geometry_unless_given():
    law = 'strength = "1 MPa"\ntoughness = "500 J/m^2"'
    read = scene(GLUED.format('glue_stiffness = "20 N/mm^3"', law))
    assert read.materials["adhesive"] == Adhesive(20.0, 1.0, 0.5)
    assert read.materials["contact"] is True


def test_the_ribs_model_is_the_files_or_the_fidelitys():
    text = GLUED.format("", "")
    assert "rib_model" not in scene(text).materials
    assert scene('rib_model = "cell"\n' + text).materials["rib_model"] == "cell"
    with pytest.raises(InputError, match="rib_model = 'beam'"):
        scene('rib_model = "beam"\n' + text)
    with pytest.raises(InputError, match="rib_model: must be left out where rib is"):
        scene('rib_model = "cell"\n' + GLUED.format('rib = "none"', "").replace("[adhesive]", ""))


@pytest.mark.parametrize("geometry, law, said", [
    ("", 'strength = "1 MPa"', "adhesive.toughness: is missing, must be given with strength"),
    ("", 'toughness = "1 N/mm"', "adhesive.toughness: is given without strength"),
    ("", 'strength = "1 MPa"\ntoughness = "1 J/m^2"', "more than 0.01 N/mm"),
    ('rib = "none"', 'strength = "1 MPa"\ntoughness = "1 N/mm"', "must be left out where rib"),
    ("", 'strength = "1 N"', "adhesive.strength"),
    ('glue_stiffness = "20 N/mm^3"', 'stiffness = "30 N/mm^3"', "both given: must be one of them"),
])
def test_glue_that_cannot_be_is_refused(geometry, law, said):
    with pytest.raises(InputError, match=re.escape(said)):
        scene(GLUED.format(geometry, law))
