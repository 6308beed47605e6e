"""The contract of `morphing-wing`: what it prints, writes and returns."""

import json
import os
import shutil
import subprocess
import sys
import warnings

import numpy as np
import pytest

from morphing_wing import cli, scene_file
from morphing_wing.cli import built_in_scenes, main
from morphing_wing.path import Path, State

BIN = os.path.join(os.path.dirname(sys.executable), "morphing-wing")
SPAR = """scene = "spar"
fidelity = "draft"
[geometry]
preset = "validation"
n_cells = 1
[loads]
upper = ["5 kPa", "10 kPa"]
"""


class FakeScene:
    name, fidelity, dofs, primary_load = "spar", "draft", 7, "pressure_MPa"
    functions: dict = {}

    def __init__(self, comm, reaches):
        self.comm, self.reaches = comm, reaches

    def description(self):
        return {}

    def inflate(self, upper, on_step, on_cut, restart, resume):
        states = []
        for pressure in upper[: self.reaches]:
            states.append(State({"upper_MPa": pressure}, {"span_angle_deg": 100 * pressure},
                                3, 1.0, 1.0, 0, 0.1, True))  # fmt: skip
            on_step(states[-1])
        done = self.reaches >= len(upper)
        return Path(states, self, done, "the end" if done else "Newton diverged", 0.2)


@pytest.fixture
def solved(tmp_path, monkeypatch):
    """Run `solve` on a scene that reaches so many of its two load steps."""
    monkeypatch.chdir(tmp_path)
    (tmp_path / "spar.toml").write_text(SPAR)

    def solve(reaches, *more):
        monkeypatch.setattr(
            scene_file.SceneFile, "build", lambda self, comm: FakeScene(comm, reaches)
        )
        return main(["solve", "spar.toml", *more])

    return solve


def run(command, **options):
    """Run a program as a user would from a shell, outside of this process's MPI."""
    inherited = {k: v for k, v in os.environ.items() if not k.startswith(("OMPI_", "PMIX_"))}
    as_root = {"OMPI_ALLOW_RUN_AS_ROOT": "1", "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM": "1",
               "OMPI_MCA_rmaps_base_oversubscribe": "1", "OMP_NUM_THREADS": "1"}  # fmt: skip
    return subprocess.run(
        command, env=inherited | as_root, capture_output=True, text=True, timeout=120, **options
    )


def own_lines(stderr):
    """Lines of the program itself, without what mpirun adds on a status other than 0."""
    return [line for line in stderr.splitlines() if line.startswith("morphing-wing:")]


@pytest.mark.quick
def test_all_steps_done_is_status_0_and_results_are_written(solved, tmp_path, capsys):
    assert solved(2, "--out", "results") == 0
    summary = json.loads((tmp_path / "results" / "summary.json").read_text())
    assert summary["converged"] is True
    assert summary["pressure_MPa"] == pytest.approx([0.005, 0.01])
    assert (tmp_path / "results" / "table.csv").exists()
    assert "results are in results" in capsys.readouterr().out


@pytest.mark.quick
def test_stopped_early_is_status_3_and_what_was_reached_is_written(solved, tmp_path, capsys):
    assert solved(1, "--out", "results") == 3
    summary = json.loads((tmp_path / "results" / "summary.json").read_text())
    assert summary["converged"] is False and summary["reason"] == "Newton diverged"
    assert summary["pressure_MPa"] == pytest.approx([0.005])
    assert "Newton diverged" in capsys.readouterr().out


@pytest.mark.quick
def test_results_go_to_a_folder_named_after_the_scene_file(solved, tmp_path):
    assert solved(2) == 0
    assert (tmp_path / "output" / "spar" / "summary.json").exists()


@pytest.mark.quick
def test_unexpected_failure_is_one_sentence_and_status_1(tmp_path, monkeypatch, capfd):
    def break_down(*_):
        raise ZeroDivisionError("division\nby zero")

    monkeypatch.delenv("MORPHING_WING_DEBUG", raising=False)
    monkeypatch.setattr(cli, "built_in_scenes", break_down)
    assert main(["scenes"]) == 1
    said = capfd.readouterr().err
    assert said.startswith("morphing-wing: unexpected ZeroDivisionError: division by zero")
    assert said.count("\n") == 1


@pytest.mark.quick
def test_interruption_is_status_130(monkeypatch, capfd):
    def interrupt():
        raise KeyboardInterrupt

    monkeypatch.setattr(cli, "built_in_scenes", interrupt)
    assert main(["scenes"]) == 130
    assert "morphing-wing: interrupted\n" in capfd.readouterr().err


@pytest.mark.quick
def test_a_warning_is_one_line_without_its_line_of_code(monkeypatch, capfd):
    def warn():
        warnings.warn("slow\nBLAS", stacklevel=1)
        return {"a": "# b"}

    monkeypatch.setattr(cli, "built_in_scenes", warn)
    assert main(["scenes"]) == 0
    assert capfd.readouterr().err == "morphing-wing: slow BLAS\n"


@pytest.mark.quick
def test_scenes_lists_every_built_in_scene_with_its_first_line(capfd):
    assert main(["scenes"]) == 0
    lines = capfd.readouterr().out.splitlines()
    assert [line.split()[0] for line in lines] == sorted(built_in_scenes())
    assert "spar-n4          Short spar: Section 3.3 with 4 chambers a row" in "\n".join(lines)


@pytest.mark.quick
def test_scenes_name_prints_the_file_to_the_letter(capfd):
    assert main(["scenes", "wing-cables"]) == 0
    assert capfd.readouterr().out == built_in_scenes()["wing-cables"]


@pytest.mark.quick
def test_scenes_with_an_unknown_name_tells_which_there_are(capfd):
    assert main(["scenes", "kite"]) == 2
    assert "scene 'kite': must be one of rib-prototype, " in capfd.readouterr().err


@pytest.mark.quick
@pytest.mark.parametrize("arguments", [
    [], ["--help"], ["solve", "--help"], ["scenes", "--help"], ["calibrate", "--help"]])
def test_help_is_status_0_and_says_nothing_on_stderr(arguments, capfd):
    assert main(arguments) == 0
    said = capfd.readouterr()
    assert "morphing-wing" in said.out and said.err == ""


def test_listing_scenes_and_refusing_a_file_load_no_dolfinx(tmp_path):
    (tmp_path / "bad.toml").write_text(SPAR.replace("10 kPa", "10 mm"))
    code = (
        "import sys; from morphing_wing.cli import main\n"
        "assert main(['scenes']) == 0 and main(['solve', 'bad.toml']) == 2\n"
        "loaded = {'dolfinx', 'petsc4py', 'gmsh', 'pyvista', 'matplotlib'} & set(sys.modules)\n"
        "assert not loaded, loaded"
    )
    done = run([sys.executable, "-c", code], cwd=tmp_path)
    assert done.returncode == 0, done.stderr


def test_program_refuses_bad_input_with_status_2(tmp_path):
    (tmp_path / "bad.toml").write_text(SPAR.replace("10 kPa", "10 mm"))
    done = run([BIN, "solve", "bad.toml"], cwd=tmp_path)
    assert done.returncode == 2 and done.stdout == ""
    assert own_lines(done.stderr) == done.stderr.splitlines()
    assert len(own_lines(done.stderr)) == 1
    assert [file.name for file in tmp_path.iterdir()] == ["bad.toml"]


def test_program_solves_a_spar_and_writes_the_summary(tmp_path):
    (tmp_path / "spar.toml").write_text(SPAR)
    done = run([BIN, "solve", "spar.toml", "--out", "results", "--modes", "2"], cwd=tmp_path)
    assert done.returncode == 0, done.stderr
    assert "2 mode(s) about the last state" in done.stdout
    modes = tmp_path / "results" / "modes"
    assert (modes / "mode_2.png").stat().st_size > 10_000
    assert (modes / "fields" / "modes.pvd").read_text().count("<DataSet") == 2
    summary = json.loads((tmp_path / "results" / "summary.json").read_text())
    assert summary["fidelity"] == "draft" and summary["converged"]
    assert np.all(np.diff([0.0, *summary["span_angle_deg"]]) > 0.1)


needs_mpirun = pytest.mark.skipif(shutil.which("mpirun") is None, reason="mpirun is not installed")


@needs_mpirun
def test_two_ranks_refuse_bad_input_in_one_sentence_together(tmp_path):
    (tmp_path / "bad.toml").write_text(SPAR.replace("10 kPa", "10 mm"))
    done = run(["mpirun", "-n", "2", BIN, "solve", "bad.toml"], cwd=tmp_path)
    assert done.returncode == 2
    assert len(own_lines(done.stderr)) == 1 and "Traceback" not in done.stderr
    assert [file.name for file in tmp_path.iterdir()] == ["bad.toml"]


ALONE = """
import sys, time
from mpi4py import MPI
from morphing_wing.cli import explain
from morphing_wing.together import run_together
def command():
    print("rank", MPI.COMM_WORLD.rank, "prints")
    {body}
    return 0
sys.exit(run_together(MPI.COMM_WORLD, command, explain, patience=0.5))
"""


def two_ranks(body):
    code = ALONE.format(body=body)
    return run(["mpirun", "-n", "2", sys.executable, "-c", code])


@needs_mpirun
def test_a_rank_that_fails_alone_ends_the_other_that_waits_for_it():
    done = two_ranks("if MPI.COMM_WORLD.rank == 1: 1 / 0\n    MPI.COMM_WORLD.Barrier()")
    assert done.returncode == 1
    assert len(own_lines(done.stderr)) == 1 and "ZeroDivisionError" in own_lines(done.stderr)[0]
    assert "Traceback" not in done.stderr


@needs_mpirun
def test_a_rank_that_fails_alone_at_the_end_decides_the_status_of_both():
    done = two_ranks("if MPI.COMM_WORLD.rank == 1: 1 / 0")
    assert done.returncode == 1
    assert len(own_lines(done.stderr)) == 1


@needs_mpirun
def test_rank_0_alone_is_heard():
    done = two_ranks("time.sleep(MPI.COMM_WORLD.rank)")
    assert done.returncode == 0
    assert done.stdout == "rank 0 prints\n"
