"""`morphing-wing study` and `studies`: what they refuse, write, and survive."""

import os
import pathlib
import shutil
import signal
import subprocess
import sys
import time

import pandas as pd
import pytest

from morphing_wing.cli import main

BIN = os.path.dirname(sys.executable)
PROGRAM = os.path.join(BIN, "morphing-wing")
ALONE = {name: value for name, value in os.environ.items()
         if not name.startswith(("OMPI_", "PMIX_"))} | {
    "OMP_NUM_THREADS": "1", "OMPI_ALLOW_RUN_AS_ROOT": "1", "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM": "1",
    "OMPI_MCA_rmaps_base_oversubscribe": "1",
    "PRTE_MCA_rmaps_default_mapping_policy": ":oversubscribe"}  # fmt: skip
PATIENCE = 200.0

STUDY = {
    "head": 'scene = "spar-n4"\noutputs = ["span_angle_deg", "mass_g"]',
    "base": 'fidelity = "instant"\nloads.upper = "20 kPa"',
    "factors": 'geometry.top_thickness = { low = "1.0 mm", high = "1.4 mm" }\n'
               "geometry.wall_length = { within = 0.1 }",
    "design": 'kind = "latin_hypercube"\npoints = 6',
}


def toml(**changes):
    parts = STUDY | changes
    tables = [f"[{name}]\n{text}" for name, text in parts.items() if name != "head"]
    return "\n".join([parts["head"], *tables]) + "\n"


def thickness(text):
    return toml(factors=f"geometry.top_thickness = {text}")


def design(text):
    return toml(design=text)


# name: (file, what the sentence must say)
BROKEN = {
    "empty file": ("", "scene: is missing, must be given"),
    "no TOML": ("scene = [", "must be valid TOML"),
    "unknown table": (toml(wind="speed = 3"), "wind: unknown key, must be one of scene, outputs"),
    "unknown scene": (toml(head='scene = "kite"'),
                      "scene = 'kite': must be a scene file, NAME.toml, or one of rib-prototype, "),
    "scene file that is not there": (
        toml(head='scene = "kite.toml"'), "kite.toml: cannot be read, no such file"),
    "scene as number": (toml(head="scene = 3"), "scene = 3: must be a scene file, a built-in"),
    "scene table without scene": (
        toml(head="", scene='fidelity = "draft"'), "scene: is missing, must be one of spar, rib"),
    "broken scene table": (
        toml(head="", scene='scene = "spar"\ngeometry.preset = "best"\nloads.upper = "1 kPa"'),
        "geometry.preset = 'best': must be 'validation'"),
    "unknown output": (toml(head='scene = "spar-n4"\noutputs = ["span_angle"]'),
                       "output 'span_angle': must be one of span_angle_deg, span_line_deg"),
    "output of another scene": (
        toml(head='scene = "spar-n4"\noutputs = ["chord_angle_deg"]'),
        "output 'chord_angle_deg': must be one of span_angle_deg"),
    "output twice": (toml(head='scene = "spar-n4"\noutputs = ["mass_g", "mass_g"]'),
                     "output 'mass_g': is given twice"),
    "no outputs": (toml(head='scene = "spar-n4"\noutputs = []'), "outputs = []: "),
    "output that is a factor": (
        toml(head='scene = "spar-n4"\noutputs = ["upper_MPa"]',
             factors='loads.upper = { low = "1 kPa", high = "20 kPa" }'),
        "output 'upper_MPa': must be left out, it is a column of the factors' own"),
    "output that a formula has not": (
        toml(head='scene = "rib-validation"\noutputs = ["rib_stress_MPa"]',
             base='fidelity = "instant"', factors="geometry.n_cells = { low = 4, high = 8 }"),
        "output 'rib_stress_MPa': must be left out where fidelity is 'instant'"),
    "unknown key in base": (
        toml(base='geometry.top_thicknes = "1 mm"'),
        "geometry.top_thicknes: unknown key, must be one of preset, cavity_length"),
    "wrong unit in base": (
        toml(base='loads.upper = "20 mm"'), "loads.upper = '20 mm': must be a pressure"),
    "unknown fidelity in base": (
        toml(base='fidelity = "best"'), "fidelity = 'best': must be one of instant"),
    "no factors": (toml(factors=""), "factors = {}: "),
    "unknown factor": (
        toml(factors='geometry.top_thicknes = { low = "1 mm", high = "2 mm" }'),
        "factors: geometry.top_thicknes: unknown key, must be one of preset, cavity_length"),
    "factor of another scene": (
        toml(factors='loads.cable = { low = "1 N", high = "2 N" }'), "loads.cable: unknown key"),
    "factor that is a table": (
        toml(factors='geometry = { low = "1 mm", high = "2 mm" }'),
        "factors: geometry: is a table, must be one of its keys: preset, "),
    "factor that is the scene": (
        toml(factors='scene = { levels = ["spar", "rib"] }'), "factor 'scene': must be another"),
    "value for a factor": (
        thickness('"1 mm"'), "factors.geometry.top_thickness = '1 mm': must be a table, such as"),
    "empty factor": (thickness("{}"), "geometry.top_thickness: low is missing, must have levels"),
    "factor with an unknown key": (
        thickness('{ low = "1 mm", hihg = "2 mm" }'),
        "factors.geometry.top_thickness.hihg: unknown key, must be one of low, high, within"),
    "factor without an end": (
        thickness('{ low = "1 mm" }'), "geometry.top_thickness: high is missing"),
    "bare number for an end": (
        thickness('{ low = 1.0, high = "2 mm" }'),
        "geometry.top_thickness.low = 1: must be a length as text with its unit"),
    "wrong unit for an end": (
        thickness('{ low = "1 mm", high = "2 kPa" }'),
        "geometry.top_thickness.high = '2 kPa': must be a length"),
    "ends in the wrong order": (
        thickness('{ low = "2 mm", high = "1 mm" }'),
        "geometry.top_thickness: high = 1 mm: must be more than low = 2 mm"),
    "one level": (thickness('{ levels = ["1 mm"] }'), "levels = ['1 mm']: "),
    "wrong unit for a level": (
        thickness('{ levels = ["1 mm", "2 N"] }'),
        "geometry.top_thickness.levels = '2 N': must be a length"),
    "the same level twice": (
        thickness('{ levels = ["1 mm", "0.1 cm"] }'), "levels = [1, 1]: must be two or more"),
    "levels and ends": (
        thickness('{ levels = ["1 mm", "2 mm"], low = "1 mm" }'),
        "must have levels, or low and high, not both"),
    "within and ends": (
        thickness('{ within = 0.1, low = "1 mm" }'), "must have within alone, or levels, or"),
    "within more than all": (
        thickness("{ within = 1.5 }"), "geometry.top_thickness.within = 1.5: must be between 0"),
    "within of a word": (
        toml(factors="fidelity = { within = 0.1 }"), "must be left out, the scene's value is"),
    "unknown design": (
        design('kind = "best"'), "design.kind = 'best': must be one of orthogonal, full_factorial"),
    "design without kind": (design("points = 3"), "design.kind: is missing, must be given"),
    "no design": ('scene = "spar-n4"\n[factors]\nfidelity = { levels = ["cell", "draft"] }',
                  "design: is missing, must be given"),
    "unknown key in design": (
        design('kind = "latin_hypercube"\npoint = 3'), "design.point: unknown key, must be one of"),
    "points as text": (
        design('kind = "latin_hypercube"\npoints = "6"'), "design.points = '6': must be a valid"),
    "points of a factorial": (
        design('kind = "full_factorial"\nlevels = 2\npoints = 6'),
        "design.points = 6: must be left out where kind is 'full_factorial'"),
    "points that are no power of two": (
        design('kind = "sobol"\npoints = 100'), "design.points = 100: must be a power of two"),
    "unknown array": (
        design('kind = "orthogonal"\nlevels = 3\narray = "L10"'), "array = 'L10': must be one of"),
    "array that is too small": (
        design('kind = "orthogonal"\nlevels = 4\narray = "L9"'),
        "array = 'L9' has not a column for each factor (2 of 4 levels)"),
    "ranges without levels": (
        design('kind = "full_factorial"'), "must have levels, or design.levels must say how many"),
    "more cases than memory": (
        design('kind = "full_factorial"\nlevels = 100000'), "number of cases = 1e+10: must be at"),
}


@pytest.fixture
def folder(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    return tmp_path


def refused(capfd, *arguments):
    status = main(["study", *arguments])
    said = capfd.readouterr()
    assert status == 2, said.err
    assert said.err.count("\n") == 1 and said.err.startswith("morphing-wing: "), said.err
    return said.err


@pytest.mark.quick
@pytest.mark.parametrize("name", BROKEN)
def test_a_broken_study_ends_in_one_sentence_and_leaves_nothing(name, folder, capfd):
    text, expected = BROKEN[name]
    (folder / "broken.toml").write_text(text)
    sentence = refused(capfd, "broken.toml", "--out", "results")
    assert sentence.startswith("morphing-wing: broken.toml: ")
    assert expected in sentence
    assert [file.name for file in folder.iterdir()] == ["broken.toml"]


@pytest.mark.quick
def test_wrong_options_are_refused_in_one_sentence(folder, capfd):
    (folder / "study.toml").write_text(toml())
    for options, expected in (
            (["--workers", "0"], "--workers = 0: must be 1 or more"),
            (["--executor", "dask"], "--executor = 'dask': must be one of processes, mpi"),
            (["--executor", "mpi"], "--executor mpi: must be run by mpirun on 2 or more ranks"),
            (["--resume"], "--resume: output/study must hold a cases.jsonl of a study")):
        assert expected in refused(capfd, "study.toml", *options)
    assert "'morphing-wing studies spar-l9 > spar-l9.toml'" in refused(capfd, "spar-l9.toml")
    (folder / "results").write_text("precious")
    assert "must be a folder" in refused(capfd, "study.toml", "--out", "results")


@pytest.mark.quick
def test_built_in_studies_are_listed_and_printed_to_start_from(folder, capfd):
    assert main(["studies"]) == 0
    names = [line.split()[0] for line in capfd.readouterr().out.splitlines()]
    assert names == ["rib-factorial", "rib-one-at-a-time", "spar-l9", "spar-lhs", "spar-sobol"]
    assert main(["studies", "spar-l9"]) == 0
    (folder / "mine.toml").write_text(capfd.readouterr().out)
    assert main(["study", "mine.toml", "--workers", "1"]) == 0
    said = capfd.readouterr().out
    assert "mine: 9 cases, 3 factors, orthogonal, 1 worker(s)" in said
    assert "span_angle_deg: analysis of variance" in said
    assert {file.name for file in (folder / "output/mine").iterdir()} == {
        "cases.jsonl", "table.csv", "summary.json", "levels.csv", "variance.csv",
        "main_effects.png", "variance.png"}
    assert main(["studies", "spar-l10"]) == 2
    assert "study 'spar-l10': must be one of rib-factorial, " in capfd.readouterr().err


@pytest.mark.quick
def test_a_study_of_bad_cases_alone_ends_with_status_3_and_its_table(folder, capfd):
    (folder / "bad.toml").write_text(toml(base='fidelity = "instant"\nloads.upper = "900 kPa"'))
    assert main(["study", "bad.toml", "--workers", "1", "--out", "bad"]) == 3
    assert "case 0 stopped: the formula goes to" in capfd.readouterr().out
    assert table("bad")["span_angle_deg"].isna().all()


def table(name):
    read = pd.read_csv(f"{name}/table.csv", index_col="case", float_precision="round_trip")
    return read.drop(columns="seconds")


DRAFT = toml(base='fidelity = "draft"\ngeometry.n_cells = 1\nloads.upper = "20 kPa"',
             design='kind = "latin_hypercube"\npoints = 8')


def recorded(name):
    file = pathlib.Path(name, "cases.jsonl")
    return file.read_bytes().count(b"\n") - 1 if file.exists() else 0


def test_a_kill_loses_no_case_and_any_number_of_processes_finds_the_same_table(folder):
    (folder / "study.toml").write_text(DRAFT)
    command = [PROGRAM, "study", "study.toml", "--out", "killed", "--workers", "2"]
    with open("said.txt", "w") as said:
        run = subprocess.Popen(command, env=ALONE, stdout=said, stderr=said)
    patience = time.monotonic() + PATIENCE
    while recorded("killed") < 2:
        said = pathlib.Path("said.txt").read_text()
        assert run.poll() is None and time.monotonic() < patience, said
        time.sleep(0.02)
    workers = children(run.pid)
    run.send_signal(signal.SIGKILL)
    run.wait()
    there = recorded("killed")
    with open("killed/cases.jsonl", "ab") as torn:
        torn.write(b'{"case": 7, "inp')
    while any(os.path.exists(f"/proc/{pid}") for pid in workers):
        assert time.monotonic() < patience, "processes outlive the one that started them"
        time.sleep(0.1)
    resumed = subprocess.run([*command, "--resume"], env=ALONE, text=True, capture_output=True,
                             timeout=PATIENCE)
    assert resumed.returncode == 0, resumed.stderr
    assert f"{there + 1} of 8 cases, " in resumed.stdout
    assert f"{there} of 8 cases, " not in resumed.stdout
    assert main(["study", "study.toml", "--out", "whole", "--workers", "1"]) == 0
    pd.testing.assert_frame_equal(table("killed"), table("whole"), rtol=0.0, atol=0.0)


def children(pid):
    text = pathlib.Path(f"/proc/{pid}/task/{pid}/children").read_text()
    found = [int(child) for child in text.split()]
    return [child for child in found if b"spawn_main" in
            pathlib.Path(f"/proc/{child}/cmdline").read_bytes()]


@pytest.mark.skipif(shutil.which("mpirun") is None, reason="mpirun is not installed")
@pytest.mark.parametrize("program", [
    [PROGRAM], [sys.executable, "-m", "mpi4py.futures", "-m", "morphing_wing"]])
def test_ranks_of_mpi_find_the_same_table(program, folder):
    (folder / "study.toml").write_text(DRAFT.replace("points = 8", "points = 3"))
    run = subprocess.run(["mpirun", "-n", "3", *program, "study", "study.toml", "--out", "ranks"],
                         env=ALONE, text=True, capture_output=True, timeout=PATIENCE)
    assert run.returncode == 0, run.stderr
    assert "3 cases, 2 factors, latin hypercube, 2 worker(s)" in run.stdout
    assert main(["study", "study.toml", "--out", "whole", "--workers", "1"]) == 0
    pd.testing.assert_frame_equal(table("ranks"), table("whole"), rtol=0.0, atol=0.0)
