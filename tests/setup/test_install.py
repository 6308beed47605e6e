import importlib.util
import shutil
import subprocess
import sys
import time
import zipfile
from pathlib import Path

import pytest

pytestmark = pytest.mark.quick

PROJECT = Path(__file__).resolve().parents[2]
INSTALLED_AS = {
    "morphing_wing": "morphing_wing",
    "geometry": "morphing_wing/geometry",
    "forms": "morphing_wing/forms",
}


@pytest.mark.parametrize("room", ["geometry", "forms"])
def test_rooms_are_parts_of_the_package(room):
    found = importlib.util.find_spec(f"morphing_wing.{room}")
    assert Path(found.origin).parent == PROJECT / room


def test_a_plain_wheel_carries_every_module_scene_table_and_licence(tmp_path):
    source = tmp_path / "source"
    for folder in INSTALLED_AS:
        shutil.copytree(PROJECT / folder, source / folder)
    for name in ("pyproject.toml", "README.md", "LICENSE"):
        shutil.copy(PROJECT / name, source)
    command = [sys.executable, "-m", "pip", "wheel", "--quiet", "--no-deps", "--no-build-isolation"]
    subprocess.run([*command, "--wheel-dir", tmp_path, source], check=True)
    packed = set(zipfile.ZipFile(next(tmp_path.glob("*.whl"))).namelist())
    expected = {
        f"{INSTALLED_AS[folder]}/{file.relative_to(PROJECT / folder)}"
        for folder in INSTALLED_AS
        for pattern in ("**/*.py", "**/*.toml", "**/*.csv", "data/*.md")
        for file in (PROJECT / folder).glob(pattern)
    }
    assert expected - packed == set()


def test_set_up_is_silent_and_fast_the_second_time():
    made_here = (PROJECT / ".venv/morphing-wing.stamp").exists()
    if Path(sys.prefix) != PROJECT / ".venv" or not made_here:
        pytest.skip("this environment was not made by `make setup`")
    run_set_up()
    began = time.perf_counter()
    assert run_set_up() == ""
    assert time.perf_counter() - began < 2.0


def run_set_up() -> str:
    """Run what `make setup` runs and return all that it says."""
    return "".join(
        subprocess.run(
            ["sh", PROJECT / "setup" / script],
            stdout=subprocess.PIPE,
            stderr=subprocess.STDOUT,
            text=True,
            check=True,
        ).stdout
        for script in ("system.sh", "venv.sh")
    )
