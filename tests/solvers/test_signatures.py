"""Forms made before and after a compilation speak of the same arguments."""

import pytest
import ufl
from mpi4py import MPI

from morphing_wing import compat
from tests.forms.bodies import hollow_box

pytestmark = pytest.mark.quick


def test_compiling_a_form_leaves_its_arguments_what_they_were():
    # UFL looks arguments up by their hash, which holds the mesh's coordinate element: a compiler
    # that changes this element makes "different Arguments with same number and part" of one.
    grid = hollow_box()
    space = compat.vector_space(
        compat.create_mesh(MPI.COMM_SELF, "hexahedron", grid.cells, grid.points), 1)
    before = ufl.TestFunction(space)
    known = hash(before)
    compat.form(before[0] * ufl.dx(metadata={"quadrature_degree": 1}))
    after = ufl.TestFunction(space)
    assert known == hash(after) == hash(before) and before == after
    both = before[0] * ufl.dx(degree=1) + after[1] * ufl.dx(degree=1)
    assert len(both.arguments()) == 1
