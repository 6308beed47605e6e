"""The cuboid spar's mesh: closed forms of its volume and faces, mirror images, bad input."""

import dataclasses

import numpy as np
import pytest

from morphing_wing.errors import InputError
from morphing_wing.geometry.spar import SparGeometry, SparMeshing
from tests.geometry import hexahedra

pytestmark = pytest.mark.quick

SPAR = SparGeometry(
    cavity_length=2.8, wall_length=2.2, top_thickness=1.0, cavity_height=6.0, middle_thickness=2.8,
    side_thickness=1.2, cavity_width=40.0, n_cells=3)
CAVITY = 40.0 * 6.0 * 2.8
CAVITY_AREA = 2 * (40.0 * 6.0 + 40.0 * 2.8 + 6.0 * 2.8)
MESHINGS = pytest.mark.parametrize("meshing", [SparMeshing.plain(), SparMeshing.graded(1)])
HALF = pytest.mark.parametrize("half", [True, False])


def test_validation_set_is_the_papers():
    spar = SparGeometry.validation()
    assert dataclasses.replace(spar, n_cells=3) == SPAR
    assert (spar.n_cells, spar.length, spar.height, spar.width) == pytest.approx(
        (20, 20 * 5.0 + 2.2, 16.8, 42.4))


def test_reference_mesh_has_1228_cells():
    mesh = SparGeometry.validation(20).mesh(SparMeshing.plain())
    assert len(mesh.cells) == 1228


@MESHINGS
@HALF
def test_volume_is_the_box_less_its_chambers(meshing, half):
    mesh = SPAR.mesh(meshing, half)
    part = 0.5 if half else 1.0
    expected = part * (42.4 * 16.8 * 17.2 - 6 * CAVITY)
    assert hexahedra.volume(mesh, "elastomer") == pytest.approx(expected, rel=1e-13)
    assert hexahedra.corner_jacobians(mesh).min() > 0.0


@MESHINGS
@HALF
def test_faces_have_the_areas_of_the_drawing(meshing, half):
    mesh = SPAR.mesh(meshing, half)
    part = 0.5 if half else 1.0
    for row in ("upper_chambers", "lower_chambers"):
        # Half of every wall: the half chamber keeps one of the two at its sides.
        expected = 3 * part * CAVITY_AREA
        assert hexahedra.area(mesh, row) == pytest.approx(expected, rel=1e-13)
    for end in ("root", "tip"):
        assert hexahedra.area(mesh, end) == pytest.approx(part * 42.4 * 16.8, rel=1e-13)
    if half:
        cut = 16.8 * 17.2 - 6 * 6.0 * 2.8
        assert hexahedra.area(mesh, "symmetry") == pytest.approx(cut, rel=1e-13)
    assert ("symmetry" in mesh.facets) == half


@HALF
def test_named_faces_and_the_bare_outside_make_up_the_boundary(half):
    mesh = SPAR.mesh(half=half)
    named = hexahedra.pairs(mesh, *mesh.facets)
    assert len(named) == len(set(named))
    bare = hexahedra.boundary(mesh) - set(named)
    mesh.facets["bare"] = np.array(sorted(bare))
    top_and_bottom, sides = 2 * 42.4 * 17.2, 2 * 16.8 * 17.2
    expected = (0.5 if half else 1.0) * (top_and_bottom + sides)
    assert hexahedra.area(mesh, "bare") == pytest.approx(expected, rel=1e-13)


def test_chambers_of_the_full_model_are_closed_and_hold_their_volume():
    mesh = SPAR.mesh(half=False)
    for row in ("upper_chambers", "lower_chambers"):
        np.testing.assert_allclose(
            hexahedra.area_vectors(mesh, row).sum(axis=0), 0.0, atol=1e-10)
        assert hexahedra.enclosed(mesh, row) == pytest.approx(3 * CAVITY, rel=1e-13)


def test_chambers_of_the_half_model_are_open_only_at_the_symmetry_plane():
    mesh = SPAR.mesh(half=True)
    for row in ("upper_chambers", "lower_chambers"):
        np.testing.assert_allclose(
            hexahedra.area_vectors(mesh, row).sum(axis=0), [-3 * 6.0 * 2.8, 0, 0], atol=1e-10)
        assert hexahedra.enclosed(mesh, row) == pytest.approx(3 * CAVITY / 2, rel=1e-13)


@MESHINGS
def test_the_cell_that_repeats_is_a_quarter_of_one_pitch(meshing):
    mesh = SPAR.cell_mesh(meshing)
    assert hexahedra.volume(mesh, "elastomer") == pytest.approx(
        (42.4 * 16.8 * 5.0 - 2 * CAVITY) / 4, rel=1e-13)
    assert hexahedra.corner_jacobians(mesh).min() > 0.0
    assert hexahedra.area(mesh, "wall_middle") == pytest.approx(42.4 * 16.8 / 2, rel=1e-13)
    assert hexahedra.area(mesh, "chamber_middle") == pytest.approx(
        (42.4 * 16.8 - 2 * 40.0 * 6.0) / 2, rel=1e-13)
    for row in ("upper_chambers", "lower_chambers"):  # one wall and half of four
        assert hexahedra.area(mesh, row) == pytest.approx(
            (40.0 * 6.0 + (40.0 + 6.0) * 2.8) / 2, rel=1e-13)
    np.testing.assert_allclose(mesh.points[:, 2].max(), 2.5, rtol=1e-14)


def test_shortened_meshing_has_no_longer_interval_and_keeps_its_breakpoints():
    parts = SparMeshing.graded(1)
    shorter = parts.shortened(0.1)
    assert np.diff(shorter.cavity_length).max() <= 0.1 + 1e-12
    assert all(np.isclose(shorter.cavity_length, at).any() for at in parts.cavity_length)
    np.testing.assert_allclose(parts.shortened(1.0).cavity_length, parts.cavity_length)


def test_walls_may_differ():
    walls = (2.0, 0.2, 3.0, 1.0)
    spar = dataclasses.replace(SPAR, wall_lengths=walls)
    assert spar.length == pytest.approx(3 * 2.8 + 6.2)
    mesh = spar.mesh(half=False)
    assert hexahedra.volume(mesh, "elastomer") == pytest.approx(
        42.4 * 16.8 * 14.6 - 6 * CAVITY, rel=1e-13)
    middles = mesh.facet_points("upper_chambers")[:, :, 2].mean(axis=1)
    z = np.array([2.0, 4.79, 5.01, 7.79, 10.81, 13.59])
    np.testing.assert_array_equal(spar.chamber_of(z), [0, 0, 1, 1, 2, 2])
    assert set(spar.chamber_of(mesh.beyond("upper_chambers")[:, 2])) == {0, 1, 2}
    assert middles.min() > 1.9
    alike = dataclasses.replace(SPAR, wall_lengths=(2.2,) * 4).mesh()
    np.testing.assert_allclose(alike.points, SPAR.mesh().points, atol=1e-12)


@pytest.mark.parametrize("value", [(1.0, 1.0), (1.0, 1.0, 1.0, 0.0), 2.0, (1.0, "1", 1.0, 1.0)])
def test_walls_that_cannot_be_built_are_refused_in_one_sentence(value):
    with pytest.raises(InputError, match=r"^wall_lengths = .*mm: must be n_cells \+ 1 = 4 finite"):
        dataclasses.replace(SPAR, wall_lengths=value)


def test_upper_and_lower_rows_are_mirror_images():
    mesh = SPAR.mesh()
    upper, lower = (mesh.facet_points(row).reshape(-1, 3)
                    for row in ("upper_chambers", "lower_chambers"))
    assert upper[:, 1].min() == pytest.approx(1.4) and lower[:, 1].max() == pytest.approx(-1.4)
    sets = [{tuple(p) for p in np.round(points * [1, sign, 1], 9) + 0.0}
            for points, sign in ((upper, 1), (lower, -1))]
    assert sets[0] == sets[1]


def test_graded_meshes_are_finest_at_the_chambers_corners():
    parts = SparMeshing.graded(1)
    for fractions in (parts.cavity_length, parts.cavity_height):
        lengths = np.diff(fractions)
        assert lengths[0] == pytest.approx(lengths[-1])
        assert lengths[0] < 0.5 * lengths.max()
    assert np.argmin(np.diff(parts.cavity_width)) == len(parts.cavity_width) - 2


@pytest.mark.parametrize("name", [f.name for f in dataclasses.fields(SparGeometry)[:-2]])
@pytest.mark.parametrize("value", [0.0, -2.0, float("nan"), float("inf"), "2 mm", None])
def test_lengths_that_cannot_be_built_are_refused_in_one_sentence(name, value):
    with pytest.raises(InputError, match=rf"^{name} = .*mm: must be [^.]*0 mm$"):
        dataclasses.replace(SPAR, **{name: value})


@pytest.mark.parametrize("value", [0, -1, 2.5, "3", None])
def test_numbers_of_cells_that_cannot_be_built_are_refused_in_one_sentence(value):
    with pytest.raises(InputError, match=r"^n_cells = .*: must be a whole number of at least 1$"):
        dataclasses.replace(SPAR, n_cells=value)


@pytest.mark.quick
def test_split_meshing_has_the_breakpoints_of_the_whole_one_and_their_middles():
    plain = SparMeshing.plain()
    halves = plain.split(2)
    np.testing.assert_allclose(halves.cavity_width[::2], plain.cavity_width)
    np.testing.assert_allclose(
        halves.cavity_width[1::2], 0.5 * (plain.cavity_width[:-1] + plain.cavity_width[1:]))


@pytest.mark.quick
@pytest.mark.parametrize("half", [True, False])
def test_each_chamber_has_the_facets_around_it(half):
    geometry = SparGeometry.validation(3)
    grid = geometry.mesh(SparMeshing.plain(), half)
    chamber = geometry.chamber_of(grid.beyond("upper_chambers")[:, 2])
    assert np.bincount(chamber).tolist() == [len(chamber) // 3] * 3
    for i in range(3):
        corners = grid.facet_points("upper_chambers")[chamber == i].reshape(-1, 3)
        start = geometry.wall_length + i * (geometry.wall_length + geometry.cavity_length)
        assert corners[:, 2].min() == pytest.approx(start)
        assert corners[:, 2].max() == pytest.approx(start + geometry.cavity_length)
