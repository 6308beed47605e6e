"""The map of reachable angles, run on a small wing."""

import json
from dataclasses import replace

import numpy as np
import pytest
from mpi4py import MPI

from morphing_wing.errors import InputError
from morphing_wing.reach import reach, snake
from tests.scenes.small_wing import GEOMETRY, MESHING, NO_SKIN

SMALL = {"geometry": replace(GEOMETRY, **NO_SKIN), "meshing": MESHING, "comm": MPI.COMM_SELF}


@pytest.mark.quick
def test_snake_changes_one_load_by_one_point_a_step():
    upper, cable = snake([0.0, 1.0, 2.0], [0.0, 10.0])
    assert list(zip(upper, cable, strict=True)) == [
        (0, 0), (0, 10), (1, 10), (1, 0), (2, 0), (2, 10)]


def test_map_has_all_points_in_order_and_is_written(tmp_path):
    found = reach([0.0, 0.01], [0.0, 0.02, 0.04], **SMALL)
    table = found.table()
    assert table["upper_MPa"].tolist() == [0.0] * 3 + [0.01] * 3
    assert table["cable_N"].tolist() == [0.0, 0.02, 0.04] * 2
    span, chord = (table[f"{name}_angle_deg"].to_numpy().reshape(2, 3) for name in
                   ("span", "chord"))
    assert np.all(np.diff(span, axis=0) > 0.3) and np.all(np.diff(chord, axis=1) > 1.0)
    assert {"rib_stress_MPa", "largest_stretch"} < set(table)
    found.save(tmp_path)
    assert {file.name for file in tmp_path.iterdir()} == {"map.png", "table.csv", "summary.json"}
    assert json.loads((tmp_path / "summary.json").read_text())["converged"] is True


@pytest.mark.quick
@pytest.mark.parametrize("pressures", [[], [0.0, 0.0], [0.02, 0.01]])
def test_pressures_that_do_not_rise_are_refused(pressures):
    with pytest.raises(InputError, match="pressures = .* must be one or more rising numbers"):
        reach(pressures, [0.0], **SMALL)
