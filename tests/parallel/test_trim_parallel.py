"""A trim finds the same loads on any number of ranks, by the same steps."""

import numpy as np
import pytest
from mpi4py import MPI

from morphing_wing.sensitivity import sensitivities
from tests.scenes.small_wing import small_wing

RELATIVE = 1e-8


@pytest.mark.parametrize("ask", [
    {"span": -1.0, "chord": 0.4}, {"span": 1.0, "max_pressure": 0.01},
], ids=["reached", "not reached"])
def test_trim_is_the_same(ask):
    together, alone = (small_wing(comm).trim(**ask) for comm in (MPI.COMM_WORLD, MPI.COMM_SELF))
    assert (together.converged, together.reason, together.iterations) == (
        alone.converged, alone.reason, alone.iterations)
    assert len(together.path) == len(alone.path)
    for many, one in ((together.loads, alone.loads), (together.angles, alone.angles)):
        assert many == pytest.approx(one, rel=RELATIVE)
    np.testing.assert_allclose(together.sensitivities, alone.sensitivities, rtol=1e-6)
    everywhere = MPI.COMM_WORLD.allgather((together.loads, together.angles))
    assert all(found == everywhere[0] for found in everywhere)


@pytest.mark.quick
def test_sensitivities_are_the_same_and_leave_the_state_as_it_is():
    found = []
    for comm in (MPI.COMM_WORLD, MPI.COMM_SELF):
        scene = small_wing(comm)
        state = scene.actuate(upper=0.01, cable=0.1)[-1]
        found.append(sensitivities(scene, ["upper_MPa", "cable_N"]))
        for values, block in zip(scene.unknowns(), scene.system.blocks, strict=True):
            if block.local:
                continue
            np.testing.assert_array_equal(values, state.fields[block.function.name])
    for name, rates in found[0].items():
        assert rates == pytest.approx(found[1][name], rel=1e-6), name
