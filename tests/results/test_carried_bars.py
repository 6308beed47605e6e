"""Bars that axes carry: as sections that do not deform move them."""

import numpy as np
import pytest
import pyvista
from mpi4py import MPI
from scipy.spatial.transform import Rotation

from morphing_wing.carried_bars import carried
from morphing_wing.fields import scene_grids
from morphing_wing.geometry.frame import join
from morphing_wing.geometry.rib import RibGeometry
from morphing_wing.geometry.rib_cell import link_frame
from morphing_wing.rib import Rib

RIB = RibGeometry.prototype(3)
ROOTS = [(5.0, 1.0, 20.0), (5.0, 1.0, 60.0)]


def both():
    """Return the axes of two ribs as a grid, and their bars."""
    axes, bars = (join([frame.placed(root) for root in ROOTS])
                  for frame in (link_frame(RIB), RIB.frame()))
    cells = np.insert(axes.bars, 0, 2, axis=1).ravel()
    types = np.full(len(axes.bars), pyvista.CellType.LINE)
    return pyvista.UnstructuredGrid(cells, types, axes.points), bars


def test_ribs_that_turn_as_rigid_bodies_keep_their_bars_in_place():
    axes, bars = both()
    turn, by = Rotation.from_rotvec([0.3, -0.5, 1.2]), np.array([3.0, -2.0, 1.0])
    axes.point_data["displacement"] = turn.apply(axes.points) + by - axes.points
    axes.point_data["rotation"] = np.tile(turn.as_rotvec(), (axes.n_points, 1))
    drawn = carried(axes, bars)
    np.testing.assert_allclose(
        drawn.points + drawn.point_data["displacement"], turn.apply(bars.points) + by, atol=1e-12)
    assert np.array_equal(drawn.cells.reshape(-1, 3)[:, 1:], bars.bars)


def test_a_mode_moves_bars_as_a_small_further_turn_does():
    axes, bars = both()
    turn, spin, rate = 1.2, 1e-6, np.array([0.0, 0.0, 1.0])
    axes.point_data["displacement"] = np.zeros((axes.n_points, 3))
    axes.point_data["rotation"] = turn * np.tile(rate, (axes.n_points, 1))
    axes.point_data["mode"] = np.zeros((axes.n_points, 3))
    axes.point_data["mode_rotation"] = np.tile(rate, (axes.n_points, 1))
    drawn = carried(axes, bars)
    before = drawn.point_data["displacement"].copy()
    axes.point_data["rotation"] += spin * axes.point_data["mode_rotation"]
    moved = (carried(axes, bars).point_data["displacement"] - before) / spin
    np.testing.assert_allclose(drawn.point_data["mode"], moved, atol=1e-5)
    assert np.linalg.norm(moved, axis=1).max() == pytest.approx(0.5 * RIB.height, rel=1e-3)


def test_a_cell_rib_is_drawn_by_all_its_bars_and_its_tail_where_the_axis_ends(monkeypatch):
    from morphing_wing import condensed_rib

    monkeypatch.setitem(condensed_rib.AROUND, "cell", 6)
    rib = Rib(RIB, fidelity="cell", comm=MPI.COMM_SELF)
    state = rib.bend(torque=5.0)[-1]
    drawing = rib.drawing(state)
    frame = drawing.bars["ribs"]
    assert len(frame.bars) == len(RIB.frame().bars) == len(drawing.radius["ribs"])
    drawn = carried(scene_grids(rib, state)["ribs"], frame)
    tail = drawn.point_data["displacement"][frame.tails[0]]
    np.testing.assert_allclose(tail, rib.ribs.end_values("tail", 0)[:3], rtol=1e-12)
    assert tail[1] < 0.0
