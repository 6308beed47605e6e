import fcntl
import json
import subprocess
import sys

import numpy as np
import pytest
from fake_scenes import spar_path

from morphing_wing.errors import InputError
from morphing_wing.path import Path, State, load_table
from morphing_wing.root import write_whole

COLUMNS = ["pressure_MPa", "upper_MPa", "lower_MPa", "span_angle_deg", "span_line_deg",
           "newton_iterations", "energy_Nmm", "external_work_Nmm", "negative_pivots",
           "step_seconds", "requested"]


@pytest.fixture(scope="module")
def path():
    return spar_path(n_cells=2)


def test_table_has_one_row_a_converged_step_and_every_column(path):
    table = path.table()
    assert list(table.columns) == COLUMNS
    assert len(table) == len(path) == 4
    assert table["pressure_MPa"].tolist() == [0.0, 0.01, 0.02, 0.03]
    assert table["requested"].tolist() == [True, True, False, True]


def test_pressure_is_the_lower_chambers_where_only_these_are_inflated(path):
    states = [State({"upper_MPa": 0.0, "lower_MPa": p}, {}, 3, 0.0, 0.0, 0, 0.1, True)
              for p in (0.0, 0.02)]
    table = Path(states, path.scene, True, "", 1.0).table()
    assert table["pressure_MPa"].tolist() == [0.0, 0.02]


def test_a_slice_is_a_path_and_an_index_a_state(path):
    assert isinstance(path[1:3], Path)
    assert [state.load["upper_MPa"] for state in path[1:3]] == [0.01, 0.02]
    assert path[-1].load["upper_MPa"] == 0.03


def test_summary_is_strict_json_with_every_contract_key_of_equal_length(path, tmp_path):
    path.save(tmp_path)

    def no_constants(name):
        raise AssertionError(f"{name} is no JSON")

    text = (tmp_path / "summary.json").read_text()
    summary = json.loads(text, parse_constant=no_constants)
    for name in ("pressure_MPa", "torque_Nmm", "cable_N", "span_angle_deg", "chord_angle_deg",
                 "newton_iterations", "energy_Nmm"):
        assert len(summary[name]) == len(path), name
    assert {"dofs", "seconds", "converged", "reason", "fidelity", "versions"} <= set(summary)
    assert summary["pressure_MPa"] == [0.0, 0.01, 0.02, 0.03]
    assert summary["cable_N"] == [0.0] * 4
    assert summary["chord_angle_deg"] == [None] * 4
    assert summary["converged"] is True
    assert summary["parameters"]["limits"] == [1.0, None]  # infinity is no JSON number


def test_a_path_without_states_still_writes_its_summary(path, tmp_path):
    Path([], path.scene, False, "the first step failed", 2.0).save(tmp_path)
    summary = json.loads((tmp_path / "summary.json").read_text())
    assert summary["reason"] == "the first step failed"
    assert summary["pressure_MPa"] == []
    assert (tmp_path / "table.csv").exists()


def test_saved_table_reads_back_bit_for_bit(path, tmp_path):
    third = State({"upper_MPa": 1 / 30, "lower_MPa": 0.0}, {"span_angle_deg": np.pi, "contact": 1},
                  4, 1e-17, 2 / 3, 1, 0.1, True)
    written = Path([path[0], third], path.scene, True, "", 1.0)
    written.save(tmp_path)
    read = load_table(tmp_path)
    expected = written.table()
    assert list(read.columns) == list(expected.columns)
    for name in expected:
        np.testing.assert_array_equal(read[name].to_numpy(), expected[name].to_numpy(), name)


def test_contact_flags_its_rows_and_the_summary_names_the_first(path):
    states = [State({"upper_MPa": p}, {"contact": float(p > 0.015)}, 3, 0, 0, 0, 0.1, True)
              for p in (0.01, 0.02, 0.03)]
    flagged = Path(states, path.scene, True, "", 1.0)
    assert flagged.table()["contact"].tolist() == [False, True, True]
    assert flagged.summary()["contact_from"] == 1
    assert path.summary()["contact_from"] is None


def test_a_failed_write_leaves_the_old_file_and_no_other(tmp_path):
    file = tmp_path / "table.csv"
    file.write_text("old")

    def fails(name):
        name.write_text("half of")
        raise OSError("disk full")

    with pytest.raises(OSError, match="disk full"):
        write_whole(file, fails)
    assert file.read_text() == "old"
    assert list(tmp_path.iterdir()) == [file]


def test_what_a_killed_writer_has_left_is_removed_and_what_a_living_one_writes_is_not(tmp_path):
    left, living, other = (tmp_path / f".{name}-{end}.csv" for name, end in (
        ("table", "01234567"), ("table", "76543210"), ("tables", "01234567")))
    for file in (left, living, other):
        file.write_text("half of")
    with living.open() as held:
        fcntl.flock(held, fcntl.LOCK_EX)
        write_whole(tmp_path / "table.csv", lambda name: name.write_text("new"))
    assert set(tmp_path.iterdir()) == {tmp_path / "table.csv", living, other}
    assert (tmp_path / "table.csv").read_text() == "new"


def test_two_who_write_one_file_at_once_leave_one_of_both(tmp_path):
    file = tmp_path / "table.csv"

    def write(name):
        write_whole(file, lambda name: name.write_text("second"))
        name.write_text("first")

    write_whole(file, write)
    assert file.read_text() == "first" and list(tmp_path.iterdir()) == [file]


def test_saving_onto_a_file_is_bad_input(path, tmp_path):
    file = tmp_path / "run"
    file.write_text("a file")
    with pytest.raises(InputError, match="must be a folder"):
        path.save(file)


def test_a_table_that_is_not_there_is_bad_input(tmp_path):
    with pytest.raises(InputError, match="table.csv"):
        load_table(tmp_path)


def test_saving_leaves_the_scene_in_the_state_in_which_it_was(path, tmp_path):
    scene = path.scene
    scene.show(path[1])
    path.save(tmp_path)
    function = scene.functions["elastomer"]
    np.testing.assert_array_equal(function.x.array, path[1].fields["elastomer"])


def test_importing_path_loads_no_plotting_package():
    code = ("import sys, morphing_wing.path; "
            "raise SystemExit(any(m in sys.modules for m in ('pyvista', 'matplotlib', 'vtk')))")
    assert subprocess.run([sys.executable, "-c", code], check=False).returncode == 0
