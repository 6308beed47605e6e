"""Second-order tetrahedra of the problems with known answers."""

import numpy as np
import pytest
from mpi4py import MPI

from morphing_wing import compat
from morphing_wing.materials import RESIN
from morphing_wing.resin_body import ResinBody
from morphing_wing.verification.meshes import SIDES, distorted, tetrahedra, tube

pytestmark = pytest.mark.quick


@pytest.mark.parametrize("mapping", [distorted, tube])
def test_the_body_has_the_volume_of_its_curved_mesh(mapping):
    grid = tetrahedra(2, mapping)
    body = ResinBody(MPI.COMM_SELF, grid, RESIN)
    one = compat.constant(body.mesh, 1.0)
    volume = compat.assemble_scalar(MPI.COMM_SELF, compat.form(one * body.measure))
    assert volume == pytest.approx(grid.volume(), rel=1e-13)
    assert body.lumped_volume().sum() == pytest.approx(3.0 * volume, rel=1e-13)


def test_a_cube_has_all_its_faces_and_no_folded_cell():
    grid = tetrahedra(3)
    assert {name: len(pairs) for name, pairs in grid.facets.items()} == dict.fromkeys(SIDES, 18)
    assert grid.volume() == pytest.approx(1.0, rel=1e-13)
    assert np.all(grid.smallest_jacobian() > 0.3)
