"""The wing's mesh: counts, volumes, faces, positive cells; bad input."""

from dataclasses import replace

import numpy as np
import pytest
from scipy.integrate import quad

from morphing_wing.errors import InputError
from morphing_wing.geometry.wing import WingGeometry
from morphing_wing.geometry.wing_mesh import WingMeshing, wing_mesh
from tests.geometry import hexahedra

pytestmark = pytest.mark.quick

SMALL = WingGeometry.prototype(n_cells=2)
NO_SKIN = WingGeometry.prototype(n_cells=2, skin_thickness=None)
MANY = WingMeshing.of(nose=20, cavity_width=40, side_thickness=4, pocket=60, tail=20)
MESHINGS = pytest.mark.parametrize(
    "meshing", [WingMeshing.coarse(), WingMeshing.graded(), WingMeshing.fine()])
GEOMETRIES = pytest.mark.parametrize("wing", [
    SMALL, NO_SKIN, WingGeometry.prototype(n_cells=2, aerofoil="2412"),
    WingGeometry.prototype(n_cells=1, skin_thickness=0.5),
    WingGeometry.prototype(n_cells=1, spar_fraction=0.4, nose_length=8.0),
    WingGeometry.prototype(n_cells=1, aerofoil="2412", tip_wall=True),
    WingGeometry.prototype(n_cells=1, skin_over_spar=True, tip_wall=True),
    WingGeometry.prototype(n_cells=1, skin_slit="lower"),
    WingGeometry.prototype(n_cells=1, aerofoil="2412", skin_slit="trailing_edge")])


def area(section, height, start, end):
    """Area in mm^2 between the mean line and a height on both sides of it."""
    return 2.0 * quad(lambda x: float(height(section, x)), start, end, limit=200)[0]


def test_prototype_has_2232_cells_of_spar_and_740_of_skin():
    mesh = wing_mesh(WingGeometry.prototype(), WingMeshing.coarse())
    assert {name: len(cells) for name, cells in mesh.regions.items()} == {
        "spar": 2232, "skin": 740}
    bare = wing_mesh(WingGeometry.prototype(skin_thickness=None), WingMeshing.coarse())
    assert {name: len(cells) for name, cells in bare.regions.items() if len(cells)} == {
        "spar": 2232}


@MESHINGS
@GEOMETRIES
def test_no_cell_is_inside_out(wing, meshing):
    jacobians = hexahedra.corner_jacobians(wing_mesh(wing, meshing))
    # Cells may end in the edge where the skin's two sides meet, but must have volume.
    assert jacobians.min() >= 0.0
    assert hexahedra.jacobians(wing_mesh(wing, meshing)).min() > 0.0


@GEOMETRIES
def test_named_faces_lie_once_on_the_boundary(wing):
    mesh = wing_mesh(wing, WingMeshing.coarse())
    named = hexahedra.pairs(mesh, *mesh.facets)
    assert len(named) == len(set(named))
    assert set(named) <= hexahedra.boundary(mesh)


def test_unnamed_boundary_is_the_outer_contour_and_the_skins_open_end():
    mesh = wing_mesh(SMALL, WingMeshing.coarse())
    bare = np.array(sorted(hexahedra.boundary(mesh) - set(hexahedra.pairs(mesh, *mesh.facets))))
    mesh.facets["bare"] = bare
    points, span = mesh.facet_points("bare"), SMALL.span
    at_tip = (points[..., 2] > span - 1e-9).all(axis=1)
    assert (points[at_tip][..., 0] > SMALL.spar_end - 1e-9).all()
    x, y, _ = np.moveaxis(points[~at_tip], -1, 0)
    behind = x > SMALL.nose_length - 1e-9
    np.testing.assert_allclose(
        np.abs(y[behind]), SMALL.section.half_thickness(x[behind]), atol=1e-9)
    # The whole surface is closed: its area vectors add up to nothing.
    total = sum(hexahedra.area_vectors(mesh, name).sum(axis=0) for name in mesh.facets)
    np.testing.assert_allclose(total, 0.0, atol=1e-9)


@pytest.mark.parametrize("wing", [SMALL, NO_SKIN, replace(SMALL, skin_over_spar=True)])
def test_chambers_are_closed_and_hold_what_the_aerofoil_leaves(wing):
    mesh = wing_mesh(wing, MANY)

    def height(section, x):
        skin = wing.skin_thickness if wing.skin_over_spar else 0.0
        wall = wing.top_thickness + skin
        return section.half_thickness(x) - wall - wing.middle_thickness / 2

    expected = area(wing.section, height, wing.nose_length, wing.cavity_end) / 2
    for row in ("upper_chambers", "lower_chambers"):
        vectors = hexahedra.area_vectors(mesh, row)
        np.testing.assert_allclose(vectors.sum(axis=0), 0.0, atol=1e-9)
        volume = expected * wing.cavity_length * wing.n_cells
        assert hexahedra.enclosed(mesh, row) == pytest.approx(volume, rel=5e-4)


def test_solid_and_chambers_fill_the_aerofoil_up_to_the_spars_end():
    parts = WingMeshing.of(nose=2, cavity_width=40, side_thickness=4, cavity_height=20,
                           top_thickness=20, skin_thickness=10)
    mesh, section = wing_mesh(NO_SKIN, parts), NO_SKIN.section
    chambers = sum(hexahedra.enclosed(mesh, row) for row in ("upper_chambers", "lower_chambers"))
    # Between a tenth of its length and its rear edge the nose's contour is straight.
    blunt, rear = 0.5, NO_SKIN.nose_length
    contour = sum(area(section, lambda s, x: s.half_thickness(x), *ends)
                  for ends in ((0.0, blunt), (rear, NO_SKIN.spar_end)))
    contour += (rear - blunt) * section.half_thickness(np.array([blunt, rear])).sum()
    volume = hexahedra.volume(mesh, "spar") + chambers
    assert volume == pytest.approx(contour * NO_SKIN.span, rel=2e-4)


def test_skin_has_its_thickness_around_the_pocket_and_fills_the_tail():
    mesh, section = wing_mesh(SMALL, MANY), SMALL.section
    outside = area(section, lambda s, x: s.half_thickness(x), SMALL.spar_end, SMALL.chord)
    pocket = area(section, lambda s, x: s.half_thickness(x) - 1.0,
                  SMALL.spar_end, SMALL.pocket_end)
    assert hexahedra.volume(mesh, "skin") == pytest.approx(
        (outside - pocket) * SMALL.span, rel=1e-3)
    upper = mesh.facet_points("pocket_upper").reshape(-1, 3)
    np.testing.assert_allclose(
        upper[:, 1], np.maximum(section.half_thickness(upper[:, 0]) - 1.0, 0.0), atol=1e-9)


def test_the_two_sides_of_the_skin_are_one_body_behind_the_pocket():
    mesh = wing_mesh(SMALL, WingMeshing.coarse())
    assert len(np.unique(np.round(mesh.points, 6), axis=0)) == len(mesh.points)
    edge = mesh.facet_points("trailing_edge").reshape(-1, 3)
    assert edge[:, 0] == pytest.approx(np.full(len(edge), 150.0))
    middle = np.flatnonzero((np.abs(mesh.points[:, 1]) < 1e-9) & (mesh.points[:, 0] > 144.5))
    above = set(mesh.cells[mesh.points[mesh.cells].mean(axis=1)[:, 1] > 0].ravel())
    below = set(mesh.cells[mesh.points[mesh.cells].mean(axis=1)[:, 1] < 0].ravel())
    assert len(middle) and set(middle) <= above & below


def test_faces_have_the_places_of_the_drawing():
    mesh = wing_mesh(SMALL, WingMeshing.coarse())
    assert np.ptp(mesh.facet_points("root")[..., 2]) == 0.0
    assert mesh.facet_points("tip")[..., 2] == pytest.approx(SMALL.span)
    assert mesh.facet_points("tip")[..., 0].max() == pytest.approx(SMALL.spar_end)
    wall = mesh.facet_points("rear_wall")
    assert wall[..., 0] == pytest.approx(SMALL.spar_end)
    inside = float(SMALL.section.half_thickness(SMALL.spar_end)) - 1.0
    assert wall[..., 1].max() == pytest.approx(inside) == -wall[..., 1].min()


def test_free_root_edge_of_the_skin_is_bare_and_the_spars_is_not():
    meshes = [wing_mesh(replace(SMALL, skin_root=how), WingMeshing.coarse())
              for how in ("clamped", "free")]
    clamped, free = (hexahedra.pairs(mesh, "root") for mesh in meshes)
    skin, spar = (set(meshes[0].regions[name]) for name in ("skin", "spar"))
    assert {cell for cell, _ in set(clamped) - set(free)} <= skin
    assert {cell for cell, _ in free} == spar & {cell for cell, _ in clamped}


def test_tip_wall_fills_the_pocket_up_to_where_it_is_as_high_as_the_skin_is_thick():
    wing = replace(SMALL, tip_wall=True)
    mesh = wing_mesh(wing, MANY)
    pocket = area(wing.section, lambda s, x: s.half_thickness(x) - 1.0,
                  wing.spar_end, wing.tip_wall_end)
    assert hexahedra.volume(mesh, "tip_wall") == pytest.approx(
        pocket * wing.wall_length, rel=1e-3)
    assert wing.section.half_thickness(wing.tip_wall_end) - 1.0 == pytest.approx(0.5)
    assert hexahedra.volume(mesh, "skin") == pytest.approx(
        hexahedra.volume(wing_mesh(SMALL, MANY), "skin"), rel=1e-3)


def test_faces_of_the_pocket_end_at_the_tip_wall_and_the_tip_stays_the_spars():
    mesh = wing_mesh(replace(SMALL, tip_wall=True), WingMeshing.coarse())
    for name in ("pocket_upper", "pocket_lower", "rear_wall"):
        assert mesh.facet_points(name)[..., 2].max() == pytest.approx(
            SMALL.span - SMALL.wall_length)
    assert mesh.facet_points("rear_wall")[..., 0] == pytest.approx(SMALL.spar_end)
    assert mesh.facet_points("tip")[..., 0].max() == pytest.approx(SMALL.spar_end)
    assert len(np.unique(np.round(mesh.points, 6), axis=0)) == len(mesh.points)


def bare_facets(mesh):
    """Corners of facets that are boundary but not of the mesh without a slit."""
    whole = wing_mesh(SMALL, WingMeshing.coarse())
    mesh.facets["new"] = np.array(sorted(hexahedra.boundary(mesh) - hexahedra.boundary(whole)))
    return mesh.facet_points("new")


def test_slit_trailing_edge_parts_the_two_sides_behind_the_pocket_and_nothing_else():
    mesh = wing_mesh(replace(SMALL, skin_slit="trailing_edge"), WingMeshing.coarse())
    x, y, z = np.moveaxis(bare_facets(mesh), -1, 0)
    assert x.min() == pytest.approx(SMALL.pocket_end) and x.max() == pytest.approx(SMALL.chord)
    np.testing.assert_allclose(y, 0.0, atol=1e-12)
    assert hexahedra.area(mesh, "new") == pytest.approx(
        2.0 * (SMALL.chord - SMALL.pocket_end) * SMALL.span)


def test_slit_lower_skin_is_parted_from_the_spar_and_nothing_else():
    mesh = wing_mesh(replace(SMALL, skin_slit="lower"), WingMeshing.coarse())
    x, y, z = np.moveaxis(bare_facets(mesh), -1, 0)
    np.testing.assert_allclose(x, SMALL.spar_end)
    outside = -float(SMALL.section.half_thickness(SMALL.spar_end))
    assert y.min() == pytest.approx(outside) and y.max() == pytest.approx(outside + 1.0)
    assert hexahedra.area(mesh, "new") == pytest.approx(2.0 * SMALL.span)


def test_slit_of_the_lower_skin_ends_at_the_tip_wall():
    mesh = wing_mesh(replace(SMALL, skin_slit="lower", tip_wall=True), WingMeshing.coarse())
    points, count = np.unique(np.round(mesh.points, 6), axis=0, return_counts=True)
    doubled = points[count == 2]
    assert len(doubled) == 2 * 4  # at the skin's two sides, where the first four pieces begin
    np.testing.assert_allclose(doubled[:, 0], SMALL.spar_end)
    assert doubled[:, 2].min() == 0.0
    assert doubled[:, 2].max() == pytest.approx(
        SMALL.span - SMALL.wall_length - SMALL.cavity_length)


@pytest.mark.parametrize("changes, name", [
    ({"chord": -150.0}, "chord"),
    ({"cavity_length": 0.0}, "cavity_length"),
    ({"wall_length": float("nan")}, "wall_length"),
    ({"top_thickness": 8.0}, "top_thickness"),
    ({"nose_length": 74.0}, "nose_length"),
    ({"spar_fraction": 1.5}, "spar_fraction"),
    ({"n_cells": 0}, "n_cells"),
    ({"n_cells": 2.5}, "n_cells"),
    ({"skin_thickness": -1.0}, "skin_thickness"),
    ({"skin_thickness": 2.0}, "skin_thickness"),
    ({"skin_thickness": "1 mm"}, "skin_thickness"),
    ({"skin_root": "glued"}, "skin_root"),
    ({"skin_root": "free", "skin_thickness": None}, "skin_root"),
    ({"skin_over_spar": True, "skin_thickness": None}, "skin_over_spar"),
    ({"skin_over_spar": True, "top_thickness": 4.0}, "top_thickness"),
    ({"skin_over_spar": True, "skin_thickness": "1 mm"}, "skin_thickness"),
    ({"skin_slit": "upper"}, "skin_slit"),
    ({"skin_slit": "lower", "skin_thickness": None}, "skin_slit"),
    ({"skin_prestretch": (1.1,)}, "skin_prestretch"),
    ({"skin_prestretch": 1.1}, "skin_prestretch"),
    ({"skin_prestretch": (1.0, 0.9)}, "skin_prestretch"),
    ({"skin_prestretch": (1.1, 1.0), "skin_thickness": None}, "skin_prestretch"),
    ({"tip_wall": 1}, "tip_wall"),
    ({"tip_wall": True, "skin_thickness": None}, "tip_wall"),
    ({"tip_wall": True, "skin_thickness": 2.7, "top_thickness": 2.8, "spar_fraction": 0.8,
      "rib": None}, "skin_thickness"),
    ({"glue_stiffness": 0.0}, "glue_stiffness"),
    ({"foot_height": -1.0}, "foot_height"),
    ({"rib_positions": ()}, "rib_positions"),
    ({"rib_positions": (0.5, 1.2)}, "rib_positions"),
    ({"cable_guide": (0.0, 0.0, 0.0)}, "cable_guide"),
    ({"chord": 120.0}, r"rib\.n_cells"),
])
def test_what_cannot_be_built_is_refused_in_one_sentence(changes, name):
    with pytest.raises(InputError, match=rf"^{name} = [^\n]*: must be [^\n]+[^.]$"):
        WingGeometry.prototype(**changes)


def test_chambers_taller_than_the_aerofoil_are_called_so():
    with pytest.raises(InputError, match="taller than the aerofoil"):
        WingGeometry.prototype(top_thickness=5.0)
