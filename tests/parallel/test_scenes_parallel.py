"""Scenes give the same figures on any number of ranks as on one."""

import json
from dataclasses import replace

import numpy as np
import pytest
from mpi4py import MPI

from morphing_wing import condensed_rib, solid_rib
from morphing_wing.fields import mode_grids
from morphing_wing.geometry.rib import RibGeometry
from morphing_wing.geometry.spar import SparGeometry, SparMeshing
from morphing_wing.materials import Adhesive
from morphing_wing.modes import modes
from morphing_wing.rib import Rib
from morphing_wing.spar import Spar
from morphing_wing.summary import summary
from tests.parallel.tolerances import WORK
from tests.scenes.small_wing import GEOMETRY, small_wing

# Rounding of the factorisation, seen through Newton's tolerance.
RELATIVE = 1e-8


def figures(path, without=()):
    """All of a summary but the time that it took, and what is told apart."""
    found = json.loads(json.dumps(summary(path)))
    return {name: value for name, value in found.items() if name not in ("seconds", *without)}


def assert_same(many, one, size, where=""):
    """Compare nested figures; numbers relative to the largest one that stands beside them."""
    assert type(many) is type(one), where
    if isinstance(one, dict):
        assert many.keys() == one.keys(), where
        for name in one:
            assert_same(many[name], one[name], size, f"{where}.{name}")
    elif isinstance(one, list) and one and isinstance(one[0], float):
        np.testing.assert_allclose(many, one, rtol=RELATIVE, atol=size, err_msg=where)
    elif isinstance(one, float):
        assert many == pytest.approx(one, rel=RELATIVE, abs=size), where
    else:
        assert many == one, where


def compare(run, without=(), size=1e-12):
    """Run on all ranks together and on each alone; every figure and count must be the same."""
    together, alone = run(MPI.COMM_WORLD), run(MPI.COMM_SELF)
    assert alone.converged, alone.reason
    without = ("external_work_Nmm", *without)
    assert_same(figures(together, without), figures(alone, without), size)
    assert len(together) == len(alone)
    for state, reference in zip(together, alone, strict=True):
        assert (state.requested, state.negative_pivots) == (
            reference.requested, reference.negative_pivots)
        assert state.external_work_Nmm == pytest.approx(
            reference.external_work_Nmm, rel=WORK)


@pytest.mark.quick
def test_spar_is_the_same():
    def run(comm):
        scene = Spar(SparGeometry.validation(4), fidelity="draft", comm=comm)
        return scene.inflate(upper=[0.01, 0.03], lower=[0.0, 0.005])

    compare(run)


@pytest.mark.quick
@pytest.mark.parametrize("filled", ["shared", "separate"])
def test_spar_filled_with_a_volume_is_the_same(filled):
    def run(comm):
        scene = Spar(SparGeometry.validation(3), fidelity="draft", comm=comm, filled=filled)
        return scene.fill(upper=[1000.0, 2500.0], lower=[0.0, 500.0])

    compare(run)


def test_one_cell_of_a_spar_is_the_same():
    def run(comm):
        return Spar(SparGeometry.validation(20), fidelity="cell", comm=comm,
                    meshing=SparMeshing.graded(1)).inflate(upper=[0.01, 0.03], lower=[0.0, 0.005])

    compare(run)


@pytest.mark.parametrize("element", ["Q2/P1disc", "Q2/Q1", "Q2 reduced"])
def test_spar_of_each_kind_of_element_is_the_same(element):
    def run(comm):
        scene = Spar(SparGeometry.validation(1), element=element, comm=comm)
        return scene.inflate(upper=[0.01, 0.02])

    compare(run)


@pytest.mark.quick
def test_rib_is_the_same():
    def run(comm):
        return Rib(RibGeometry.validation(), comm=comm).bend(torque=[2.0, 5.0])

    compare(run)


@pytest.mark.quick
@pytest.mark.parametrize("lead", [lambda r: r.bend(torque=[2.0, 5.0]), lambda r: r.pull(cable=0.5)],
                         ids=["moment", "cable"])
def test_rib_of_one_condensed_cell_is_the_same(lead, monkeypatch):
    monkeypatch.setitem(condensed_rib.AROUND, "cell", 6)
    compare(lambda comm: lead(Rib(RibGeometry.validation(), fidelity="cell", comm=comm)))


def wing(comm):
    return small_wing(comm).actuate(upper=[0.005, 0.01], cable=[0.0, 0.1])


@pytest.mark.quick
def test_wing_with_ribs_skin_cables_and_pressure_is_the_same():
    compare(wing, without=("gap_mm",))


@pytest.mark.quick
def test_wing_with_ribs_of_condensed_cells_is_the_same():
    geometry = replace(GEOMETRY, skin_thickness=None, rib=replace(GEOMETRY.rib, n_cells=3))

    def run(comm):
        return small_wing(comm, geometry=geometry, rib_model="cell", around=6).actuate(
            upper=0.01, cable=0.2)

    compare(run)


def test_heavy_wing_with_a_slit_skin_and_a_tip_wall_is_the_same():
    geometry = replace(GEOMETRY, skin_root="free", tip_wall=True, skin_slit="lower")

    def run(comm):
        return small_wing(comm, geometry=geometry).actuate(cable=0.05, gravity=[0.0, 1.0])

    compare(run, without=("gap_mm",))


def test_gap_in_the_wing_is_the_same():
    together, alone = wing(MPI.COMM_WORLD), wing(MPI.COMM_SELF)
    for state, reference in zip(together, alone, strict=True):
        assert state.measures["gap_mm"] == pytest.approx(
            reference.measures["gap_mm"], rel=RELATIVE)


def test_a_wing_whose_skin_lies_on_a_rib_is_the_same():
    geometry = replace(GEOMETRY, n_cells=4, skin_thickness=0.3, rib_positions=(0.75,))

    def run(comm):
        path = small_wing(comm, geometry=geometry).actuate(cable=[0.1, 0.15, 0.3])
        assert path.converged, path.reason
        assert path[-1].measures["touching"] == 1.0
        return path

    compare(run, size=1e-7)


def test_a_wing_whose_glue_gives_way_is_the_same():
    geometry = replace(GEOMETRY, skin_thickness=None)

    def run(comm):
        glue = Adhesive(stiffness=50.0, strength=1.0, toughness=0.5)
        path = small_wing(comm, geometry=geometry, adhesive=glue).actuate(cable=[0.02, 0.06, 0.1])
        assert path.converged, path.reason
        assert path[-1].measures["glue_damage"] > 0.0
        return path

    compare(run, size=1e-7)


def test_modes_are_the_same():
    def found(comm):
        wing = small_wing(comm=comm)
        assert wing.actuate(upper=0.01).converged
        return modes(wing, 3)

    many, one = found(MPI.COMM_WORLD), found(MPI.COMM_SELF)
    np.testing.assert_allclose(
        many.table()["frequency_Hz"], one.table()["frequency_Hz"], rtol=RELATIVE)
    for i in range(3):
        for name, grid in mode_grids(many, i).items():
            alone = mode_grids(one, i)[name].point_data["mode"]
            if MPI.COMM_WORLD.rank == 0:
                shape = grid.point_data["mode"]
                sign = np.sign(np.vdot(shape, alone))
                np.testing.assert_allclose(sign * shape, alone, atol=1e-5)


def test_a_solid_rib_is_the_same(monkeypatch):
    monkeypatch.setitem(solid_rib.AROUND, "standard", 6)
    geometry = replace(RibGeometry.validation("square", bosses=True), n_cells=2)
    compare(lambda comm: Rib(geometry, fidelity="standard", comm=comm).bend(torque=[5.0, 40.0]))


def test_a_wing_with_a_solid_rib_is_the_same():
    geometry = replace(GEOMETRY, skin_thickness=None, rib=replace(GEOMETRY.rib, n_cells=2))
    compare(lambda comm: small_wing(
        comm, geometry=geometry, rib_model="solid").actuate(upper=0.01, cable=0.1))
