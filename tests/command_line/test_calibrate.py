"""The contract of `morphing-wing calibrate`: what it prints, writes and refuses."""

import json
from pathlib import Path

import numpy as np
import pandas as pd
import pytest

from morphing_wing.calibrate_command import tell
from morphing_wing.calibration import Calibration, calibrate
from morphing_wing.calibration.laws import YeohLaw
from morphing_wing.cli import main
from morphing_wing.scene_file import parse_scene

pytestmark = pytest.mark.quick

C = (0.12, 0.004)
WRITTEN = {"calibration.png", "curves.csv", "elastomer.toml", "stability.csv", "summary.json",
           "table.csv"}


def write(name, mode="uniaxial", constants=C, unit="MPa", factor=1.0):
    stretch = np.linspace(1.05, 3.0, 30)
    stress = factor * YeohLaw(len(constants)).stress(constants, mode, stretch)
    table = pd.DataFrame({"strain": stretch - 1, f"stress ({unit})": stress})
    Path(name).write_text(table.to_csv(index=False))


@pytest.fixture
def here(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    return tmp_path


@pytest.fixture
def no_picture(monkeypatch):
    """Leave out the picture, most of the time of a small fit."""
    monkeypatch.setattr(Calibration, "plot", lambda found, file: file.touch())


def test_the_built_in_test_gives_its_constants_files_and_picture(here, capsys):
    assert main(["calibrate", "dragon_skin_30", "--max-stretch", "4"]) == 0
    folder = here / "output" / "calibrate-dragon_skin_30"
    assert {file.name for file in folder.iterdir()} == WRITTEN
    said = capsys.readouterr().out
    assert 'coefficients = ["0.119321 MPa", "0.00305734 MPa"]' in said
    assert "cut at its largest nominal stress, 4.155 MPa at stretch 8.068" in " ".join(said.split())
    assert "results are in output/calibrate-dragon_skin_30" in said
    for peak in ("5.4557", "5.4013", "3.8371"):
        assert peak in said
    assert (folder / "calibration.png").stat().st_size > 100_000
    table = pd.read_csv(folder / "table.csv").set_index(["law", "constant"])
    chosen = table[table["chosen"]]
    assert list(chosen["value"]) == pytest.approx([0.1193, 0.00306], rel=2e-3)
    assert (chosen["lower_95"] < chosen["value"]).all()
    assert (chosen["value"] < chosen["upper_95"]).all()
    assert table.loc[("the paper's pair", "C20"), "value"] == -0.0006865
    curves = pd.read_csv(folder / "curves.csv")
    assert (len(curves), curves["used"].sum()) == (311, 131)
    summary = json.loads((folder / "summary.json").read_text())
    assert summary["study"] == "calibrate" and summary["converged"] and "dolfinx" in summary[
        "versions"]
    assert summary["coefficients_MPa"] == pytest.approx(list(chosen["value"]))
    scene = 'scene = "spar"\n[geometry]\npreset = "validation"\n[loads]\nupper = "1 kPa"\n'
    read = parse_scene(scene + (folder / "elastomer.toml").read_text(), "it")
    assert read.materials["material"].coefficients == pytest.approx((0.119321, 0.00305734))


def test_several_files_with_options_once_for_all_or_once_each(here, no_picture, capsys):
    for mode in ("uniaxial", "planar", "equibiaxial"):
        write(f"{mode[:2]}.csv", mode, factor=1e3, unit="kPa" if mode != "planar" else "a")
    command = ["calibrate", "un.csv", "pl.csv", "eq.csv", "--stress-unit", "kPa", "--terms", "3",
               "--out", "fit"]
    for mode, weight in (("uniaxial", "1"), ("planar", "2"), ("equibiaxial", "0.5")):
        command += ["--mode", mode, "--weight", weight]
    assert main([*command, "--max-stretch", "2.5"]) == 0
    summary = json.loads((here / "fit" / "summary.json").read_text())
    assert summary["coefficients_MPa"] == pytest.approx([*C, 0.0], abs=1e-9)
    assert [(t["mode"], t["weight"]) for t in summary["tests"]] == [
        ("uniaxial", 1.0), ("planar", 2.0), ("equibiaxial", 0.5)]
    assert all(test["max_stretch"] <= 2.5 for test in summary["tests"])
    assert "Not measured" not in capsys.readouterr().out


def test_stability_on_demand(here, no_picture):
    assert main(["calibrate", "dragon_skin_30", "--max-stretch", "4", "--terms", "3", "--stable",
                 "6", "--out", "held"]) == 0
    table = pd.read_csv(here / "held" / "table.csv")
    chosen = table[table["chosen"]]
    assert chosen["held_by_stability"].all() and chosen["standard_error"].isna().all()
    assert (chosen.filter(like="stable_to_") >= 6.0).all(axis=None)


SPARSE = "strain,stress (MPa)\n0.5,0.2\n1,0.4\n"
CYCLES = "strain,stress (MPa)\n0,0\n1,0.4\n0,0\n1,0.4\n0,0\n2,0.8\n"
REFUSED = {
    "no file": (["none.csv"], "none.csv: cannot be read, no such file or directory"),
    "a folder": (["folder"], "folder: cannot be read, is a directory"),
    "nothing named": ([], "Missing argument"),
    "no terms": (["good.csv", "--terms", "0"], "terms = 0: must be 1 to 3"),
    "too many terms": (["good.csv", "--terms", "4"], "terms = 4: must be 1 to 3"),
    "half a term": (["good.csv", "--terms", "1.5"], "Invalid value for '--terms'"),
    "beyond the data": (["good.csv", "--max-stretch", "4"],
                        "max_stretch = 4: must be at most 3, the largest stretch used of good.csv"),
    "beyond the failure": (["dragon_skin_30", "--max-stretch", "8.08"],
                           "max_stretch = 8.08: must be at most 8.0681, the largest stretch used"),
    "no stretch": (["good.csv", "--max-stretch", "1"], "max_stretch = 1: must be greater than 1"),
    "a word": (["good.csv", "--max-stretch", "all"], "Invalid value for '--max-stretch'"),
    "stable nowhere": (["good.csv", "--stable", "0.5"], "stable = 0.5: must be a stretch greater"),
    "modes for other files": (["good.csv", "--mode", "planar", "--mode", "planar"],
                              "--mode: is given 2 times, must be once, or once for each of 1 file"),
    "unknown mode": (["good.csv", "--mode", "simple shear"], "mode = 'simple shear': must be one "),
    "weightless": (["good.csv", "--weight", "0"], "good.csv: weight = 0: must be greater than 0"),
    "unknown column": (["good.csv", "--stress", "force"], "stress = 'force': must be one of"),
    "unknown unit": (["good.csv", "--stress-unit", "stone"], "unit 'stone' must be one of stress"),
    "folder that is a file": (["good.csv", "--out", "good.csv"], "--out good.csv: must be a"),
    "too few points": (["sparse.csv"], "sparse.csv: Yeoh, 2 terms needs points at more than 2"),
    "cycles": (["cycles.csv"], "cycles.csv: stretch goes back from 2 to 1 in line 4: must be one"),
    "second file bad": (["good.csv", "empty.csv"], "empty.csv: is empty, must hold columns"),
}


@pytest.mark.parametrize("arguments, sentence", REFUSED.values(), ids=REFUSED)
def test_bad_input_is_one_sentence_and_leaves_nothing(arguments, sentence, here, capfd):
    write("good.csv")
    (here / "folder").mkdir()
    for name, text in (("sparse.csv", SPARSE), ("cycles.csv", CYCLES), ("empty.csv", "")):
        (here / name).write_text(text)
    before = sorted(here.rglob("*"))
    assert main(["calibrate", *arguments]) == 2
    said = capfd.readouterr()
    assert said.out == "" and said.err.count("\n") == 1 and sentence in said.err
    assert sorted(here.rglob("*")) == before


def test_help_has_examples(capsys):
    assert main(["calibrate", "--help"]) == 0
    said = " ".join(capsys.readouterr().out.split())
    assert "morphing-wing calibrate dragon_skin_30 --max-stretch 4" in said
    assert main(["--help"]) == 0 and "calibrate" in capsys.readouterr().out


def test_results_are_written_before_anything_is_printed(no_picture, tmp_path, monkeypatch):
    def closed(_):
        raise BrokenPipeError

    monkeypatch.setattr("morphing_wing.terminal_tables.show", closed)
    with pytest.raises(BrokenPipeError):
        tell(calibrate("dragon_skin_30", max_stretch=2), tmp_path / "out")
    assert (tmp_path / "out" / "elastomer.toml").exists()
