"""Homogeneous deformations beyond those of ``morphing-wing verify``.

One volumetric point a cell ("Q1 reduced") cannot integrate the volume's gradient of a warped
hexahedron: that element passes the patch test on parallelepipeds, and on others in the limit of
refinement.
"""

import pytest
from mpi4py import MPI

from morphing_wing.materials import DRAGON_SKIN_30
from morphing_wing.verification.homogeneous import (
    MODES,
    computed_stress,
    exact_stress,
    patch_error,
)
from morphing_wing.verification.meshes import cube


def test_one_volumetric_point_passes_the_patch_test_in_the_limit_of_refinement():
    errors = [patch_error("Q1 reduced", cube(n), MPI.COMM_SELF) for n in (6, 12)]
    assert 1e-5 < errors[0] < 1e-3
    assert errors[1] < errors[0] / 3


@pytest.mark.parametrize("element", ["Q2/P1disc", "Q2/Q1", "Q1/P0"])
@pytest.mark.parametrize("mode", list(MODES))
def test_stress_of_mixed_forms_at_three_times_the_length_is_the_closed_forms(element, mode):
    computed = computed_stress(mode, DRAGON_SKIN_30, element, 3.0, cube(), MPI.COMM_SELF)
    assert computed == pytest.approx(exact_stress(mode, DRAGON_SKIN_30, 3.0), rel=1e-9)


def test_enhanced_strains_have_no_hourglasses_in_strong_compression():
    # `Equilibrium.solve` refuses negative pivots.
    computed = computed_stress(
        "uniaxial", DRAGON_SKIN_30, "Q1 enhanced", 0.4, cube(warp=0.0), MPI.COMM_SELF)
    assert computed == pytest.approx(exact_stress("uniaxial", DRAGON_SKIN_30, 0.4), rel=1e-9)
