import matplotlib.image
import numpy as np
import pytest
from fake_scenes import FakeScene, box, line, spar_path, turned
from fake_wing import wing_path

from morphing_wing import pictures, renderer, views
from morphing_wing.drawing import Cut, Drawing, bar_radii
from morphing_wing.fields import FieldGrid, scene_grids
from morphing_wing.geometry.rib import RibGeometry
from morphing_wing.mirror import mirrored
from morphing_wing.path import Path, State
from morphing_wing.pictures import caption, render_strip
from morphing_wing.tubes import tubes
from morphing_wing.views import View

COLOURS = {"cmap": "viridis", "clim": (1.0, 1.2)}


@pytest.fixture(scope="module")
def spar():
    return spar_path(n_cells=3)


def drawn(picture):
    """Return which pixels are not white."""
    return (picture[..., :3] < 0.97 * picture.max()).any(axis=-1)


def test_picture_has_its_size_and_a_white_rim(spar, tmp_path):
    spar[-1].render(tmp_path / "shape.png")
    picture = matplotlib.image.imread(tmp_path / "shape.png")
    assert picture.shape[:2] == (1000, 1600)
    ink = drawn(picture)
    assert not ink[:, :5].any() and not ink[:, -5:].any()
    assert not ink[:5].any() and not ink[-5:].any()
    assert ink[150:850].mean() > 0.1


@pytest.mark.parametrize("cut", [None, Cut("x", 0.0), Cut("z", 8.0)])
def test_whole_object_is_in_the_frame_and_fills_it(spar, cut):
    view = View(scene_grids(spar.scene, spar[-1]), Drawing(mirror_x=0.0))
    low, high = view.extent(cut)
    scale = (high - low).max() / 280
    ink = drawn(view.image((300, 300), scale, COLOURS, cut))
    assert not ink[:6].any() and not ink[-6:].any()
    assert not ink[:, :6].any() and not ink[:, -6:].any()
    extent = max(np.ptp(axis) for axis in np.nonzero(ink))
    assert extent == pytest.approx(280, abs=6)


@pytest.mark.parametrize("axis, level, area", [
    # 3 + 3 chambers of 2.8 x 6 mm in 17.2 x 16.8 mm; 1 + 1 of 40 x 6 mm in 42.4 x 16.8 mm
    ("x", 7.0, 17.2 * 16.8 - 6 * 2.8 * 6.0), ("z", 3.0, 42.4 * 16.8 - 2 * 40.0 * 6.0)])
def test_cut_face_is_the_section_without_its_chambers(spar, axis, level, area):
    grids = scene_grids(spar.scene, spar[0])
    (whole,) = View(grids, Drawing(mirror_x=0.0)).solids
    surface = views._surface(views._without(whole, Cut(axis, level)), deformed=False, subdivision=0)
    faces = surface.compute_cell_sizes(length=False, volume=False)
    centres = faces.cell_centers().points[:, 0 if axis == "x" else 2]
    cut = np.abs(centres - level) < 0.02
    flat = np.abs(faces.compute_normals().cell_data["Normals"][:, 0 if axis == "x" else 2]) > 0.99
    assert faces.cell_data["Area"][cut & flat].sum() == pytest.approx(area, rel=1e-3)


def test_mirrored_half_is_a_whole_without_a_face_in_the_plane():
    u = box(size=(1.0, 2.0, 3.0))
    u.interpolate(lambda x: np.stack([0.1 * x[0], 0.2 * x[2], 0 * x[0]]))
    grid = FieldGrid(u).grid()
    whole = mirrored(grid, 0.0)
    assert whole.n_cells == 2 * grid.n_cells
    assert whole.n_points == (2 * 4 + 1) * 7 * 9
    np.testing.assert_allclose(
        whole.point_data["displacement"][:, 0], 0.1 * whole.points[:, 0], atol=1e-14)
    volumes = whole.linear_copy().compute_cell_sizes()["Volume"] if hasattr(
        whole, "linear_copy") else whole.linearized().compute_cell_sizes()["Volume"]
    np.testing.assert_allclose(volumes, 6.0 / 24, rtol=1e-12)  # positive: none inside out
    surface = whole.extract_surface(algorithm="dataset_surface")
    assert surface.area == pytest.approx(2 * (2 * 2 + 2 * 3 + 2 * 3))


def test_tubes_have_their_radius_about_the_deformed_axis():
    f = line()
    f.interpolate(lambda x: np.stack([0 * x[0], 5.0 + 0 * x[0], 0 * x[0]]))
    grid = FieldGrid(f).grid()
    bars = tubes(grid, np.array([0.5, 0.5, 0.5, 2.0]), deformed=True)
    distance = np.hypot(bars.points[:, 1] - 5.0, bars.points[:, 2])
    thick = bars.points[:, 0] > 9.0
    assert distance[bars.points[:, 0] < 5.0].max() == pytest.approx(0.5, rel=1e-5)
    assert distance[thick].max() == pytest.approx(2.0, rel=1e-5)
    np.testing.assert_allclose(bars.point_data["magnitude"], 5.0, rtol=1e-5)


@pytest.mark.parametrize("section, area", [("flush", 1.5 * 1.2), ("square", 1.2 * 1.2)])
def test_bars_are_as_thick_as_shafts_and_pivots_and_links_no_thicker(section, area):
    geometry = RibGeometry.validation(section=section)
    frame = geometry.frame()
    radius = bar_radii(frame)
    np.testing.assert_allclose(np.pi * radius[frame.of_kind("shaft")] ** 2, area)
    np.testing.assert_allclose(radius[frame.of_kind("pivot")], 0.5 * geometry.pivot_diameter)
    for link in ("arm", "socket", "root", "tail"):
        assert (radius[frame.of_kind(link)] == radius.min()).all()


def test_scene_of_lines_alone_is_coloured_by_displacement(tmp_path):
    f = line(rotations=True)
    scene = FakeScene("rib", {"ribs": f}, {}, "torque_Nmm")
    f.interpolate(turned(lambda x: np.stack([0 * x[0], -0.02 * x[0] ** 2, 0 * x[0]])))
    state = State({"torque_Nmm": 5.0}, {"chord_angle_deg": 9.0}, 4, 1, 1, 0, 0.1, True,
                  {"ribs": f.x.array.copy()})
    path = Path([state], scene, True, "", 1.0)
    path.render(tmp_path / "rib.png")
    assert drawn(matplotlib.image.imread(tmp_path / "rib.png"))[150:850].mean() > 0.005
    view = View(scene_grids(scene, state), Drawing())
    assert view.quantity == "displacement"
    assert view.values().max() == pytest.approx(2.0)


@pytest.mark.parametrize("degree", [1, 2])
def test_wing_with_ribs_cables_and_two_cuts_is_drawn(tmp_path, degree):
    path = wing_path((0.0, 0.02), degree=degree)
    path.render(tmp_path / "wing.png")
    ink = drawn(matplotlib.image.imread(tmp_path / "wing.png"))
    for part in (ink[150:880, :900], ink[150:490, 950:], ink[520:880, 950:]):
        assert part.mean() > 0.05


def test_strip_shows_states_of_one_path(spar, tmp_path):
    render_strip(spar, tmp_path / "strip.png", most=2)
    picture = matplotlib.image.imread(tmp_path / "strip.png")
    assert picture.shape[:2] == (1000, 1600)


def test_caption_names_loads_and_both_definitions_of_the_angle(spar):
    assert caption(spar[2]) == (
        r"20 kPa in the upper chambers:  $\varphi_1$ = 28.6° (deflection line 14.3°)")
    assert caption(spar[0]).startswith("no load")


def test_without_opengl_the_rest_is_saved_and_a_warning_says_what_to_install(
    spar, tmp_path, monkeypatch
):
    monkeypatch.setattr(renderer, "_works", lambda window: False)
    renderer.choose_renderer.cache_clear()
    try:
        with pytest.warns(UserWarning, match="apt install libegl1"):
            spar.save(tmp_path)
        with pytest.raises(pictures.NoRenderer):
            spar[-1].render(tmp_path / "shape.png")
    finally:
        renderer.choose_renderer.cache_clear()
    assert {f.name for f in tmp_path.iterdir()} == {
        "summary.json", "table.csv", "angles.png", "fields"}
