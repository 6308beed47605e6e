"""Wings with solid ribs: as those with frames, but for what a frame leaves out."""

from dataclasses import replace

import numpy as np
import pytest
from mpi4py import MPI

from morphing_wing.surface import Crests
from morphing_wing.weight import Weight
from tests.scenes.small_wing import GEOMETRY, small_wing

SHORT = replace(GEOMETRY, rib=replace(GEOMETRY.rib, n_cells=3))
BARE = replace(SHORT, skin_thickness=None)


def wing(model, geometry=BARE):
    return small_wing(MPI.COMM_SELF, geometry=geometry, rib_model=model)


def test_cables_and_pressure_turn_a_wing_with_solid_ribs_as_one_with_frames():
    solid, frame = (wing(model).actuate(upper=0.01, cable=0.2)[-1]
                    for model in ("solid", "frame"))
    assert solid.measures["span_angle_deg"] == pytest.approx(
        frame.measures["span_angle_deg"], rel=0.02)
    assert solid.measures["rib_1_rotation_deg"] == pytest.approx(
        frame.measures["rib_1_rotation_deg"], rel=0.05)
    assert solid.energy_Nmm == pytest.approx(solid.external_work_Nmm, rel=1e-3)
    assert solid.negative_pivots == 0


def test_a_ribs_weight_is_that_of_its_volume():
    scene = wing("solid")
    moved = scene.ribs.function.x.array.reshape(-1, 3)
    moved[:, 1] = 2.0
    weight = 1180.0e-9 * 9.80665 * scene.ribs.body.grid.volume()
    assert Weight(scene.body, scene.ribs).fall() == pytest.approx(-2.0 * weight, rel=1e-6)


def test_crests_are_the_pivots_above_and_below_all_joints():
    crests, rib = Crests(wing("solid").ribs.body), SHORT.rib
    away = np.abs(crests.nodes.reference[:, 1] - SHORT.rib_roots()[0, 1])
    assert (away > 0.5 * rib.height - 1e-9).all()
    assert away.max() == pytest.approx(0.5 * (rib.height + rib.pivot_diameter), abs=0.02)
    # Of two pivots above and two below; facets that are only partly beyond a joint are left out.
    seen = 4.0 * rib.pivot_diameter * rib.depth
    assert 0.8 * seen < crests.area.sum() < seen


def test_crests_of_a_solid_rib_are_as_far_from_the_skin_as_a_frames_bars():
    gaps = []
    for model in ("solid", "frame"):
        path = wing(model, SHORT).actuate(cable=[0.5, 1.0])
        assert path.converged, path.reason
        gaps.append([state.measures["gap_mm"] for state in path if state.requested])
    assert gaps[0] == pytest.approx(gaps[1], abs=0.3)
