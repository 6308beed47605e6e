"""Whatever is wrong with a problem file: one sentence, exit status 2, nothing written."""

import pytest

from morphing_wing.cli import main

pytestmark = pytest.mark.quick

HEAD = {"scene": '"spar-validation"', "maximize": '"span_angle_deg"', "rungs": '["instant"]'}
BASE = 'loads.upper = "20 kPa"'
VARIABLES = 'geometry.wall_length = { low = "2.0 mm", high = "2.4 mm" }'


def problem(head=None, base=BASE, variables=VARIABLES, constraints='mass_g = { max = "base" }',
            **changes):
    head = head if head is not None else "\n".join(
        f"{key} = {value}" for key, value in (HEAD | changes).items() if value is not None)
    return (f"{head}\n[base]\n{base}\n[variables]\n{variables}\n[constraints]\n{constraints}\n")


# name: (file, what the sentence must say)
BROKEN = {
    "empty file": ("", "scene: is missing, must be given"),
    "no TOML": ("scene = [", "must be valid TOML"),
    "no variables": ('scene = "spar-n4"\nmaximize = "span_angle_deg"', "variables: is missing"),
    "empty variables": (problem(variables=""), "variables: is empty, must have at least one key"),
    "unknown table": (problem() + "[wind]\nspeed = 3", "wind: unknown key, must be one of scene,"),
    "unknown scene": (
        problem(scene='"kite"'), "scene = 'kite': must be a scene file, NAME.toml, or one of"),
    "scene file that is not there": (problem(scene='"kite.toml"'), "kite.toml: cannot be read"),
    "scene as a number": (problem(scene="3"), "scene = 3: must be a scene file, a built-in"),
    "no goal": (problem(maximize=None), "goal: must be one of maximize, minimize, match"),
    "two goals": (
        problem(minimize='"mass_g"'), "maximize and minimize: must be one of maximize,"),
    "unknown goal": (
        problem(maximize='"span_angle"'), "output 'span_angle': must be one of span_angle_deg,"),
    "goal of another scene": (
        problem(maximize='"chord_angle_deg"'), "output 'chord_angle_deg': must be one of"),
    "match without a target": (
        problem(maximize=None, match='"span_angle_deg"'), "target: must be given where the goal"),
    "target without a match": (problem(target='"12 deg"'), "target: must be given where the goal"),
    "target without a unit": (
        problem(maximize=None, match='"span_angle_deg"', target="12"),
        "target = 12: must be an angle as text with its unit"),
    "target in another unit": (
        problem(maximize=None, match='"span_angle_deg"', target='"12 mm"'), "must be an angle"),
    "unknown rung": (problem(rungs='["instant", "best"]'), "rungs = 'best': must be of instant,"),
    "rungs out of order": (
        problem(rungs='["draft", "instant"]'), "rungs = draft, instant: must be in the order of"),
    "a rung twice": (
        problem(rungs='["draft", "draft"]'), "rungs = draft, draft: must be in the order of"),
    "no rung": (problem(rungs="[]"), "rungs = []: must have at least 1 item"),
    "auto for a rung": (problem(rungs='["auto"]'), "rungs = 'auto': must be of instant,"),
    "too few evaluations": (problem(evaluations="3"), "evaluations = 3: must be greater than"),
    "half an evaluation": (problem(evaluations="9.5"), "evaluations = 9.5: must be a valid int"),
    "no tolerance": (problem(tolerance="0.0"), "tolerance = 0: must be greater than"),
    "unknown key at the start": (
        problem(base='geometry.wall = "2 mm"'), "spar-validation: geometry.wall: unknown key"),
    "start that cannot be built": (
        problem(base='geometry.wall_length = "-2 mm"'), "geometry.wall_length = -2 mm: must be"),
    "start without a unit in text": (
        problem(base='geometry.wall_length = "2.2"'), "'2.2': must be a length"),
    "start without equilibrium": (
        problem(base='loads.upper = "5 MPa"'), "base: must be a design that can be computed"),
    "unknown variable": (
        problem(variables='geometry.wall = { low = "2 mm", high = "3 mm" }'),
        "variables: geometry.wall: unknown key, must be one of preset, cavity_length"),
    "variable without bounds": (
        problem(variables='geometry.wall_length = "2 mm"'),
        "variables.geometry.wall_length = '2 mm': must be written as { low = "),
    "variable without anything": (
        problem(variables="geometry.wall_length = {}"),
        "variables.geometry.wall_length.low: is missing"),
    "variable with one bound": (
        problem(variables='geometry.wall_length = { low = "2 mm" }'),
        "variables.geometry.wall_length.high: is missing"),
    "variable with a key too many": (
        problem(variables='geometry.wall_length = { low = "2 mm", high = "3 mm", steps = 3 }'),
        "variables.geometry.wall_length.steps: unknown key, must be one of low, high"),
    "bare number for a bound": (
        problem(variables='geometry.wall_length = { low = 2.0, high = "3 mm" }'),
        "variables.geometry.wall_length.low = 2: must be a length as text with its unit"),
    "bound in another unit": (
        problem(variables='geometry.wall_length = { low = "2 kPa", high = "3 mm" }'),
        "variables.geometry.wall_length.low = '2 kPa': must be a length"),
    "bound that is not finite": (
        problem(variables='geometry.wall_length = { low = "2 mm", high = "inf mm" }'),
        "must be a finite length"),
    "bounds the wrong way round": (
        problem(variables='geometry.wall_length = { low = "3 mm", high = "2 mm" }'),
        "variables.geometry.wall_length: low = 3 mm: must be less than high = 2 mm"),
    "start outside the bounds": (
        problem(variables='geometry.wall_length = { low = "2.5 mm", high = "3 mm" }'),
        "variables.geometry.wall_length of the base = 2.2 mm: must be between low = 2.5 and"),
    "variable that counts": (
        problem(variables='geometry.n_cells = { low = 10, high = 30 }'),
        "variables.geometry.n_cells: must be a key whose value is a number that can change"),
    "variable that is a word": (
        problem(scene='"rib-validation"', maximize='"chord_angle_deg"', base="",
                variables='geometry.section = { low = 1, high = 2 }'),
        "variables.geometry.section: must be a key whose value is a number"),
    "unknown constraint": (
        problem(constraints='weight = { max = "base" }'), "output 'weight': must be one of"),
    "constraint without a side": (
        problem(constraints="mass_g = {}"), "constraints.mass_g: is empty, must have min, max"),
    "constraint as a number": (
        problem(constraints="mass_g = 50"), "constraints.mass_g = 50: must be written as { max ="),
    "constraint of an unknown side": (
        problem(constraints='mass_g = { below = "50 g" }'), "constraints.mass_g.below: unknown"),
    "limit without a unit": (
        problem(constraints="mass_g = { max = 50 }"),
        "constraints.mass_g.max = 50: must be a mass as text with its unit"),
    "limit in another unit": (
        problem(constraints='mass_g = { max = "50 mm" }'), "must be a mass"),
    "text for a number without a unit": (
        problem(constraints='largest_stretch = { max = "1.5 mm" }'),
        "constraints.largest_stretch.max = '1.5 mm': must be a plain finite number"),
    "limit that the only rung does not tell": (
        problem(scene='"rib-validation"', maximize='"chord_angle_deg"', base="",
                variables='geometry.pivot_length = { low = "5 mm", high = "6 mm" }',
                constraints='rib_stress_MPa = { max = "35 MPa" }'),
        "output 'rib_stress_MPa': must be left out where fidelity is 'instant'"),
    "limit that a rung in the middle does not tell": (
        problem(scene='"rib-validation"', maximize='"chord_angle_deg"', base="",
                rungs='["instant", "cell", "draft"]',
                variables='geometry.pivot_length = { low = "5 mm", high = "6 mm" }',
                constraints='rib_stress_MPa = { max = "35 MPa" }'),
        "output 'rib_stress_MPa': must be left out where fidelity is 'cell'"),
}


@pytest.mark.parametrize("name", BROKEN)
def test_a_broken_problem_is_refused_in_one_sentence(name, tmp_path, capsys, monkeypatch):
    text, sentence = BROKEN[name]
    monkeypatch.chdir(tmp_path)
    (tmp_path / "mine.toml").write_text(text)
    assert main(["optimize", "mine.toml"]) == 2
    said = capsys.readouterr().err
    assert said.startswith("morphing-wing: ") and len(said.splitlines()) == 1
    assert sentence in said
    if name != "start without equilibrium":
        assert "mine.toml: " in said and not (tmp_path / "output").exists()


@pytest.mark.parametrize("arguments, sentence", [
    (["spars"], "problem = 'spars': must be a problem file, NAME.toml, or one of rib, spar,"),
    (["none.toml"], "none.toml: cannot be read, no such file or directory"),
    (["spar", "--out", "/proc/version"], "--out /proc/version: must be a folder"),
    (["mine", "--print"], "problem 'mine': must be one of rib, spar, table2"),
    (["spar", "table2"], "unexpected extra argument"),
])
def test_bad_arguments_are_refused_in_one_sentence(arguments, sentence, capsys, tmp_path,
                                                   monkeypatch):
    monkeypatch.chdir(tmp_path)
    assert main(["optimize", *arguments]) == 2
    said = capsys.readouterr().err
    assert sentence in said and len(said.splitlines()) == 1
    assert list(tmp_path.iterdir()) == []
