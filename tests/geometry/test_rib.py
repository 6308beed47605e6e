"""The rib's frame: where joints are, what is joined, which sections."""

import dataclasses

import numpy as np
import pytest

from morphing_wing.analytic_rib import rib_compliance
from morphing_wing.errors import InputError
from morphing_wing.geometry.frame import join
from morphing_wing.geometry.rib import RibGeometry
from morphing_wing.geometry.rib_solid import check_room
from morphing_wing.geometry.section import Circle, Rectangle, torsion_constant
from morphing_wing.materials import RESIN

pytestmark = pytest.mark.quick


def has_point(frame, x):
    return np.any(np.linalg.norm(frame.points - np.asarray(x), axis=1) < 1e-12)


def test_prototype_cells_are_3_277_mm_long_and_2_294_mm_high():
    rib = RibGeometry.prototype()
    assert rib.pitch == pytest.approx(4.0 * np.cos(np.radians(35.0)))
    assert rib.height == pytest.approx(4.0 * np.sin(np.radians(35.0)))
    assert rib.length == pytest.approx(17 * 3.27661, abs=1e-3)


@pytest.mark.parametrize(("section", "spacing"), [("flush", 5.4), ("square", 6.6)])
def test_layers_are_pivot_length_apart_between_midplanes_or_faces(section, spacing):
    rib = RibGeometry.validation(section)
    z = np.unique(np.round(rib.frame().points[:, 2], 9))
    assert rib.spacing == pytest.approx(spacing)
    assert {-spacing, 0.0, spacing} <= set(z)


def test_middle_bars_rise_and_outer_bars_fall():
    rib = RibGeometry.validation()
    frame = rib.frame()
    p, h, s = rib.pitch, rib.height, rib.spacing
    for i in range(rib.n_cells):
        for layer, sign in ((0, 1), (1, -1), (-1, -1)):
            ends = [(i * p, -sign * h / 2, layer * s), ((i + 1) * p, sign * h / 2, layer * s)]
            crossing = ((i + 0.5) * p, 0.0, layer * s)
            assert all(has_point(frame, x) for x in [*ends, crossing])
    shafts = frame.bars[frame.of_kind("shaft")]
    step = frame.points[shafts[:, 1]] - frame.points[shafts[:, 0]]
    rising = step[:, 0] * step[:, 1] > 0
    middle = np.abs(frame.points[shafts[:, 0], 2]) < 1e-12
    assert np.array_equal(rising, middle)
    assert np.allclose(np.linalg.norm(step, axis=1), 6.5 / 2)


@pytest.mark.parametrize("n", [1, 2, 6])
def test_counts_of_bars_and_pivots(n):
    frame = dataclasses.replace(RibGeometry.validation(), n_cells=n).frame()
    assert len(frame.of_kind("shaft")) == 6 * n
    assert len(frame.of_kind("pivot")) == 4 * (n - 1)
    assert len(frame.of_kind("centre_pivot")) == 2 * n
    assert len(frame.of_kind("socket")) == 2 * (4 * (n - 1) + 2 * n)
    assert len(frame.of_kind("arm")) == 6


def test_frame_is_its_own_mirror_image_in_z():
    points = RibGeometry.prototype().frame().points
    image = points * [1, 1, -1]
    distance = np.linalg.norm(points[:, None] - image[None], axis=2)
    assert np.all(distance.min(axis=1) < 1e-12)


def test_only_root_and_tail_points_end_one_bar_alone():
    rib = RibGeometry.validation()
    frame = rib.frame()
    count = np.bincount(frame.bars.ravel(), minlength=len(frame.points))
    assert set(np.flatnonzero(count == 1)) == {frame.roots[0], frame.tails[0]}
    assert np.allclose(frame.points[frame.roots[0]], 0.0)
    assert np.allclose(frame.points[frame.tails[0]], [rib.length, 0.0, 0.0])


@pytest.mark.parametrize("n", [1, 6])
def test_two_layers_have_the_bars_and_pivots_of_one_gap(n):
    rib = dataclasses.replace(RibGeometry.validation("square"), n_cells=n, layers=2)
    frame = rib.frame()
    z = np.unique(np.round(frame.points[frame.bars[frame.of_kind("shaft")]][..., 2], 9))
    assert z.tolist() == [-3.3, 3.3] and rib.depth == pytest.approx(5.4 + 2 * 1.2)
    counts = {name: len(frame.of_kind(name)) for name in frame.names}
    assert counts == {"shaft": 4 * n, "pivot": 2 * (n - 1), "centre_pivot": n,
                      "socket": 2 * (3 * n - 2), "arm": 4, "root": 1, "tail": 1, "boss": 0}
    assert np.allclose(frame.points[[*frame.roots, *frame.tails]], [[0, 0, 0], [rib.length, 0, 0]])


def test_two_layers_are_as_before_when_turned_by_half_a_turn_about_the_chord():
    points = dataclasses.replace(RibGeometry.prototype(), layers=2).frame().points
    distance = np.linalg.norm(points[:, None] - points[None] * [1, -1, -1], axis=2)
    assert np.all(distance.min(axis=1) < 1e-12)


def test_sockets_fill_the_half_thickness_of_the_bars():
    rib = RibGeometry.validation("square")
    frame = rib.frame()
    ends = frame.points[frame.bars]
    length = np.linalg.norm(ends[:, 1] - ends[:, 0], axis=1)
    assert np.allclose(length[frame.of_kind("socket")], 0.6)
    assert np.allclose(length[frame.of_kind("pivot")], 5.4)


def test_local_axes_are_right_handed_triads_along_the_bars():
    frame = RibGeometry.validation().frame()
    step = frame.points[frame.bars[:, 1]] - frame.points[frame.bars[:, 0]]
    e1 = step / np.linalg.norm(step, axis=1, keepdims=True)
    assert np.allclose(frame.axes[:, 0], e1)
    assert np.allclose(frame.axes @ frame.axes.transpose(0, 2, 1), np.eye(3))
    assert np.allclose(np.linalg.det(frame.axes), 1.0)
    assert np.allclose(frame.axes[frame.of_kind("shaft"), 2], [0.0, 0.0, 1.0])


def test_bosses_widen_square_bars_only_and_by_their_mean_flexibility():
    square = RibGeometry.prototype(2, "square", bosses=True).frame()
    flush = RibGeometry.prototype(2, "flush", bosses=True).frame()
    assert len(flush.of_kind("boss")) == 0
    assert len(square.of_kind("boss")) == 2 * len(square.of_kind("shaft"))
    reach = np.sqrt(0.75**2 - 0.5**2)
    x = (np.arange(100000) + 0.5) * reach / 100000
    chords = 2.0 * np.sqrt(0.75**2 - x**2)
    assert square.sections[0]["boss"].width == pytest.approx(np.mean(chords**-3) ** (-1 / 3))


def test_torsion_constants_of_square_and_thin_strip():
    assert torsion_constant(1.0, 1.0) == pytest.approx(0.140577, rel=1e-5)
    assert torsion_constant(1.0, 0.001) == pytest.approx(1.0 * 0.001**3 / 3.0, rel=1e-3)
    assert torsion_constant(1.5, 1.2) == torsion_constant(1.2, 1.5)


def test_stiffness_of_a_circle_and_a_rectangle():
    E, nu = 2500.0, 0.35
    G = E / 2.7
    EA, GA2, GA3, GJ, EI2, EI3 = Circle(2.0).stiffness(E, nu)
    assert (EA, GJ, EI2, EI3) == pytest.approx(np.pi * np.array([E, G / 2, E / 4, E / 4]))
    assert GA2 == GA3 == pytest.approx(G * np.pi * 8.1 / 9.1)
    _, GA2, _, _, EI2, EI3 = Rectangle(width=2.0, depth=3.0).stiffness(E, nu)
    assert (GA2, EI2, EI3) == pytest.approx((5 * G, E * 4.5, E * 2.0))


def test_bars_have_the_areas_of_their_sections_and_stiffened_pieces_their_own():
    frame = RibGeometry.prototype(2, section="square").frame()
    areas = {name: set(frame.areas()[frame.of_kind(name)]) for name in ("shaft", "pivot", "arm")}
    assert areas == {"shaft": {1.0}, "pivot": {np.pi * 1.5**2 / 4}, "arm": {np.pi * 1.5**2 / 4}}


def test_joined_ribs_keep_their_ends_and_sections():
    one, two = RibGeometry.validation(), RibGeometry.prototype(3)
    both = join([one.frame(), two.frame().placed((75.0, 0.0, 20.0))])
    assert np.allclose(both.points[both.roots], [[0, 0, 0], [75, 0, 20]])
    assert np.allclose(both.points[both.tails], [[one.length, 0, 0], [75 + two.length, 0, 20]])
    alone = np.concatenate([g.frame().stiffness(2500.0, 0.35) for g in (one, two)])
    assert np.array_equal(both.stiffness(2500.0, 0.35), alone)


@pytest.mark.parametrize(
    ("change", "sentence"),
    [
        ({"shaft_length": -1.0}, "shaft_length = -1 mm: must be"),
        ({"pivot_length": 0.0}, "pivot_length = 0 mm: must be"),
        ({"shaft_thickness": float("nan")}, "shaft_thickness = nan mm: must be"),
        ({"crossing_angle": 180.0}, "crossing_angle = 180 degrees: must be"),
        ({"n_cells": 0}, "n_cells = 0: must be a whole number"),
        ({"n_cells": 2.5}, "n_cells = 2.5: must be a whole number"),
        ({"section": "round"}, "section = 'round': must be 'flush' or 'square'"),
        ({"pivot_diameter": 3.4}, "pivot_diameter = 3.4 mm: must be less than 3.25 mm"),
        ({"shaft_thickness": 5.4}, "shaft_thickness = 5.4 mm: must be less than"),
        ({"bosses": 1}, "bosses = 1: must be True or False"),
        ({"layers": 1}, "layers = 1: must be 2 or 3"),
        ({"layers": True}, "layers = True: must be 2 or 3"),
        ({"layers": 3.0}, "layers = 3: must be 2 or 3"),
    ],
)
def test_what_cannot_be_built_is_refused_in_one_sentence(change, sentence):
    with pytest.raises(InputError) as refused:
        dataclasses.replace(RibGeometry.validation(), **change)
    assert str(refused.value).startswith(sentence)
    assert "\n" not in str(refused.value)


def test_formulas_and_solids_are_of_three_layers():
    rib = dataclasses.replace(RibGeometry.validation(), layers=2)
    with pytest.raises(InputError, match="^layers = 2: must be 3 for the paper's formulas$"):
        rib_compliance(rib, RESIN)
    with pytest.raises(InputError, match="^layers = 2: must be 3 for a rib as a solid, which is"):
        check_room(rib)
