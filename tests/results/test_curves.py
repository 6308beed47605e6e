import matplotlib.image
import numpy as np
import pandas as pd
import pytest
from fake_scenes import spar_path

from morphing_wing import curves
from morphing_wing.curves import plot_paths
from morphing_wing.errors import InputError
from morphing_wing.path import Path, State


@pytest.fixture(scope="module")
def path():
    return spar_path(n_cells=1)


@pytest.fixture
def axes():
    return curves._figure((4, 3), 1)[1][0]


def finite(line):
    return np.isfinite(line.get_ydata().astype(float))


def test_plot_writes_the_kind_of_file_that_was_asked_for(path, tmp_path):
    for name, start in (("a.png", b"\x89PNG"), ("a.pdf", b"%PDF"), ("a.svg", b"<?xml")):
        assert (path.plot(tmp_path / name)).read_bytes().startswith(start)
    assert matplotlib.image.imread(tmp_path / "a.png").std() > 0.05


def test_unknown_kind_of_file_is_bad_input(path, tmp_path):
    with pytest.raises(InputError, match="must end in"):
        path.plot(tmp_path / "a.curve")
    assert not list(tmp_path.iterdir())


def test_contact_is_dashed_from_the_last_state_without_it(axes):
    table = pd.DataFrame({
        "pressure_MPa": [0.0, 0.01, 0.02, 0.03], "span_angle_deg": [0.0, 1.0, 2.0, 3.0],
        "contact": [False, False, True, True], "requested": [True, False, True, True]})
    curves._curve(axes, table, "pressure_MPa", "span_angle_deg", "k", "a")
    solid, dashed, markers, _ = axes.lines
    assert finite(solid).tolist() == [True, True, False, False]
    assert finite(dashed).tolist() == [False, True, True, True]
    assert dashed.get_linestyle() == "--"
    assert markers.get_xdata().tolist() == [0.0, 20.0, 30.0]  # asked for; in kPa


def test_the_load_that_changes_is_the_abscissa():
    table = pd.DataFrame({"pressure_MPa": [0.02, 0.02], "cable_N": [0.0, 0.1]})
    assert curves._load_column(table, "pressure_MPa") == "cable_N"
    table["pressure_MPa"] = [0.0, 0.02]
    assert curves._load_column(table, "pressure_MPa") == "pressure_MPa"


def test_paths_and_tables_are_compared_in_one_figure(path, tmp_path):
    measured = path.table()[["pressure_MPa", "span_angle_deg"]]
    plot_paths({"computed": path, "measured": measured}, tmp_path / "both.png")
    assert matplotlib.image.imread(tmp_path / "both.png").std() > 0.05


def test_comparing_what_lacks_the_column_is_bad_input(path, tmp_path):
    with pytest.raises(InputError, match="span_angle_deg"):
        plot_paths({"a": path, "b": path.table()[["pressure_MPa"]]}, tmp_path / "both.png")
    with pytest.raises(InputError, match="at least one path"):
        plot_paths({}, tmp_path / "none.png")


def test_a_single_state_and_a_stopped_path_are_drawn(path, tmp_path):
    one = Path([State({"upper_MPa": 0.01}, {"span_angle_deg": 2.0}, 3, 1.0, 1.0, 0, 0.1, True)],
               path.scene, False, "Newton diverged", 1.0)
    assert one.plot(tmp_path / "one.png").stat().st_size > 10_000


def test_pressure_of_filled_chambers_is_dashed_where_it_falls_while_they_grow(axes):
    volume = np.array([0.0, 1000.0, 2000.0, 3000.0, 2000.0])
    table = pd.DataFrame({"upper_mm3": volume, "pressure_MPa": [0.0, 0.05, 0.08, 0.07, 0.08],
                          "negative_pivots": [0, 0, 0, 1, 0]})
    curves._pressure(axes, table, "upper_mm3")
    solid, dashed, unstable = axes.get_lines()
    assert finite(solid).tolist() == [True, True, True, False, False]
    assert finite(dashed).tolist() == [False, False, True, True, True]
    assert unstable.get_xdata().tolist() == [3.0]
