"""The spar as a scene: other codes' figures, converged angles, symmetries, robustness."""

import numpy as np
import pytest
from mpi4py import MPI

from morphing_wing.errors import InputError
from morphing_wing.geometry.spar import SparGeometry, SparMeshing
from morphing_wing.materials import DRAGON_SKIN_30, Yeoh
from morphing_wing.spar import Spar

SMALL = SparGeometry.validation(2)


def spar(n_cells, element=None, material=DRAGON_SKIN_30, plain=False, **options):
    meshing = SparMeshing.plain() if plain else None
    return Spar(SparGeometry.validation(n_cells), material, element=element, meshing=meshing,
                comm=MPI.COMM_SELF, **options)


def angles(path):
    return [state.measures["span_angle_deg"] for state in path]


def inflated(scene, upper=None, lower=None):
    """Inflate in as many steps as there are pressures."""
    path = scene.inflate(upper=upper, lower=lower)
    assert path.converged, path.reason
    assert all(state.requested for state in path)
    return path


# -- figures of other codes on one mesh, to their last decimal -----------------------------------


@pytest.mark.parametrize("element, figures", [
    ("Q1/P0", {0.02: 3.6921}),
    ("Q2/P1disc", {0.02: 3.8575, 0.07: 22.9368}),
    ("Q2/Q1", {0.02: 4.0796}),
])
def test_four_cells_give_the_figures_of_other_codes(element, figures):
    path = spar(4, element, plain=True).inflate(upper=list(figures))
    found = {s.load["upper_MPa"]: s.measures["span_angle_deg"] for s in path if s.requested}
    assert {p: round(a, 4) for p, a in found.items()} == figures


@pytest.mark.parametrize("element, figures", [
    ("Q1/P0", [18.5451, 41.5209]), ("Q2/P1disc", [19.2449, 44.6434])])
def test_twenty_cells_give_the_figures_of_other_codes_and_reach_40_kpa(element, figures):
    path = inflated(spar(20, element, plain=True), upper=[0.02, 0.04])
    assert [round(angle, 4) for angle in angles(path)] == figures
    assert path[0].newton_iterations <= 8


# -- converged angles ----------------------------------------------------------------------------


@pytest.mark.parametrize("n_cells, converged, tolerance", [(2, 1.951, 0.015), (4, 3.99, 0.02)])
def test_standard_fidelity_is_near_the_converged_angle_in_one_step(n_cells, converged, tolerance):
    path = inflated(spar(n_cells, fidelity="standard"), upper=0.02)
    assert len(path) == 1 and path[0].newton_iterations <= 8
    assert angles(path)[0] == pytest.approx(converged, rel=tolerance)


def test_draft_fidelity_is_within_a_tenth_of_the_converged_angle():
    assert angles(inflated(spar(4, fidelity="draft"), upper=0.02)) == pytest.approx(
        [3.99], rel=0.1)


# -- material and loads --------------------------------------------------------------------------


def test_nearly_infinite_bulk_modulus_costs_two_iterations_at_most():
    mu = DRAGON_SKIN_30.shear_modulus
    paths = [inflated(spar(2, "Q2/P1disc", Yeoh(DRAGON_SKIN_30.coefficients, bulk), plain=True),
                      upper=0.02) for bulk in (1e3 * mu, 1e8 * mu)]
    default, stiff = (path[0] for path in paths)
    assert abs(stiff.newton_iterations - default.newton_iterations) <= 2
    assert angles(paths[1]) == pytest.approx(angles(paths[0]), rel=1e-2)
    assert angles(paths[1])[0] != angles(paths[0])[0]


@pytest.mark.parametrize("element", ["Q1/P0", "Q2 reduced"])
def test_ten_times_modulus_and_pressure_give_the_same_shape(element):
    stiff = Yeoh(tuple(10 * c for c in DRAGON_SKIN_30.coefficients))
    soft = inflated(spar(2, element, plain=True), upper=0.02)[-1]
    hard = inflated(spar(2, element, stiff, plain=True), upper=0.2)[-1]
    for name, value in soft.measures.items():
        assert hard.measures[name] == pytest.approx(value, rel=1e-8)
    assert hard.energy_Nmm == pytest.approx(10 * soft.energy_Nmm, rel=1e-8)


@pytest.mark.quick
def test_lower_chambers_mirror_the_upper_ones():
    up = inflated(spar(2, "Q1/P0", plain=True), upper=0.02)[-1]
    down = inflated(spar(2, "Q1/P0", plain=True), lower=0.02)[-1]
    assert up.measures["span_angle_deg"] > 1.0
    for name, value in up.measures.items():
        assert down.measures[name] == pytest.approx(-value, rel=1e-9)
    assert down.energy_Nmm == pytest.approx(up.energy_Nmm, rel=1e-9)


@pytest.mark.quick
def test_equal_pressure_in_both_rows_does_not_bend():
    state = inflated(spar(2, "Q1/P0", plain=True), upper=0.02, lower=0.02)[-1]
    assert state.measures["span_angle_deg"] == pytest.approx(0.0, abs=1e-9)
    assert state.energy_Nmm > 0.0


@pytest.mark.quick
def test_full_model_equals_half_model():
    half = inflated(spar(2, "Q1/P0", plain=True), upper=0.02)[-1]
    full = inflated(spar(2, "Q1/P0", plain=True, half=False), upper=0.02)[-1]
    for name, value in half.measures.items():
        assert full.measures[name] == pytest.approx(value, rel=1e-8)
    assert full.energy_Nmm == pytest.approx(half.energy_Nmm, rel=1e-8)
    assert full.external_work_Nmm == pytest.approx(half.external_work_Nmm, rel=1e-8)


@pytest.mark.quick
def test_any_split_of_the_pressure_ends_in_the_same_state():
    one = inflated(spar(2, "Q1/P0", plain=True), upper=0.02)[-1]
    many = inflated(spar(2, "Q1/P0", plain=True), upper=[0.003, 0.011, 0.012, 0.02])[-1]
    back = inflated(spar(2, "Q1/P0", plain=True), upper=[0.04, 0.02])[-1]
    for state in (many, back):
        for name, value in one.measures.items():
            assert state.measures[name] == pytest.approx(value, rel=1e-7)


@pytest.mark.quick
def test_external_work_is_the_stored_energy_to_the_fourth_order_of_the_steps():
    errors = []
    for n in (1, 2, 4):
        last = inflated(spar(2, "Q1/P0", plain=True), upper=np.linspace(0, 0.04, n + 1)[1:])[-1]
        errors.append(abs(last.external_work_Nmm / last.energy_Nmm - 1.0))
    assert errors[0] < 2e-3
    assert np.log2(np.array(errors[:-1]) / errors[1:]) == pytest.approx(4.0, abs=0.1)


@pytest.mark.quick
def test_stable_states_have_no_surplus_negative_pivots():
    for element in ("Q1/P0", "Q1 reduced"):
        path = inflated(spar(2, element, plain=True), upper=[0.02, 0.04])
        assert [state.negative_pivots for state in path] == [0, 0]


def test_beyond_the_ballooning_pressure_load_control_stops_and_says_where():
    path = spar(4, "Q1/P0", plain=True).inflate(upper=[0.05, 0.2])
    assert not path.converged
    assert path.reason.startswith("stopped after upper = 0.0")
    reached = path[-1].load["upper_MPa"]
    assert 0.07 < reached < 0.1
    assert f"upper = {reached:.6g} MPa" in path.reason


@pytest.mark.quick
def test_no_pressure_leaves_the_spar_straight_and_stable():
    state = inflated(spar(2, "Q1/P0", plain=True), upper=0.0)[-1]
    assert (state.newton_iterations, state.negative_pivots) == (0, 0)
    assert state.measures["span_angle_deg"] == pytest.approx(0.0, abs=1e-12)
    assert state.energy_Nmm == 0.0


# -- bad input -----------------------------------------------------------------------------------


@pytest.mark.quick
@pytest.mark.parametrize("load, text", [
    ({"upper": float("nan")}, r"^upper = nan MPa: must be finite"),
    ({"upper": "20 kPa"}, r"^upper = '20 kPa': must be a number"),
    ({"upper": []}, r"^upper = \[\] MPa: must be finite"),
    ({"upper": [0.1, 0.2], "lower": [0.1, 0.2, 0.3]}, "^loads have lengths upper 2, lower 3"),
])
def test_pressures_that_are_none_are_refused_in_one_sentence(load, text):
    with pytest.raises(InputError, match=text):
        spar(1, "Q1/P0", plain=True).inflate(**load)


@pytest.mark.quick
def test_unknown_fidelity_and_element_are_refused_in_one_sentence():
    with pytest.raises(InputError, match=r"^fidelity = 'best': must be one of instant, cell, "):
        Spar(SMALL, fidelity="best", comm=MPI.COMM_SELF)
    with pytest.raises(InputError, match=r"^element = 'Q3': must be one of Q2/P1disc, "):
        Spar(SMALL, element="Q3", comm=MPI.COMM_SELF)


@pytest.mark.quick
def test_an_element_for_thin_parts_is_refused_in_one_sentence():
    with pytest.raises(InputError, match="^element = 'Q1 enhanced': must be of a body wi"):
        spar(1, "Q1 enhanced", plain=True)
