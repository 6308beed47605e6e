"""`morphing-wing solve` survives SIGKILL at any moment: no more than the step in hand is lost."""

import json
import os
import pathlib
import random
import re
import shutil
import signal
import subprocess
import sys
import time

import numpy as np
import pandas as pd
import pytest

from morphing_wing.cli import main

PROGRAM = os.path.join(os.path.dirname(sys.executable), "morphing-wing")
SCENE = """scene = "spar"
fidelity = "draft"
[geometry]
preset = "validation"
n_cells = 1
[loads]
upper = { to = "20 kPa", points = 30 }
"""
KILLS, POINTS = 10, 30
PATIENCE = 100.0
# Processes of their own, outside of this one's MPI.
ALONE = {name: value for name, value in os.environ.items()
         if not name.startswith(("OMPI_", "PMIX_"))} | {
    "OMP_NUM_THREADS": "1", "OMPI_ALLOW_RUN_AS_ROOT": "1", "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM": "1",
    "OMPI_MCA_rmaps_base_oversubscribe": "1",
    "PRTE_MCA_rmaps_default_mapping_policy": ":oversubscribe"}  # fmt: skip


class Run:
    """The program, running in the present folder with its results in ``run``."""

    def __init__(self, *more, ranks=1):
        mpirun = ["mpirun", "-n", str(ranks)] if ranks > 1 else []
        self._said = pathlib.Path("said.txt")
        with self._said.open("w") as said:
            self.process = subprocess.Popen(
                [*mpirun, PROGRAM, "solve", "spar.toml", "--out", "run", *more], env=ALONE,
                stdout=said, stderr=subprocess.STDOUT, start_new_session=True)

    def said(self):
        return self._said.read_text()

    def announced(self):
        """Return how many steps this run has told of."""
        return len(re.findall(r"^ +\d+ +[\d.]+ ", self.said(), re.MULTILINE))

    def wait_until(self, condition, pause=0.005):
        """Wait for a condition, or for the end of the run."""
        patience = time.monotonic() + PATIENCE
        while not condition() and self.process.poll() is None:
            assert time.monotonic() < patience, self.said()
            time.sleep(pause)

    def kill(self):
        """Kill the whole family at once, ranks that stand in groups of their own too."""
        os.kill(self.process.pid, signal.SIGSTOP)
        for pid in (self.process.pid, *descendants(self.process.pid)):
            os.kill(pid, signal.SIGKILL)
        self.process.wait()


def descendants(pid):
    found = []
    for children in pathlib.Path(f"/proc/{pid}/task").glob("*/children"):
        for child in map(int, children.read_text().split()):
            found += [child, *descendants(child)]
    return found


def stored():
    """Return the steps in the restart file, which must be whole; none without a file."""
    if not os.path.exists("run/restart.npz"):
        return []
    with np.load("run/restart.npz") as file:
        return json.loads(str(file["head"]))["states"]


def half_written():
    return [name for name in (os.listdir("run") if os.path.isdir("run") else ())
            if name.startswith(".restart-")]


def table(folder):
    return pd.read_csv(f"{folder}/table.csv", index_col="step").drop(columns="step_seconds")


def start(before, ranks=1):
    """Start the program as its user would after a kill: with --resume if that can be."""
    if before:
        return Run("--resume", ranks=ranks)
    refused = Run("--resume")
    assert refused.process.wait(PATIENCE) == 2
    assert refused.said() == (
        "morphing-wing: --resume: run must hold a restart.npz of a run to go on with\n")
    return Run(ranks=ranks)


def any_moment(run, chance):
    time.sleep(chance.uniform(0.0, 1.5))


def after_some_steps(run, chance):
    steps = chance.randint(1, 4)
    run.wait_until(lambda: run.announced() >= steps)
    time.sleep(chance.uniform(0.0, 0.1))


def while_it_writes(run, chance):
    steps, old = chance.randint(1, 3), half_written()
    run.wait_until(lambda: run.announced() >= steps)
    run.wait_until(lambda: set(half_written()) - set(old), pause=0.0)


@pytest.mark.skipif(shutil.which("mpirun") is None, reason="mpirun is not installed")
def test_ten_kills_lose_no_step_and_change_no_figure(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    pathlib.Path("spar.toml").write_text(SCENE)
    chance, steps, kills = random.Random(20), [], 0
    moments = [any_moment, after_some_steps, while_it_writes]
    while kills < KILLS:
        run = start(steps, ranks=2 if kills == 7 else 1)
        moments[kills % len(moments)](run, chance)
        if run.process.poll() is not None:  # faster than the killer
            assert run.process.returncode == 0, run.said()
            shutil.rmtree("run")
            steps = []
            continue
        run.kill()
        kills += 1
        before, steps = steps, stored()
        assert steps[:len(before)] == before
        assert 0 <= len(steps) - len(before) - run.announced() <= 1

    run = start(steps)
    run.wait_until(lambda: "done after" in run.said())
    time.sleep(chance.uniform(0.0, 0.5))
    run.kill()
    assert len(stored()) == POINTS
    last = start(steps)
    assert last.process.wait(PATIENCE) == 0, last.said()
    assert f"{POINTS} step(s) were done before, none now" in last.said()
    assert {"summary.json", "table.csv", "angles.png", "fields"} <= set(os.listdir("run"))
    assert not [name for name in os.listdir("run") if name.startswith(".")]

    assert main(["solve", "spar.toml", "--out", "whole"]) == 0
    pd.testing.assert_frame_equal(table("run"), table("whole"), rtol=1e-10, atol=1e-12)
