"""A strip one hexahedron thick, bent as a cantilever: what linear hexahedra make of a thin skin."""

import numpy as np
import pytest
from mpi4py import MPI

from morphing_wing.geometry.hexmesh import swept_blocks, uniform
from morphing_wing.materials import DRAGON_SKIN_30
from morphing_wing.verification.equilibrium import Equilibrium

LENGTH, DEFLECTION, CELLS = 40.0, 0.1, 8


def energy(element, oblique=0.0):
    """Energy in N mm of the strip with its tip face pushed aside; cells lean by ``oblique`` mm."""
    def mapping(x):
        return x + np.outer(oblique * (x[:, 1] - 0.5), [1, 0, 0])

    def faces(midpoints, normals):
        return {"left": normals[:, 0] < 0, "right": normals[:, 0] > 0}

    lines = LENGTH * uniform(CELLS), uniform(1), uniform(1)
    grid = swept_blocks(lines, np.ones((CELLS, 1, 1), int), {1: "body"}, mapping, faces)
    problem = Equilibrium(
        MPI.COMM_SELF, grid, DRAGON_SKIN_30, element, clamped=("left",), symmetry={"right": 1})
    problem.displacement_function().interpolate(
        lambda x: DEFLECTION * np.stack([0 * x[0], (x[0] / LENGTH) ** 2, 0 * x[0]]))
    problem.solve()
    return problem.system.energies()[0]


def beam_energy():
    """Energy in N mm of the beam of unit section, clamped at one end."""
    mu, kappa = DRAGON_SKIN_30.shear_modulus, DRAGON_SKIN_30.bulk
    young = 9 * kappa * mu / (3 * kappa + mu)
    return young / 12 * 1.5 * DEFLECTION**2 / LENGTH**3


def test_enhanced_strains_bend_as_the_beam_does():
    assert energy("Q1 enhanced") == pytest.approx(beam_energy(), rel=0.03)


def test_enhanced_strains_bend_oblique_cells_as_quadratic_ones_do():
    assert energy("Q1 enhanced", 1.0) == pytest.approx(energy("Q2 reduced", 1.0), rel=0.05)


def test_linear_hexahedra_without_them_do_not():
    assert energy("Q1 reduced") > 3.0 * beam_energy()
