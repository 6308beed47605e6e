import xml.etree.ElementTree as ElementTree

import numpy as np
import pytest
import pyvista
from fake_scenes import FakeScene, bent, box, line, spar_path, turned
from scipy.spatial.transform import Rotation

from morphing_wing.fields import FieldGrid, save_path
from morphing_wing.path import Path, State

TYPES = {1: pyvista.CellType.HEXAHEDRON, 2: pyvista.CellType.LAGRANGE_HEXAHEDRON}


def motion(x):
    """Return a motion that is quadratic, so that second-order nodes matter."""
    return np.stack([0.1 * x[0] ** 2 + x[1], 0.2 * x[0] * x[2], x[2] - 0.3 * x[1] ** 2])


@pytest.mark.parametrize("degree", [1, 2])
def test_hexahedra_keep_their_order_and_every_point_its_value(degree):
    u = box(degree=degree)
    u.interpolate(motion)
    grid = FieldGrid(u).grid()
    assert set(grid.celltypes) == {TYPES[degree]}
    assert grid.n_cells == 2 * 3 * 4
    assert grid.n_points == (2 * degree + 1) * (3 * degree + 1) * (4 * degree + 1)  # none twice
    np.testing.assert_allclose(grid.point_data["displacement"], motion(grid.points.T).T, atol=1e-13)


@pytest.mark.parametrize("degree", [1, 2])
def test_nodes_stand_where_vtk_expects_them(degree):
    grid = FieldGrid(box(degree=degree)).grid()
    for number in (0, 7):
        cell = grid.GetCell(number)
        at = np.array(cell.GetParametricCoords()).reshape(-1, 3)[: cell.GetNumberOfPoints()]
        points = grid.get_cell(number).points
        low, size = points.min(axis=0), np.ptp(points, axis=0)
        np.testing.assert_allclose(points, low + at * size, atol=1e-12)


def test_lines_keep_their_order_and_rotations_stand_apart():
    f = line(rotations=True)
    f.interpolate(turned(motion))
    grid = FieldGrid(f).grid()
    assert set(grid.celltypes) == {pyvista.CellType.LAGRANGE_CURVE}
    assert grid.n_points == 9
    np.testing.assert_allclose(grid.point_data["displacement"], motion(grid.points.T).T, atol=1e-12)
    assert (grid.point_data["rotation"] == 1e6).all()


def test_mixed_displacement_and_pressure_give_the_displacement():
    import dolfinx

    from morphing_wing import compat

    mesh = box().function_space.mesh
    w = dolfinx.fem.Function(compat.displacement_pressure_space(mesh, 2, ("DG", 0)))
    w.sub(0).interpolate(motion)
    grid = FieldGrid(w).grid()
    assert set(grid.celltypes) == {TYPES[2]}
    np.testing.assert_allclose(grid.point_data["displacement"], motion(grid.points.T).T, atol=1e-12)


@pytest.mark.parametrize("degree", [1, 2])
def test_stretch_of_a_rotated_uniaxial_stretch_is_the_stretch(degree):
    u = box(degree=degree)
    turn = np.array([[0.8, -0.6, 0.0], [0.6, 0.8, 0.0], [0.0, 0.0, 1.0]])
    F = turn @ np.diag([1.3**-0.5, 1.3, 1.3**-0.5])
    u.interpolate(lambda x: (F - np.eye(3)) @ x)
    np.testing.assert_allclose(FieldGrid(u).grid().point_data["stretch"], 1.3, rtol=1e-12)


def test_second_stretch_is_the_one_between_the_others():
    u = box(cells=(1, 1, 1))
    turn = Rotation.from_rotvec([0.4, -0.7, 0.3]).as_matrix()
    u.interpolate(lambda x: turn @ (np.diag([1.2, 0.7, 1.5]) @ x) - x)
    grid = FieldGrid(u).grid()
    np.testing.assert_allclose(grid.point_data["stretch"], 1.5, rtol=1e-12)
    np.testing.assert_allclose(grid.point_data["second_stretch"], 1.2, rtol=1e-12)


def test_stretch_of_a_line_is_that_of_its_axis():
    f = line()
    f.interpolate(lambda x: np.stack([0.6 * 1.25 * x[0] - x[0], 0.8 * 1.25 * x[0], 0 * x[0]]))
    np.testing.assert_allclose(FieldGrid(f).grid().point_data["stretch"], 1.25, rtol=1e-12)


def test_stretch_of_pure_bending_grows_with_the_height():
    u = box(size=(1.0, 1.0, 10.0), cells=(1, 1, 40))
    u.interpolate(lambda x: bent(x, 0.5, 10.0))
    grid = FieldGrid(u).grid()
    exact = np.maximum(1.0 + grid.points[:, 1] * 0.5 / 10.0, 1.0)
    np.testing.assert_allclose(grid.point_data["stretch"], exact, atol=1e-4)


def test_stretch_converges_at_second_order_at_least():
    def error(n):
        u = box(size=(1.0, 1.0, 4.0), cells=(1, 1, n))
        u.interpolate(lambda x: bent(x, 1.0, 4.0))
        grid = FieldGrid(u).grid()
        exact = np.maximum(1.0 + grid.points[:, 1] / 4.0, 1.0)
        return np.abs(grid.point_data["stretch"] - exact).max()

    assert np.log2(error(8) / error(16)) > 1.9


def test_files_read_back_with_cells_points_values_and_loads(tmp_path):
    path = spar_path(n_cells=2)
    save_path(path, tmp_path)
    written = FieldGrid(path.scene.functions["elastomer"])
    for step, state in enumerate(path):
        read = pyvista.read(tmp_path / f"elastomer_{step:04d}.vtu")
        path.scene.show(state)
        grid = written.grid()
        assert set(read.celltypes) == {TYPES[2]}
        np.testing.assert_array_equal(read.cells, grid.cells)
        np.testing.assert_array_equal(read.points, grid.points)
        for name in ("displacement", "stretch"):
            np.testing.assert_array_equal(read.point_data[name], grid.point_data[name])
        assert read.field_data["upper_MPa"][0] == state.load["upper_MPa"]


def test_series_lists_every_step_and_function_and_pyvista_opens_it(tmp_path):
    u, f = box(), line()
    scene = FakeScene("wing", {"elastomer": u, "ribs": f},
                      {"elastomer": lambda x, p: p * motion(x), "ribs": lambda x, p: p * motion(x)})
    states = [State({"upper_MPa": p}, {}, 3, 0, 0, 0, 0.1, True, scene.fields(p))
              for p in (0, 1, 2)]
    save_path(Path(states, scene, True, "", 1.0), tmp_path)
    reader = pyvista.get_reader(tmp_path / "path.pvd")
    assert reader.time_values == [0.0, 1.0, 2.0]
    reader.set_active_time_value(2.0)
    solid, bars = reader.read()
    assert (solid.n_cells, bars.n_cells) == (24, 4)
    np.testing.assert_allclose(
        bars.point_data["displacement"], 2 * motion(bars.points.T).T, atol=1e-12)
    root = ElementTree.parse(tmp_path / "path.pvd").getroot()
    assert all((tmp_path / e.get("file")).exists() for e in root.iter("DataSet"))


def test_a_shorter_path_leaves_no_states_of_a_longer_one(tmp_path):
    path = spar_path(n_cells=1)
    save_path(path, tmp_path)
    save_path(path[:2], tmp_path)
    assert sorted(f.name for f in tmp_path.glob("*.vtu")) == [
        "elastomer_0000.vtu", "elastomer_0001.vtu"]
