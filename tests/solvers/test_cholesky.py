"""A factor by MUMPS, also of a matrix whose pivots it must put off."""

import numpy as np
import pytest
from mpi4py import MPI
from petsc4py import PETSc

from morphing_wing.cholesky import Cholesky

pytestmark = pytest.mark.quick
SIDE = 40


@pytest.fixture(scope="module")
def matrix():
    """Return a symmetric matrix on a grid, half of whose diagonal is zero."""
    random, n = np.random.default_rng(0), SIDE
    made = PETSc.Mat().createAIJ((n * n, n * n), nnz=7, comm=MPI.COMM_SELF)
    for i in range(n):
        for j in range(n):
            here = i * n + j
            made[here, here] = 0.0 if (i + j) % 2 else 1e-3
            for there in [(i, j + 1), (i + 1, j), (i + 1, j + 1)]:
                if max(there) < n:
                    other = there[0] * n + there[1]
                    made[here, other] = made[other, here] = random.standard_normal()
    made.assemble()
    return made


def residual(factor, matrix):
    """Return the relative residual of a solution with a factor."""
    b, y = matrix.createVecLeft(), matrix.createVecRight()
    b.set(1.0)
    factor.solve(b, y)
    return (matrix * y - b).norm() / b.norm()


def test_too_little_working_space_is_made_more(matrix):
    ample, scarce = Cholesky("test_"), Cholesky("test_", space=-60)
    for factor in (ample, scarce):
        factor.factorise(matrix)
        assert factor.error == 0
        assert residual(factor, matrix) < 1e-8
    assert scarce.negative_pivots == ample.negative_pivots > 0
    assert scarce.matrix.getMumpsIcntl(14) > 0


def test_its_negative_pivots_are_the_negative_eigenvalues(matrix):
    factor = Cholesky("test_")
    factor.factorise(matrix)
    assert factor.negative_pivots == (np.linalg.eigvalsh(matrix[:, :]) < 0.0).sum()


def test_working_space_held_by_an_option_fails_and_leaves_no_factor(matrix):
    options = PETSc.Options("test_held_")
    options.setValue("mat_mumps_icntl_14", -60)
    factor = Cholesky("test_held_")
    factor.factorise(matrix)
    assert factor.error == -9
    assert np.isnan(residual(factor, matrix))
    options.delValue("mat_mumps_icntl_14")
    factor.factorise(matrix)
    assert factor.error == 0
    assert residual(factor, matrix) < 1e-8
