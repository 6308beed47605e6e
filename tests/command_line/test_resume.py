"""`morphing-wing solve --resume`: what was killed goes on, what is done stays as it is."""

import os
import pathlib
import subprocess
import sys
import time

import pandas as pd
import pytest

from morphing_wing import scene_file
from morphing_wing.cli import main

PROGRAM = [os.path.join(os.path.dirname(sys.executable), "morphing-wing")]
SPAR = """scene = "spar"
fidelity = "draft"
[geometry]
preset = "validation"
n_cells = 2
[loads]
upper = {{ to = "20 kPa", points = {points} }}
"""
# A process of its own, outside of this one's MPI.
ALONE = {name: value for name, value in os.environ.items()
         if not name.startswith(("OMPI_", "PMIX_"))} | {"OMP_NUM_THREADS": "1"}  # fmt: skip


@pytest.fixture
def scene(tmp_path, monkeypatch):
    """Write a scene of so many load steps and return its file."""
    monkeypatch.chdir(tmp_path)

    def write(points):
        (tmp_path / "spar.toml").write_text(SPAR.format(points=points))
        return "spar.toml"

    return write


def table(folder):
    return pd.read_csv(f"{folder}/table.csv", index_col="step").drop(columns="step_seconds")


def test_a_killed_program_resumed_writes_the_table_of_one_run(scene):
    file = scene(points=40)
    running = subprocess.Popen([*PROGRAM, "solve", file, "--out", "run"], env=ALONE,
                               stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    patience = time.monotonic() + 100
    while not os.path.exists("run/restart.npz") and time.monotonic() < patience:
        time.sleep(0.01)
    running.kill()
    running.wait()
    assert os.path.exists("run/restart.npz") and not os.path.exists("run/table.csv")
    resumed = subprocess.run([*PROGRAM, "solve", file, "--out", "run", "--resume"], env=ALONE,
                             capture_output=True, text=True, timeout=100)
    assert resumed.returncode == 0, resumed.stderr
    assert "step(s) were done before" in resumed.stdout
    assert main(["solve", file, "--out", "whole"]) == 0
    pd.testing.assert_frame_equal(table("run"), table("whole"), rtol=1e-10, atol=1e-12)


@pytest.mark.quick
def test_a_finished_run_resumed_says_so_and_leaves_all_as_it_is(scene, capfd):
    file = scene(points=2)
    assert main(["solve", file, "--out", "run"]) == 0

    def files():
        return {os.path.join(folder, name): os.stat(os.path.join(folder, name)).st_mtime_ns
                for folder, _, names in os.walk("run") for name in names}

    before = files()
    assert "run/restart.npz" in before and "run/fields/elastomer_0000.vtu" in before
    capfd.readouterr()
    assert main(["solve", file, "--out", "run", "--resume"]) == 0
    assert "2 step(s) were done before, none now" in capfd.readouterr().out
    assert files() == before


@pytest.mark.quick
def test_a_run_that_finished_but_could_not_save_saves_when_resumed(scene):
    file = scene(points=2)
    assert main(["solve", file, "--out", "run"]) == 0
    os.remove("run/summary.json")
    assert main(["solve", file, "--out", "run", "--resume"]) == 0
    assert os.path.exists("run/summary.json") and len(table("run")) == 2


@pytest.mark.quick
def test_a_run_killed_while_it_saved_saves_all_when_resumed(scene, monkeypatch):
    file = scene(points=2)

    def killed(path, folder):
        path.__class__._save_figures(path, pathlib.Path(folder))
        raise KeyboardInterrupt

    with monkeypatch.context() as during:
        during.setattr("morphing_wing.path.Path.save", killed)
        assert main(["solve", file, "--out", "run"]) == 130
    assert os.path.exists("run/summary.json") and not os.path.exists("run/fields")
    assert main(["solve", file, "--out", "run", "--resume"]) == 0
    assert os.path.exists("run/fields/path.pvd") and not os.path.exists("run/.saving")


@pytest.mark.quick
def test_without_a_restart_file_it_is_refused_before_anything_is_built(scene, monkeypatch, capfd):
    monkeypatch.setattr(scene_file.SceneFile, "build", None)
    assert main(["solve", scene(points=2), "--out", "run", "--resume"]) == 2
    said = capfd.readouterr().err
    assert said == "morphing-wing: --resume: run must hold a restart.npz of a run to go on with\n"
    assert not os.path.exists("run")


@pytest.mark.quick
def test_another_scene_is_refused_with_status_2(scene, tmp_path, capfd):
    assert main(["solve", scene(points=2), "--out", "run"]) == 0
    changed = tmp_path / "spar.toml"
    changed.write_text(changed.read_text().replace("n_cells = 2", "n_cells = 3"))
    before = (tmp_path / "run" / "restart.npz").read_bytes()
    capfd.readouterr()
    assert main(["solve", "spar.toml", "--out", "run", "--resume"]) == 2
    said = capfd.readouterr().err
    assert "geometry.n_cells is 2 in it and 3 here" in said and said.count("\n") == 1
    assert (tmp_path / "run" / "restart.npz").read_bytes() == before
