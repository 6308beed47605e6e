"""With which factor a load step begins."""

import numpy as np
import pytest
from mpi4py import MPI

from morphing_wing.geometry.spar import SparGeometry, SparMeshing
from morphing_wing.rib import Rib
from morphing_wing.spar import Spar


def spar(n_cells=2, element="Q1/P0"):
    return Spar(SparGeometry.validation(n_cells), meshing=SparMeshing.plain(), element=element,
                comm=MPI.COMM_SELF)


@pytest.mark.quick
def test_a_step_begins_with_the_factor_of_the_state_before():
    scene = spar()
    scene.inflate(upper=0.01)
    for pressure in (0.015, 0.02):
        before = scene.newton.factor.factorisations
        state = scene.inflate(upper=pressure)[-1]
        assert scene.newton.factor.factorisations - before == state.newton_iterations - 1
    assert state.measures["span_angle_deg"] == pytest.approx(
        spar().inflate(upper=0.02)[-1].measures["span_angle_deg"], rel=1e-10)


@pytest.mark.quick
def test_a_step_so_small_that_no_tangent_is_made_still_has_pivots_of_its_own():
    scene = spar()
    scene.inflate(upper=0.01)
    before = scene.newton.factor.factorisations
    state = scene.inflate(upper=0.01 * (1 + 1e-12))[-1]
    assert state.newton_iterations <= 1 and state.negative_pivots == 0
    assert scene.newton.factor.factorisations == before + 1


@pytest.mark.parametrize("n_cells", [8, 9, 10])
def test_spars_whose_tangent_is_near_to_singular_under_the_new_load_take_one_step(n_cells):
    path = spar(n_cells, "Q2/P1disc").inflate(upper=0.02)
    assert len(path) == 1 and path[0].newton_iterations <= 8


def test_after_a_cut_and_with_a_cable_the_answer_is_the_same():
    path = spar().inflate(upper=[0.05, 0.2])
    assert not path.converged
    assert path[0].measures["span_angle_deg"] == pytest.approx(
        spar().inflate(upper=0.05)[-1].measures["span_angle_deg"], rel=1e-9)
    from morphing_wing.geometry.rib import RibGeometry

    ribs = [Rib(RibGeometry.validation(), comm=MPI.COMM_SELF).pull(cable=steps)[-1]
            for steps in (0.2, np.linspace(0.0, 0.2, 5)[1:])]
    assert ribs[0].measures["chord_angle_deg"] == pytest.approx(
        ribs[1].measures["chord_angle_deg"], rel=1e-8)


@pytest.mark.quick
def test_where_held_unknowns_have_moved_the_step_begins_with_a_tangent_of_its_own():
    scene = spar()
    scene.inflate(upper=0.01)
    before = scene.newton.factor.factorisations
    scene.body.function.x.array[:] *= 1.001
    scene.system.share()
    result = scene.solve()
    assert result.converged
    assert scene.newton.factor.factorisations - before == result.iterations
