"""Natural frequencies: a clamped strip against the beam's, and to zero where it buckles."""

from types import SimpleNamespace

import numpy as np
import pytest
from mpi4py import MPI

from morphing_wing import InputError, Rib
from morphing_wing.forms.gravity import mass_density
from morphing_wing.geometry import RibGeometry
from morphing_wing.modes import modes
from morphing_wing.path import State
from morphing_wing.verification.cantilever import Cantilever
from tests.solvers.strip import HEIGHT, LENGTH, Strip

CRITICAL = 4 * np.pi**2 / 12 * HEIGHT**2 / LENGTH  # shortening in mm at Euler's load, ends clamped


def scene_of(strip):
    """Return what `modes` needs of a scene, for a system of one block."""
    def present():
        return State({}, {}, 0, 0.0, 0.0, 0, 0.0, True, {})

    def set_unknowns(values):
        strip.body.function.x.array[:] = values[0]

    return SimpleNamespace(
        name="strip", comm=strip.system.comm, system=strip.system, newton=strip.newton,
        kept_blocks=strip.system.blocks, present=present, masses=lambda: [mass(strip.body)],
        unknowns=lambda: [strip.body.function.x.array.copy()], set_unknowns=set_unknowns,
        linearise=strip.newton.linearise)


def mass(part):
    return mass_density(part.material.density) * part.lumped_volume()


def eigenvalue(shortening, element="Q2 reduced"):
    """Return the lowest eigenvalue in 1/s^2 of the straight strip."""
    strip = Strip(imperfection=0.0, regularised=False, element=element)
    assert strip.push(shortening).converged
    return modes(scene_of(strip), 1)[0].eigenvalue


pytestmark = pytest.mark.quick


@pytest.mark.parametrize("element", ["Q2 reduced", "Q2/P1disc"])
def test_frequency_of_a_clamped_strip_is_the_beams(element):
    strip = Strip(imperfection=0.0, regularised=False, element=element)
    assert strip.push(0.0).converged
    mode = modes(scene_of(strip), 1)[0]
    material = strip.body.material
    young = 9 * material.bulk * material.shear_modulus / (
        3 * material.bulk + material.shear_modulus)
    density = 1e-12 * material.density  # tonnes, with N and mm
    beam = 4.730041**2 / LENGTH**2 * np.sqrt(young * HEIGHT**2 / 12 / density) / (2 * np.pi)
    assert mode.frequency_Hz == pytest.approx(beam, rel=0.03)
    moving = strip.body.is_displacement()
    bow = np.abs(mode.fields[strip.body.function.name][strip.body.block.owned])[moving]
    assert bow.max() == pytest.approx(1.0)


def test_frequencies_of_a_cantilever_of_beams_are_eulers():
    bar = Cantilever(MPI.COMM_SELF, 20, length=30.0)
    assert bar.newton.solve(1.0).converged
    beams = bar.beams
    found = modes(scene_of(SimpleNamespace(body=beams, system=bar.system, newton=bar.newton)), 2)
    density, young = 1e-12 * beams.material.density, beams.material.E
    euler = 1.875104**2 / 30.0**2 * np.sqrt(young / 12.0 / density) / (2.0 * np.pi)
    for mode in found:  # it is square: one for each direction
        assert mode.frequency_Hz == pytest.approx(euler, rel=0.01)


def test_eigenvalue_falls_to_zero_at_eulers_load_and_is_negative_beyond():
    free = eigenvalue(0.0)
    # By Rayleigh's quotient of the free mode, whose own critical load is Euler's over 0.970.
    assert eigenvalue(0.5 * CRITICAL) == pytest.approx((1 - 0.970 * 0.5) * free, rel=0.03)
    assert abs(eigenvalue(CRITICAL)) < 0.06 * free
    assert eigenvalue(1.5 * CRITICAL) == pytest.approx(-0.5 * free, rel=0.1)


def test_modes_are_orthogonal_and_leave_the_strip_where_it_was():
    strip = Strip(imperfection=0.0, regularised=False)
    strip.push(0.01)
    before = strip.body.function.x.array.copy()
    found = modes(scene_of(strip), 3)
    weight = mass(strip.body)
    shapes = [mode.fields[strip.body.function.name] for mode in found]
    products = np.array([[a @ (weight * b) for b in shapes] for a in shapes])
    scale = np.sqrt(np.outer(np.diag(products), np.diag(products)))
    np.testing.assert_allclose(products / scale, np.eye(3), atol=1e-7)
    np.testing.assert_array_equal(strip.body.function.x.array, before)
    assert list(found.table().index) == [1, 2, 3]
    assert (np.diff(found.table()["frequency_Hz"]) > 0).all()


def test_all_of_a_bodys_and_a_ribs_mass_is_there():
    strip = Strip(imperfection=0.0, regularised=False)
    assert mass(strip.body).sum() == pytest.approx(3e-9 * 1080 * LENGTH * HEIGHT)
    rib = Rib(RibGeometry.validation())
    frame = rib.ribs.frame
    length = np.linalg.norm(frame.points[frame.bars[:, 1]] - frame.points[frame.bars[:, 0]], axis=1)
    assert mass(rib.ribs).sum() == pytest.approx(3e-9 * 1180 * (frame.areas() @ length))


def test_what_has_no_modes_says_so():
    rib = Rib(RibGeometry.validation())
    with pytest.raises(InputError, match="rib: must have been led to a load first"):
        modes(rib)
    rib.bend(0.1)
    with pytest.raises(InputError, match="n = 0: must be a whole number"):
        modes(rib, 0)
