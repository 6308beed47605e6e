"""The paper's formulas over arrays: known figures, inverse, limit point and exact derivatives."""

import subprocess
import sys
from dataclasses import replace

import numpy as np
import pytest
from scipy.optimize import brentq, minimize_scalar

from morphing_wing.analytic_rib import RibFormula, rib_compliance
from morphing_wing.analytic_spar import LARGEST_TURN, SparFormula
from morphing_wing.blockwise import BLOCK
from morphing_wing.errors import InputError
from morphing_wing.geometry.rib import RibGeometry
from morphing_wing.geometry.spar import SparGeometry
from morphing_wing.materials import DRAGON_SKIN_30, RESIN, Yeoh

pytestmark = pytest.mark.quick

VALIDATION = SparGeometry.validation()
STIFFENING = Yeoh((0.117, -0.03, 0.004))
LENGTHS = {"cavity_length": (1.5, 5.0), "wall_length": (1.5, 3.0), "top_thickness": (0.8, 2.0),
           "cavity_height": (4.0, 8.0), "middle_thickness": (1.5, 3.0),
           "side_thickness": (0.8, 2.0), "cavity_width": (20.0, 60.0)}
RIBS = {"shaft_length": (5.0, 9.0), "shaft_thickness": (0.8, 2.0), "pivot_diameter": (1.0, 2.0),
        "pivot_length": (4.0, 8.0), "crossing_angle": (50.0, 120.0), "E": (2370.0, 2640.0),
        "nu": (0.3, 0.4)}


def some(ranges, n, seed=1):
    random = np.random.default_rng(seed)
    return {name: random.uniform(*ends, n) for name, ends in ranges.items()}


def test_all_rows_of_table_2_at_once():
    rows = SparFormula(VALIDATION, DRAGON_SKIN_30,
                       wall_length=np.repeat([2.0, 2.2, 2.4], 3),
                       cavity_length=np.tile([2.0, 2.4, 2.8], 3),
                       top_thickness=[1.0, 1.2, 1.4, 1.2, 1.4, 1.0, 1.4, 1.0, 1.2])
    angles = rows.angle(0.02)
    np.testing.assert_allclose(
        angles, [15.16, 13.65, 12.31, 14.73, 13.41, 16.97, 14.35, 18.19, 16.36], atol=5.1e-3)
    printed = np.array([15.13, 13.64, 12.26, 14.78, 13.41, 17.07, 14.32, 18.22, 16.39])
    off = np.abs(angles / printed - 1.0)
    assert off.mean() == pytest.approx(0.0025, abs=1e-4)
    assert off.max() == off[5] == pytest.approx(0.0060, abs=1e-4)


def test_the_papers_sets_over_pressure():
    angles = SparFormula(VALIDATION, DRAGON_SKIN_30).angle([0.005, 0.01, 0.015, 0.02, 0.025, 0.03])
    np.testing.assert_allclose(angles, [4.080, 8.266, 12.561, 16.968, 21.491, 26.133], atol=5e-4)
    prototype = SparGeometry(5.0, 2.0, 2.0, 6.0, 1.5, 2.0, 40.0, 18)
    angles = SparFormula(prototype, DRAGON_SKIN_30).angle(
        [0.01, 0.02, 0.025, 0.03, 0.04, 0.05, 0.06])
    np.testing.assert_allclose(
        angles, [4.58, 9.35, 11.82, 14.33, 19.53, 24.95, 30.60], atol=5.1e-3)


def test_ribs_of_both_sets_and_readings():
    bases = [preset(n_cells=6, section=section) if preset == RibGeometry.prototype
             else preset(section) for preset in (RibGeometry.validation, RibGeometry.prototype)
             for section in ("square", "flush")]
    found = [RibFormula(base, RESIN).compliance for base in bases]
    np.testing.assert_allclose(found, [1.941, 1.171, 2.951, 1.413], atol=6e-4)
    consistent = RibFormula(bases[0], RESIN, consistent=True).compliance
    assert consistent == pytest.approx(2.042, abs=5e-4)


def test_arrays_give_what_each_spar_gives_alone():
    values = some(LENGTHS, 5)
    n, pressures = np.array([1, 4, 9, 20, 30]), np.array([0.0, 0.01, 0.03])
    together = SparFormula(VALIDATION, DRAGON_SKIN_30, n_cells=n, **values)
    alone = [SparFormula(
        replace(VALIDATION, n_cells=int(n[i]), **{k: float(v[i]) for k, v in values.items()}),
        DRAGON_SKIN_30) for i in range(5)]
    angles = together.angle(pressures[:, None])
    assert angles.shape == (3, 5)
    np.testing.assert_array_equal(angles, [[spar.angle(p) for spar in alone] for p in pressures])
    np.testing.assert_array_equal(together.largest_pressure, [a.largest_pressure for a in alone])
    np.testing.assert_array_equal(together.energy(0.01), [a.energy(0.01) for a in alone])


def test_arrays_give_what_each_rib_gives_alone():
    values = some({name: RIBS[name] for name in list(RIBS)[:5]}, 4)
    together = RibFormula(RibGeometry.validation("square"), RESIN, **values)
    alone = [rib_compliance(replace(RibGeometry.validation("square"),
                                    **{k: float(v[i]) for k, v in values.items()}), RESIN)
             for i in range(4)]
    np.testing.assert_array_equal(together.compliance, alone)


def test_more_values_than_a_block_holds_give_the_same():
    few, many = np.linspace(0.0, 0.03, 7), np.linspace(0.0, 0.03, 7).repeat(BLOCK)
    spar = SparFormula(VALIDATION, DRAGON_SKIN_30, top_thickness=[[1.0], [1.3]])
    np.testing.assert_array_equal(spar.angle(many)[:, :: BLOCK], spar.angle(few))
    np.testing.assert_array_equal(
        spar.derivatives(many)["top_thickness"][:, :: BLOCK],
        spar.derivatives(few)["top_thickness"])


@pytest.mark.parametrize("material", [DRAGON_SKIN_30, Yeoh((0.117,)), STIFFENING])
def test_the_turn_is_the_inverse_of_the_pressure(material):
    spars = SparFormula(VALIDATION, material, **some(LENGTHS, 2000))
    pressures = np.linspace(0.0, 0.999, 2000) * spars.largest_pressure
    turns = spars.turn(pressures)
    assert turns[0] == 0.0
    np.testing.assert_allclose(spars.pressure(turns), pressures, rtol=1e-13)


@pytest.mark.parametrize("material", [DRAGON_SKIN_30, Yeoh((0.117, -0.005)), STIFFENING])
def test_the_largest_pressure_is_the_first_peak_and_beyond_there_is_no_turn(material):
    spars = SparFormula(VALIDATION, material, **some(LENGTHS, 40))
    turns = np.linspace(0.0, LARGEST_TURN, 20_001)
    curves = spars.pressure(turns[:, None])
    for curve, largest in zip(curves.T, spars.largest_pressure, strict=True):
        falls = np.flatnonzero(np.diff(curve) < 0.0)
        first = curve[falls[0]] if len(falls) else curve[-1]
        assert largest == pytest.approx(first, rel=1e-7)
    assert np.isnan(spars.turn(spars.largest_pressure * (1 + 1e-9))).all()
    assert np.isnan(spars.turn([[-1e-9], [np.nan]])).all()
    assert np.isfinite(spars.turn(spars.largest_pressure * (1 - 1e-6))).all()


def test_where_a_law_stiffens_again_the_first_branch_is_taken_not_the_second():
    spar = SparFormula(VALIDATION, STIFFENING)
    peak = minimize_scalar(lambda t: -spar.pressure(t), bounds=(0.0, 0.3), method="bounded",
                           options={"xatol": 1e-12}).x
    assert spar.pressure(LARGEST_TURN) > spar.largest_pressure > spar.pressure(peak + 0.05)
    assert spar.largest_pressure == pytest.approx(spar.pressure(peak), rel=1e-12)
    for part in (0.5, 0.9, 0.999):
        wanted = part * spar.largest_pressure
        by_bisection = brentq(lambda t, p=wanted: spar.pressure(t) - p, 0.0, peak, xtol=1e-15)
        assert spar.turn(wanted) == pytest.approx(by_bisection, rel=1e-9)
    assert np.isnan(spar.turn(1.001 * spar.largest_pressure))


@pytest.mark.parametrize("material", [DRAGON_SKIN_30, STIFFENING], ids=["two terms", "three"])
def test_derivatives_of_the_spars_angle_are_its_differences(material):
    values = some(LENGTHS, 50) | {
        f"C{i}0": c * np.ones(50) for i, c in enumerate(material.coefficients, start=1)}
    pressure = 0.6 * SparFormula(VALIDATION, material, **values).largest_pressure
    exact = SparFormula(VALIDATION, material, **values).derivatives(pressure)
    assert set(exact) == {"pressure", "n_cells", *values}

    def angle(name=None, step=0.0):
        changed = values if name is None else values | {name: values[name] + step}
        return SparFormula(VALIDATION, material, **changed)

    for name in values:
        h = 1e-5 * np.abs(values[name])
        difference = (angle(name, h).angle(pressure) - angle(name, -h).angle(pressure)) / (2 * h)
        np.testing.assert_allclose(exact[name], difference, rtol=2e-7, atol=1e-7)
    h = 1e-5 * pressure
    difference = (angle().angle(pressure + h) - angle().angle(pressure - h)) / (2 * h)
    np.testing.assert_allclose(exact["pressure"], difference, rtol=2e-7)
    np.testing.assert_allclose(exact["n_cells"], angle().angle(pressure) / VALIDATION.n_cells)


def test_the_stiffness_left_is_1_at_rest_and_0_at_the_limit_point():
    spar = SparFormula(VALIDATION, STIFFENING)
    limit = brentq(lambda t: spar.pressure(t + 1e-6) - spar.pressure(t - 1e-6), 0.01, 0.3)
    assert spar.stiffness_left(0.0) == 1.0
    assert spar.stiffness_left(limit) == pytest.approx(0.0, abs=1e-6)


def test_energy_is_a_sum_over_stretches_and_its_slope_the_pressure():
    spar, h = SparFormula(VALIDATION, DRAGON_SKIN_30, top_thickness=[1.0, 1.4]), 1e-6
    slope = (spar.energy(0.02 + h) - spar.energy(0.02 - h)) / (2 * h)
    lever = np.array([1.0, 1.4]) + VALIDATION.cavity_height + VALIDATION.middle_thickness / 2
    swept = VALIDATION.n_cells * 1.5 * lever**2 * VALIDATION.width
    np.testing.assert_allclose(slope, swept * spar.pressure(0.02), rtol=1e-8)
    stretches = spar.stretches([[0.0], [0.02]])
    assert stretches.shape == (2, 2, 4) and (stretches[0] == 1.0).all()
    np.testing.assert_allclose(
        stretches[1, :, 0] - 1.0, 2 * lever * 0.02 / VALIDATION.pitch, rtol=1e-13)
    np.testing.assert_allclose(stretches[1, :, 2] - 1.0, (stretches[1, :, 0] - 1.0) / 2)
    np.testing.assert_array_equal(stretches[..., 2], stretches[..., 3])


@pytest.mark.parametrize("section", ["flush", "square"])
@pytest.mark.parametrize("consistent", [False, True])
def test_derivatives_of_the_ribs_angle_are_its_differences(section, consistent):
    values, base = some(RIBS, 50), RibGeometry.validation(section)
    exact = RibFormula(base, RESIN, consistent, **values).derivatives(5.0)
    assert set(exact) == {"torque", "n_cells", *values}
    for name in values:
        h = 1e-5 * values[name]
        more, less = (RibFormula(base, RESIN, consistent, **values | {name: values[name] + s})
                      for s in (h, -h))
        difference = (more.angle(5.0) - less.angle(5.0)) / (2 * h)
        np.testing.assert_allclose(exact[name], difference, rtol=1e-7, atol=1e-8)
    more = RibFormula(base, RESIN, consistent, n_cells=7, **values)
    less = RibFormula(base, RESIN, consistent, n_cells=6, **values)
    np.testing.assert_allclose(exact["n_cells"], more.angle(5.0) - less.angle(5.0))
    np.testing.assert_allclose(exact["torque"], less.compliance)


@pytest.mark.parametrize("formula, base, material, changes, said", [
    (SparFormula, VALIDATION, DRAGON_SKIN_30, {"top_thicknes": 1.0},
     "top_thicknes: unknown parameter, must be one of cavity_length,"),
    (SparFormula, VALIDATION, DRAGON_SKIN_30, {"top_thickness": [1.0, -1.0]},
     "top_thickness = -1 mm: must be finite and greater than 0"),
    (SparFormula, VALIDATION, DRAGON_SKIN_30, {"n_cells": 2.5},
     "n_cells = 2.5: must be a whole number"),
    (SparFormula, VALIDATION, DRAGON_SKIN_30, {"C20": np.nan}, "C20 = nan MPa: must be finite"),
    (SparFormula, VALIDATION, DRAGON_SKIN_30, {"C10": "soft"}, "C10 = 'soft': must be numbers"),
    (RibFormula, RibGeometry.validation(), RESIN, {"nu": 0.5}, "nu = 0.5: must be greater than -1"),
    (RibFormula, RibGeometry.validation(), RESIN, {"crossing_angle": 180.0},
     "crossing_angle = 180 degrees: must be between 0 and 180 degrees"),
])
def test_parameters_that_cannot_be_are_named(formula, base, material, changes, said):
    with pytest.raises(InputError, match=f"^{said}"):
        formula(base, material, **changes)


def test_formulas_are_computed_without_dolfinx():
    code = ("import sys, morphing_wing.analytic_spar, morphing_wing.analytic_rib; "
            "sys.exit('dolfinx' in sys.modules)")
    assert subprocess.run([sys.executable, "-c", code], timeout=60).returncode == 0
