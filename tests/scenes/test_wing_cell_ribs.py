"""Wings whose ribs are chains of condensed cells: as those with solid ones."""

from dataclasses import replace

import numpy as np
import pytest
from mpi4py import MPI

from morphing_wing.bar_mesh import BarMesh
from morphing_wing.errors import InputError
from morphing_wing.surface import Bars
from morphing_wing.weight import Weight
from tests.scenes.small_wing import GEOMETRY, small_wing

pytestmark = pytest.mark.quick

SHORT = replace(GEOMETRY, rib=replace(GEOMETRY.rib, n_cells=3))
BARE = replace(SHORT, skin_thickness=None)


def wing(model, geometry=BARE, around=6):
    around = None if model == "frame" else around
    return small_wing(MPI.COMM_SELF, geometry=geometry, rib_model=model, around=around)


def test_cables_and_pressure_turn_a_wing_with_cell_ribs_as_one_with_solids():
    cell, solid = (wing(model).actuate(upper=0.01, cable=0.2)[-1] for model in ("cell", "solid"))
    for name, value in solid.measures.items():
        if name.endswith("_deg"):
            assert cell.measures[name] == pytest.approx(value, rel=0.02), name
    assert cell.energy_Nmm == pytest.approx(cell.external_work_Nmm, rel=1e-3)
    assert cell.negative_pivots == 0


def test_it_weighs_as_a_frame():
    falls = []
    for model in ("cell", "frame"):
        scene = wing(model)
        scene.ribs.function.x.array.reshape(-1, 6)[:, 1] = 2.0
        falls.append(Weight(scene.body, scene.ribs).fall())
        assert isinstance(scene.ribs, BarMesh)
    assert falls[0] == pytest.approx(falls[1], rel=1e-9)


def test_it_touches_as_far_from_its_axis_as_its_joints_reach():
    bars, rib = Bars(wing("cell", SHORT).ribs), SHORT.rib
    root = SHORT.rib_roots()[0]
    assert np.allclose(bars.nodes.reference[:, 1:], root[1:])
    assert bars.nodes.reference[:, 0].max() == pytest.approx(root[0] + rib.length)
    assert bars.radius == pytest.approx(0.5 * (rib.height + rib.pivot_diameter))
    assert bars.area.sum() == pytest.approx(rib.length * (rib.height + rib.pivot_diameter))


@pytest.mark.parametrize("options, sentence", [
    ({"rib_model": "truss"}, "rib_model = 'truss': must be one of frame, cell, solid"),
    ({"rib_model": "frame", "around": 6}, "around = 6: must be a whole number of at least 4, with "
     'rib_model "cell" or "solid"'),
    ({"rib_model": "cell", "around": 3}, "around = 3: must be a whole number of at least 4"),
    ({"rib_model": "cell", "geometry": replace(BARE, rib=replace(BARE.rib, layers=2))},
     "layers = 2: must be 3 for a rib as a solid"),
])
def test_what_cannot_be_condensed_is_refused(options, sentence):
    with pytest.raises(InputError) as refused:
        small_wing(MPI.COMM_SELF, **{"geometry": BARE} | options)
    assert str(refused.value).startswith(sentence)
