"""Stresses in bars against beam theory: M c / I, N / A, T r / J, and von Mises of them."""

import numpy as np
import pytest
from mpi4py import MPI

from morphing_wing.beam_stress import BeamStress
from morphing_wing.geometry.section import Circle, Rectangle, Stiffened, torsion_modulus
from morphing_wing.materials import RESIN
from morphing_wing.verification.cantilever import Cantilever

pytestmark = pytest.mark.quick


def stress(load, section, cells=1, length=10.0):
    bar = Cantilever(MPI.COMM_SELF, cells, length, section=section)
    bar.tip_after(load)
    return BeamStress(bar.beams, RESIN).largest()


@pytest.mark.parametrize("cells", [1, 4])
def test_cantilever_under_end_force_has_m_c_over_i_at_its_root(cells):
    width, depth, P, L = 1.5, 1.0, 1e-4, 10.0
    found = stress([0, -P, 0, 0, 0, 0], Rectangle(width, depth), cells)
    assert found == pytest.approx(P * L * (width / 2) / (depth * width**3 / 12), rel=1e-6)


def test_each_local_axis_has_its_own_section_modulus():
    found = stress([0, 0, 1e-4, 0, 0, 0], Rectangle(1.5, 1.0))
    assert found == pytest.approx(1e-4 * 10.0 / (1.5 * 1.0**2 / 6), rel=1e-6)


def test_pulled_bar_has_n_over_a():
    assert stress([2.0, 0, 0, 0, 0, 0], Rectangle(1.5, 1.0)) == pytest.approx(2.0 / 1.5, rel=1e-2)


def test_bent_and_twisted_round_bar_has_von_mises_stress():
    d, M, T = 1.5, 3e-3, 4e-3
    found = stress([0, 0, 0, T, 0, M], Circle(d))
    sigma, tau = 32 * M / (np.pi * d**3), 16 * T / (np.pi * d**3)
    assert found == pytest.approx(np.sqrt(sigma**2 + 3 * tau**2), rel=1e-4)


def test_two_moments_act_as_one_in_a_round_bar_and_add_up_in_a_corner():
    zero, three, four = np.zeros(1), np.array([3.0]), np.array([4.0])
    W = np.pi / 32
    assert Circle(1.0).largest_stress(zero, zero, three, four) == pytest.approx(5.0 / W)
    assert Rectangle(1.0, 1.0).largest_stress(zero, zero, three, four) == pytest.approx(42.0)


@pytest.mark.parametrize("ratio, coefficient", [(1.0, 0.208), (2.0, 0.246), (4.0, 0.282)])
def test_torsion_modulus_of_a_rectangle_is_timoshenkos(ratio, coefficient):
    assert torsion_modulus(ratio, 1.0) / ratio == pytest.approx(coefficient, abs=6e-4)


def test_nearly_rigid_pieces_have_no_stress():
    found = Stiffened(Circle(1.0)).largest_stress(*np.ones((4, 3)))
    assert found.tolist() == [0.0, 0.0, 0.0]
