"""What is in the picture of Figure 7, and in that of the map."""

import matplotlib.image
import pandas as pd
import pytest

from morphing_wing import figure7_picture, reach_picture
from tests.studies.made_up import curve, study

pytestmark = pytest.mark.quick


def texts(axes):
    return " ".join(text.get_text() for text in axes.texts).replace("\n", " ")


def labels(figure):
    return {text.get_text() for text in figure.legends[0].get_texts()}


def drawn(axes, style):
    """Return the x of all points on lines of a style that belong to curves."""
    return [line.get_xdata()[~pd.isna(line.get_ydata())].tolist()
            for line in axes.lines if line.get_linestyle() == style and len(line.get_xdata()) > 2]


def test_axes_have_the_papers_symbols_and_units_and_what_it_states():
    figure = figure7_picture.figure(study(curve("pressure"), curve("cables")), {})
    pressure, cables, below, beside = figure.axes
    assert "varphi_1" in pressure.get_ylabel() and "varphi_2" in cables.get_ylabel()
    assert below.get_xlabel() == "pressure $P$, kPa"
    assert beside.get_xlabel() == "tension of each cable $T$, N"
    assert "varphi_2" in below.get_ylabel() and "varphi_1" in beside.get_ylabel()
    assert "reached in the test: 12\N{DEGREE SIGN}" in texts(pressure)
    assert "beyond 25 kPa the test is softer than the paper's FEM" in texts(pressure)
    assert texts(cables) == "reached in the test: 35\N{DEGREE SIGN}"


def test_both_directions_have_both_limits():
    table = study(*(curve(p, direction=d) for p in ("pressure", "cables") for d in ("down", "up")))
    pressure, cables, *_ = figure7_picture.figure(table, {}).axes
    assert "\N{MINUS SIGN}12\N{DEGREE SIGN}" in texts(pressure)
    assert "\N{MINUS SIGN}35\N{DEGREE SIGN}" in texts(cables)


def test_a_curve_is_dashed_into_and_beyond_the_first_state_without_contact_forces():
    table = curve("cables", contact=[False, False, True, True])
    figure = figure7_picture.figure(table, {})
    cables = figure.axes[1]
    assert [0.1, 0.2, 0.4] in drawn(cables, "--")
    assert [0.0, 0.1] in drawn(cables, "-")
    assert "no contact forces: skin passes through" in labels(figure)
    with_forces = figure7_picture.figure(table.drop(columns="contact"), {})
    assert [0.0, 0.1, 0.2, 0.4] in drawn(with_forces.axes[1], "-")
    assert "no contact forces: skin passes through" not in labels(with_forces)


def test_the_legend_has_what_is_drawn_and_nothing_else():
    figure = figure7_picture.figure(curve("cables", skin=False), {})
    assert {"without skin", "fidelity \u201cdraft\u201d"} < labels(figure)
    assert not {"with skin", "unstable", "stopped before the last load"} & labels(figure)
    key = ("cables", False, "down", "draft")
    figure = figure7_picture.figure(curve("cables", skin=False, negative_pivots=1), {key: "why"})
    assert {"unstable", "stopped before the last load"} < labels(figure)


def test_no_text_lies_on_another():
    table = study(*(curve(p, direction=d, skin=s, fidelity=f)
                    for p in ("pressure", "cables") for d in ("down", "up")
                    for s in (True, False) for f in ("draft", "standard")))
    figure = figure7_picture.figure(table, {})
    figure.canvas.draw()
    boxes = [text.get_window_extent() for axes in figure.axes
             for text in [*axes.texts, axes.xaxis.label, axes.yaxis.label]]
    boxes += [figure.legends[0].get_window_extent()]
    boxes = [box for box in boxes if box.width > 0]
    assert not [(a, b) for i, a in enumerate(boxes) for b in boxes[:i] if a.overlaps(b)]


def test_pictures_are_written(tmp_path):
    figure7_picture.draw(study(curve("pressure"), curve("cables")), tmp_path / "fig7.png")
    reach_picture.draw(grid(), tmp_path / "map.png")
    for name in ("fig7.png", "map.png"):
        assert matplotlib.image.imread(tmp_path / name).std() > 0.05


def grid(**columns):
    """Return a map of 3 x 3 points, phi_1 by pressure and phi_2 by cables alone."""
    rows = [{"upper_MPa": p, "cable_N": t, "span_angle_deg": 600 * p, "chord_angle_deg": 80 * t,
             "rib_stress_MPa": 100 * t, "largest_stretch": 1.5, "negative_pivots": 0}
            for p in (0.0, 0.01, 0.02) for t in (0.0, 0.2, 0.4)]
    return pd.DataFrame(rows).assign(**columns)


def test_map_has_lines_of_each_load_and_a_limit_where_it_is_passed():
    figure = reach_picture.figure(grid())
    (axes,) = figure.axes
    for text in ("0 kPa", "10 kPa", "20 kPa", "0 N", "0.2 N", "0.4 N"):
        assert text in [t.get_text() for t in axes.texts]
    (contours,) = axes.collections
    assert contours.get_paths()[0].vertices[:, 1] == pytest.approx(28.0)  # 35 MPa at 0.35 N
    assert "resin yields (35 MPa)" in labels(figure)
    assert not [label for label in labels(figure) if "tears" in label or "unstable" in label]


def test_map_that_stopped_on_its_way_is_drawn():
    figure = reach_picture.figure(grid().iloc[:5])
    assert "resin yields (35 MPa)" in labels(figure)
