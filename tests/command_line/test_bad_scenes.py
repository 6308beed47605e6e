"""Whatever is wrong with a scene file: one sentence, exit status 2, nothing written."""

import pytest

from morphing_wing.cli import main

pytestmark = pytest.mark.quick

SPAR = {
    "head": 'scene = "spar"',
    "geometry": 'preset = "validation"\nn_cells = 2',
    "loads": 'upper = "10 kPa"',
}
RIB = {"head": 'scene = "rib"', "geometry": 'preset = "validation"', "loads": 'torque = "5 N mm"'}
WING = {"head": 'scene = "wing"', "geometry": 'preset = "prototype"', "loads": 'upper = "5 kPa"'}


def toml(scene, **changes):
    parts = scene | changes
    tables = [f"[{name}]\n{text}" for name, text in parts.items() if name != "head"]
    return "\n".join([parts["head"], *tables])


def geometry(scene, line):
    return toml(scene, geometry='preset = "validation"\n' + line)


def wing(line):
    return toml(WING, geometry=line)


def loads(scene, line):
    return toml(scene, loads=line)


# name: (file, what the sentence must say)
BROKEN = {
    "empty file": ("", "scene: is missing, must be one of spar, rib, wing"),
    "no TOML": ("scene = [", "must be valid TOML"),
    "key twice": ('scene = "spar"\nscene = "rib"', "must be valid TOML"),
    "unknown scene": ('scene = "kite"', "scene = 'kite': must be one of spar, rib, wing"),
    "scene as list": ("scene = []", "scene = []: must be one of spar, rib, wing"),
    "no geometry": ('scene = "spar"\n[loads]\nupper = "1 kPa"', "geometry: is missing"),
    "no loads": ('scene = "spar"\n[geometry]\npreset = "validation"', "loads: is missing"),
    "empty loads": (loads(SPAR, ""), "loads: is empty, must have one of upper, lower"),
    "unknown table": (toml(SPAR, wind="speed = 3"), "wind: unknown key"),
    "unknown key": (
        geometry(SPAR, 'top_thicknes = "1 mm"'), "geometry.top_thicknes: unknown key, must be"),
    "unknown preset": (
        toml(SPAR, geometry='preset = "best"'), "geometry.preset = 'best': must be 'validation'"),
    "missing field without preset": (
        toml(SPAR, geometry="n_cells = 2"), "geometry.cavity_length: is missing"),
    "unknown fidelity": (
        toml(SPAR, head='scene = "spar"\nfidelity = "best"'),
        "fidelity = 'best': must be one of instant, cell, draft, standard"),
    "fidelity that a rib has not": (
        toml(RIB, head='scene = "rib"\nfidelity = "finest"'),
        "fidelity = 'finest': must be one of instant, cell, draft, standard, reference, or auto"),
    "bare number for a length": (
        geometry(SPAR, "top_thickness = 1.2"), "geometry.top_thickness = 1.2: must be a length"),
    "number without unit in text": (
        geometry(SPAR, 'top_thickness = "1.2"'), "'1.2': must be a length"),
    "length for a pressure": (
        loads(SPAR, 'upper = "20 mm"'), "loads.upper = '20 mm': must be a pressure"),
    "pressure for a length": (geometry(SPAR, 'wall_length = "2 kPa"'), "must be a length"),
    "bare number for a pressure": (loads(SPAR, "upper = 0.02"), "loads.upper = 0.02: must be a"),
    "bare number for an angle": (geometry(RIB, "crossing_angle = 70"), "must be an angle"),
    "per cent for an angle": (geometry(RIB, 'crossing_angle = "70 percent"'), "must be an angle"),
    "unknown unit": (geometry(SPAR, 'wall_length = "2 furlings"'), "must be a length"),
    "unit that would take for ever": (
        geometry(SPAR, 'wall_length = "2 mm**(9**9**9)"'), "must be a length"),
    "not finite length": (geometry(SPAR, 'wall_length = "nan mm"'), "must be a finite length"),
    "infinite pressure": (loads(SPAR, 'upper = "inf kPa"'), "must be a finite pressure"),
    "overflowing pressure": (loads(SPAR, 'upper = "1e999 kPa"'), "must be a finite pressure"),
    "empty list of loads": (loads(SPAR, "upper = []"), "must hold at least one value"),
    "wrong unit within a list": (loads(SPAR, 'upper = ["1 kPa", "2 N"]'), "must be a pressure"),
    "list within a list": (loads(SPAR, 'upper = [["1 kPa"]]'), "must be a pressure"),
    "range without end": (loads(SPAR, "upper = { points = 3 }"), "loads.upper = "),
    "range of one point": (
        loads(SPAR, 'upper = { to = "1 kPa", points = 1 }'), "a whole number from 2 to"),
    "range of half points": (
        loads(SPAR, 'upper = { to = "1 kPa", points = 2.5 }'), "a whole number from 2 to"),
    "range with an unknown key": (
        loads(SPAR, 'upper = { to = "1 kPa", points = 2, by = 3 }'), "must be written as"),
    "different numbers of steps": (
        loads(SPAR, 'upper = ["1 kPa", "2 kPa"]\nlower = ["1 kPa", "2 kPa", "3 kPa"]'),
        "numbers of steps differ (upper has 2, lower has 3): must be equal, or 1"),
    "load of another scene": (loads(SPAR, 'cable = "1 N"'), "loads.cable: unknown key"),
    "torque and cable": (
        loads(RIB, 'torque = "1 N mm"\ncable = "1 N"'), "torque and cable are both given"),
    "guide without cable": (
        loads(RIB, 'torque = "1 N mm"\nguide = ["0 mm", "1 mm", "0 mm"]'), "without cable"),
    "guide of two lengths": (
        loads(RIB, 'cable = "1 N"\nguide = ["0 mm", "1 mm"]'), "loads.guide"),
    "guide at the tail": (
        loads(RIB, 'cable = "1 N"\nguide = ["0 mm", "0 mm", "0 mm"]'),
        "loads: guide is the tail itself: must"),
    "pushing cable": (
        loads(RIB, 'cable = "-1 N"'), "loads.cable = '-1 N': must not be negative"),
    "zero thickness": (
        geometry(SPAR, 'top_thickness = "0 mm"'), "geometry.top_thickness = 0 mm: must be"),
    "negative length": (
        geometry(SPAR, 'wall_length = "-2 mm"'), "geometry.wall_length = -2 mm: must be"),
    "no chambers": (geometry(SPAR, "n_cells = 0"), "geometry.n_cells = 0: must be"),
    "half a chamber": (geometry(SPAR, "n_cells = 2.5"), "geometry.n_cells = 2.5: must be"),
    "yes for a number": (geometry(SPAR, "n_cells = true"), "geometry.n_cells = True: must be"),
    "more chambers than memory": (geometry(SPAR, "n_cells = 1000000000"), "geometry.n_cells = "),
    "bars of a straight angle": (
        geometry(RIB, 'crossing_angle = "180 deg"'), "geometry.crossing_angle = 180 degrees"),
    "pivots that overlap": (
        geometry(RIB, 'pivot_diameter = "9 mm"'), "geometry.pivot_diameter = 9 mm: must be"),
    "unknown section": (
        geometry(RIB, 'section = "round"'), "geometry.section = 'round': must be 'flush' or"),
    "chamber taller than the aerofoil": (
        wing('top_thickness = "8 mm"'), "geometry.top_thickness = 8 mm: must be less than"),
    "nose longer than the spar": (
        wing('nose_length = "74 mm"'), "geometry.nose_length = 74 mm: must be less than"),
    "spar of the whole chord": (
        wing("spar_fraction = 1.0"), "geometry.spar_fraction = 1: must be"),
    "spar fraction not finite": (wing("spar_fraction = nan"), "geometry.spar_fraction = nan"),
    "skin as thick as the wall": (
        wing('skin_thickness = "2 mm"'), "geometry.skin_thickness = 2 mm: must be"),
    "skin of no thickness": (
        wing('skin_thickness = "0 mm"'), "geometry.skin_thickness = 0 mm: must be"),
    "skin slit nowhere known": (
        wing('skin_slit = "upper"'), "geometry.skin_slit = 'upper': must be 'none', 'lower' or"),
    "skin squeezed": (
        wing("skin_prestretch = [0.9, 1.0]"), "must be two stretches of 1 or more"),
    "skin stretched one way": (wing("skin_prestretch = [1.1]"), "geometry.skin_prestretch = "),
    "skin switched off by false": (
        wing("skin_thickness = false"), "geometry.skin_thickness = False: must be a length"),
    "rib longer than the pocket": (
        wing("[geometry.rib]\nn_cells = 90"), "n_cells = 90: must be at most"),
    "rib with an unknown key": (
        wing("[geometry.rib]\ncolour = 3"), "geometry.rib.colour: unknown key"),
    "rib of negative length": (
        wing('[geometry.rib]\nshaft_length = "-4 mm"'), "geometry.rib.shaft_length = -4 mm"),
    "ribs outside the span": (
        wing("rib_positions = [0.5, 1.5]"), "geometry.rib_positions = "),
    "no rib position": (wing("rib_positions = []"), "geometry.rib_positions = []: must"),
    "aerofoil that is none": (wing('aerofoil = "wing"'), "geometry.aerofoil = 'wing': must be"),
    "aerofoil of no thickness": (wing('aerofoil = "0000"'), "geometry.aerofoil = '0000': must be"),
    "cables without ribs": (
        toml(WING, geometry='rib = "none"', loads='cable = "1 N"'), "must be left out where rib"),
    "rubber of zero shear modulus": (
        toml(SPAR, elastomer='coefficients = ["0 MPa"]'),
        "elastomer: initial shear modulus 2 C10 = 0 MPa: must be greater than 0 MPa"),
    "rubber of negative shear modulus": (
        toml(WING, elastomer='coefficients = ["-0.1 MPa", "1 MPa"]'),
        "initial shear modulus 2 C10 = -0.2 MPa"),
    "rubber without coefficients": (
        toml(SPAR, elastomer="coefficients = []"), "elastomer.coefficients = "),
    "rubber of negative bulk modulus": (
        toml(SPAR, elastomer='bulk = "-1 MPa"'), "elastomer.bulk = -1 MPa: must be greater"),
    "rubber without weight": (
        toml(WING, elastomer='density = "0 kg/m^3"'), "elastomer.density = 0 kg/m^3: must be"),
    "gravity with a unit": (
        loads(WING, 'gravity = "9.81 m/s^2"'), "'9.81 m/s^2': must be a plain finite number"),
    "gravity not finite": (loads(WING, "gravity = [1.0, nan]"), "must be a plain finite number"),
    "gravity from no number": (
        loads(WING, "gravity = { points = 3 }"), "must be written as { from = ..., to = 1.0"),
    "gravity on a spar alone": (loads(SPAR, "gravity = 1.0"), "loads.gravity: unknown key"),
    "resin incompressible": (toml(RIB, resin="nu = 0.5"), "resin.nu = 0.5: must be greater"),
    "resin without stiffness": (toml(RIB, resin='E = "0 MPa"'), "resin.E = 0 MPa: must be greater"),
    "resin for a spar": (toml(SPAR, resin="nu = 0.3"), "resin: unknown key"),
}


@pytest.fixture
def folder(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    return tmp_path


def refused(capfd, *arguments):
    """Sentence with which a command refuses its input: alone, and with status 2."""
    status = main(["solve", *arguments])
    said = capfd.readouterr()
    assert status == 2, said.err
    assert said.out == ""
    assert said.err.count("\n") == 1 and said.err.endswith("\n"), said.err
    assert said.err.startswith("morphing-wing: ") and "Traceback" not in said.err
    return said.err


@pytest.mark.parametrize("name", BROKEN)
def test_broken_file_ends_in_one_sentence_and_leaves_nothing(name, folder, capfd):
    text, expected = BROKEN[name]
    (folder / "broken.toml").write_text(text)
    sentence = refused(capfd, "broken.toml", "--out", "results")
    assert sentence.startswith("morphing-wing: broken.toml: ")
    assert expected in sentence
    assert [file.name for file in folder.iterdir()] == ["broken.toml"]


def test_unbroken_files_behind_the_broken_ones_are_accepted():
    from morphing_wing.scene_file import parse_scene

    for scene in (SPAR, RIB, WING):
        assert parse_scene(toml(scene), "file").scene in scene["head"]


def test_missing_file_is_named(folder, capfd):
    assert "nowhere.toml: cannot be read, no such file" in refused(capfd, "nowhere.toml")
    assert not list(folder.iterdir())


def test_missing_file_with_a_built_in_name_tells_how_to_write_it(folder, capfd):
    assert "'morphing-wing scenes spar-n4 > spar-n4.toml'" in refused(capfd, "spar-n4.toml")


def test_folder_as_scene_is_refused(folder, capfd):
    (folder / "scene.toml").mkdir()
    assert "scene.toml: cannot be read, is a directory" in refused(capfd, "scene.toml")


def test_file_that_is_no_text_is_refused(folder, capfd):
    (folder / "scene.toml").write_bytes(b"\xff\xfe\x00")
    assert "must be a text file in UTF-8" in refused(capfd, "scene.toml")


def test_fidelity_of_the_command_line_is_checked(folder, capfd):
    (folder / "spar.toml").write_text(toml(SPAR))
    sentence = refused(capfd, "spar.toml", "--fidelity", "best")
    assert "fidelity = 'best': must be one of instant, cell, draft" in sentence


def test_file_in_the_place_of_the_output_folder_is_refused_and_kept(folder, capfd):
    (folder / "spar.toml").write_text(toml(SPAR))
    (folder / "results").write_text("precious")
    assert "must be a folder" in refused(capfd, "spar.toml", "--out", "results/spar")
    assert (folder / "results").read_text() == "precious"


@pytest.mark.parametrize(
    "arguments", [[], ["a.toml", "b.toml"], ["a.toml", "--bogus"], ["a.toml", "--out"]]
)
def test_wrong_use_of_the_command_is_refused(arguments, folder, capfd):
    refused(capfd, *arguments)
