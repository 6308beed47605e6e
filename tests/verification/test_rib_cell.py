"""The rib of one condensed cell against the solid, meshed with elements of the same size."""

from dataclasses import replace

import numpy as np
import pytest
from mpi4py import MPI

from morphing_wing import condensed_rib, solid_rib
from morphing_wing.geometry.rib import RibGeometry
from morphing_wing.linked_ribs import LinkedRibs
from morphing_wing.rib import Rib
from morphing_wing.rib_stiffness import tail_compliance
from morphing_wing.solid_ribs import SolidRibs


@pytest.fixture(params=[RibGeometry.validation("square", True), RibGeometry.prototype()],
                ids=["3.3-square", "5.1-flush"])
def pair(request, monkeypatch):
    monkeypatch.setitem(condensed_rib.AROUND, "cell", 16)
    monkeypatch.setitem(solid_rib.AROUND, "standard", 16)
    geometry = replace(request.param, n_cells=2)
    return [Rib(geometry, fidelity=name, comm=MPI.COMM_SELF) for name in ("cell", "standard")]


def test_moment_and_cable_do_to_one_cell_of_many_what_they_do_to_the_solid(pair):
    cell, solid = pair
    torque = 20.0 / cell.bend(torque=1.0)[-1].measures["chord_angle_deg"]
    for lead in (lambda r: r.bend(torque=torque),
                 lambda r: r.follow({"torque_Nmm": torque, "cable_N": 2.0})):
        found, expected = (lead(rib)[-1] for rib in (cell, solid))
        for measure, value in expected.measures.items():
            assert found.measures[measure] == pytest.approx(value, rel=5e-3)
        assert found.energy_Nmm == pytest.approx(expected.energy_Nmm, rel=5e-3)
    assert np.isclose(expected.load["cable_N"], 2.0)


def test_links_comply_with_all_six_loads_of_the_tail_as_the_whole_solid():
    geometry = replace(RibGeometry.validation("square", True), n_cells=2)

    def compliance(kind):
        class Whole(Rib):
            def _made(self):
                return kind(self.comm, self.geometry, self.material, 12, clamped=True)

        return tail_compliance(Whole(geometry, comm=MPI.COMM_SELF))

    links, solid = (compliance(kind) for kind in (LinkedRibs, SolidRibs))
    size = np.sqrt(np.diag(solid))
    np.testing.assert_allclose((links - solid) / np.outer(size, size), 0.0, atol=5e-3)
