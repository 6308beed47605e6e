"""The rib's solid: volume, faces, what collides, meshes that do not fold."""

from dataclasses import replace

import numpy as np
import pytest

from morphing_wing.errors import InputError
from morphing_wing.geometry.rib import RibGeometry
from morphing_wing.geometry.rib_solid import rib_solid
from morphing_wing.geometry.tetmesh import FACET_VERTICES, joined

SETS = {
    "3.3 square": RibGeometry.validation("square"),
    "3.3 square, bosses": RibGeometry.validation("square", bosses=True),
    "3.3 flush": RibGeometry.validation("flush"),
    "5.1 square": RibGeometry.prototype(6, "square"),
    "5.1 square, bosses": RibGeometry.prototype(6, "square", bosses=True),
    "5.1 flush": RibGeometry.prototype(6, "flush"),
}
WITHOUT_BOSSES = {"3.3 square", "5.1 square"}


def facet_areas(mesh, face):
    """Areas of a flat face's facets, mm^2."""
    pairs = mesh.facets[face]
    corners = mesh.points[mesh.cells[pairs[:, :1], FACET_VERTICES[pairs[:, 1]]]]
    across = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    return 0.5 * np.linalg.norm(across, axis=1)


@pytest.mark.quick
@pytest.mark.parametrize("name", SETS)
def test_no_cell_folds_and_the_ends_are_the_bars_sections(name):
    rib = replace(SETS[name], n_cells=2)
    mesh = rib_solid(rib, 6)
    assert mesh.smallest_jacobian().min() > 0.05
    inclined = np.cos(np.radians(rib.crossing_angle / 2.0))
    section = rib.shaft_width * rib.shaft_thickness / inclined
    for face in ("root", "tail"):  # of the middle bar a half, of one outer bar all
        assert facet_areas(mesh, face).sum() == pytest.approx(1.5 * section, rel=0.01)


@pytest.mark.quick
def test_volume_of_a_rib_without_bosses_is_that_of_its_bars_and_pivots():
    rib = replace(SETS["3.3 square"], n_cells=2)
    width, depth, R = rib.shaft_width, rib.shaft_thickness, 0.5 * rib.pivot_diameter
    # Six bars; of either end of each one is cut off, the other one round; two pivots at each of T,
    # B and two C.
    bars = 6 * (rib.shaft_length * width + 0.5 * np.pi * (0.5 * width) ** 2) * depth
    pivots = 8 * np.pi * R**2 * rib.pivot_length
    assert rib_solid(rib, 10, half=False).volume() == pytest.approx(bars + pivots, rel=2e-3)


@pytest.mark.quick
def test_a_half_has_half_the_volume_and_its_symmetry_plane_is_the_middle_bars_section():
    rib = replace(SETS["5.1 flush"], n_cells=2)
    half = rib_solid(rib, 8)
    assert 2.0 * half.volume() == pytest.approx(rib_solid(rib, 8, half=False).volume(), rel=2e-3)
    assert half.points[:, 2].min() > -1e-9
    # Two stadiums of which the plane cuts off one end each.
    width, length = rib.shaft_width, rib.shaft_length
    plan = 2.0 * (length * width + 0.5 * np.pi * (0.5 * width) ** 2)
    assert facet_areas(half, "symmetry").sum() == pytest.approx(plan, rel=0.02)


@pytest.mark.quick
def test_curved_cells_have_the_round_pivots_volume_where_straight_ones_lose_it():
    mesh = rib_solid(replace(SETS["5.1 square, bosses"], n_cells=1), 8)
    straight = np.linalg.det(np.diff(mesh.points[mesh.cells[:, :4]], axis=1)).sum() / 6.0
    fine = rib_solid(replace(SETS["5.1 square, bosses"], n_cells=1), 20).volume()
    assert mesh.volume() == pytest.approx(fine, rel=1e-3)
    assert abs(straight) < 0.99 * fine


@pytest.mark.parametrize("angle", [40.0, 70.0, 100.0, 130.0])
@pytest.mark.parametrize("name", SETS)
def test_any_crossing_angle_is_meshed_or_refused_with_what_collides(name, angle):
    try:
        rib = replace(SETS[name], crossing_angle=angle, n_cells=2)
        mesh = rib_solid(rib, 6)
    except InputError as refused:
        text = str(refused)
        assert "neighbouring" in text
        assert "mm" in text
        assert angle in (40.0, 130.0)
    else:
        assert mesh.smallest_jacobian().min() > 0.05


@pytest.mark.parametrize("shaft_length", [8.5, 6.5, 4.5])
@pytest.mark.parametrize("thickness", [1.0, 1.5, 2.0])
def test_bars_and_lengths_of_table_3_are_meshed_in_both_readings(thickness, shaft_length):
    # 1.5 mm square bars are as wide as the cylinders, 2 mm ones wider.
    for section, bosses, angle in (("flush", False, 80.0), ("square", True, 90.0),
                                   ("square", False, 100.0)):
        rib = RibGeometry(shaft_length, thickness, 1.5, 5.0, angle, 2, section, bosses)
        assert rib_solid(rib, 6).smallest_jacobian().min() > 0.05


def test_a_rib_of_24_cells_is_one_body_as_long_as_it_should_be():
    rib = replace(SETS["5.1 square, bosses"], n_cells=24)
    mesh = rib_solid(rib, 6)
    assert mesh.points[:, 0].max() == pytest.approx(rib.length, abs=1e-9)
    two, six = (rib_solid(replace(rib, n_cells=n), 6).volume() for n in (2, 6))
    assert mesh.volume() == pytest.approx(six + 18 / 4 * (six - two), rel=0.01)


@pytest.mark.quick
def test_copies_have_their_own_cells_and_faces():
    mesh = rib_solid(replace(SETS["5.1 square"], n_cells=1), 6, half=False)
    both = joined(mesh, np.array([[0.0, 0.0, 0.0], [1.0, 2.0, 30.0]]))
    assert both.volume() == pytest.approx(2.0 * mesh.volume())
    second = both.points[both.cells[both.facets["root_1"][:, 0]]]
    assert second[..., 0].min() == pytest.approx(1.0, abs=1e-9)
    assert second[..., 2].min() > 15.0
