"""A spar filled with volumes: the same equilibria as by pressure, and on past the limit point."""

import numpy as np
import pytest
from mpi4py import MPI

from morphing_wing.errors import InputError
from morphing_wing.geometry.spar import SparGeometry, SparMeshing
from morphing_wing.spar import Spar

ROW = 2.8 * 6.0 * 40.0  # mm^3 of a chamber at rest


def spar(n_cells=2, filled="shared", comm=MPI.COMM_SELF, element="Q1/P0", **options):
    return Spar(SparGeometry.validation(n_cells), element=element, meshing=SparMeshing.plain(),
                filled=filled, comm=comm, **options)


def led(scene, **volumes):
    path = scene.fill(**volumes)
    assert path.converged, path.reason
    return path


@pytest.mark.quick
@pytest.mark.parametrize("element", ["Q1/P0", "Q1 reduced"])
def test_the_pressure_found_inflates_to_the_same_state(element):
    filled = led(spar(element=element), upper=ROW)[-1]
    pressure = filled.measures["upper_MPa"]
    assert 0.02 < pressure < 0.08
    by_pressure = spar(filled=None, element=element).inflate(upper=pressure)[-1]
    for name, value in by_pressure.measures.items():
        assert filled.measures[name] == pytest.approx(value, rel=1e-7), name
    assert filled.energy_Nmm == pytest.approx(by_pressure.energy_Nmm, rel=1e-7)


@pytest.mark.quick
@pytest.mark.parametrize("filled", ["shared", "separate"])
def test_work_of_filling_is_the_stored_energy_to_the_fourth_order_of_the_steps(filled):
    lasts = [led(spar(filled=filled), upper=np.linspace(0.0, ROW, n + 1)[1:])[-1]
             for n in (1, 2, 4)]
    errors = np.array([abs(s.external_work_Nmm / s.energy_Nmm - 1.0) for s in lasts])
    assert errors[0] < 5e-3
    assert np.log2(errors[:-1] / errors[1:]) == pytest.approx(4.0, abs=0.7)


def test_volume_leads_past_the_limit_point_on_stable_states():
    path = led(spar(4), upper=4 * ROW * np.array([0.5, 1.0, 1.5, 2.0, 2.5, 3.0]))
    table = path.table()
    pressures = table["pressure_MPa"].to_numpy()
    peak = pressures.argmax()
    assert 0 < peak < len(path) - 1 and 0.09 < pressures[peak] < 0.096
    assert (np.diff(pressures[: peak + 1]) > 0).all() and (np.diff(pressures[peak:]) < 0).all()
    assert (table["negative_pivots"] == 0).all()
    assert (np.diff(table["upper_largest_share"][peak:]) > 0.01).all()
    assert table["external_work_Nmm"].to_numpy() == pytest.approx(
        table["energy_Nmm"].to_numpy(), rel=2e-3)


def test_a_chamber_that_balloons_alone_is_named():
    path = spar(4).fill(upper=4 * ROW * np.array([2.0, 3.0, 5.0]))
    assert not path.converged
    assert path.reason.startswith("stopped after upper = ")
    assert "chamber 4 of the upper row balloons alone, it took 1." in path.reason


@pytest.mark.quick
def test_half_model_and_whole_take_the_same_pressure():
    half, whole = (led(spar(half=half), upper=ROW)[-1] for half in (True, False))
    for name, value in half.measures.items():
        assert whole.measures[name] == pytest.approx(value, rel=1e-7), name
    assert whole.external_work_Nmm == pytest.approx(half.external_work_Nmm, rel=1e-7)


@pytest.mark.quick
def test_chambers_filled_apart_have_pressures_of_their_own():
    state = led(spar(3, "separate"), upper=3 * ROW)[-1].measures
    lowest, mean, highest = (state[f"upper_{which}MPa"] for which in ("lowest_", "", "highest_"))
    assert lowest < 0.99 * mean and 1.01 * mean < highest
    alone, shared = (led(spar(1, filled), upper=ROW)[-1] for filled in ("separate", "shared"))
    assert alone.measures["upper_MPa"] == pytest.approx(shared.measures["upper_MPa"], rel=1e-8)


@pytest.mark.quick
def test_both_rows_filled_alike_do_not_bend_and_an_open_row_has_no_pressure():
    state = led(spar(), upper=ROW, lower=ROW)[-1].measures
    assert state["span_angle_deg"] == pytest.approx(0.0, abs=1e-8)
    assert state["upper_MPa"] == pytest.approx(state["lower_MPa"], rel=1e-8)
    up, down = led(spar(), upper=ROW)[-1].measures, led(spar(), lower=ROW)[-1].measures
    assert "lower_MPa" not in up
    assert down["span_angle_deg"] == pytest.approx(-up["span_angle_deg"], rel=1e-8)


@pytest.mark.quick
def test_it_resumes_as_it_would_have_gone_on(tmp_path):
    volumes = ROW * np.array([1.0, 2.0])
    whole = led(spar(), upper=volumes)[-1]
    led(spar(), upper=volumes[:1], restart=tmp_path)
    resumed = led(spar(), upper=volumes, resume=tmp_path)[-1]
    for name, value in whole.measures.items():
        assert resumed.measures[name] == pytest.approx(value, rel=1e-10), name
    assert resumed.external_work_Nmm == pytest.approx(whole.external_work_Nmm, rel=1e-8)


@pytest.mark.quick
@pytest.mark.parametrize("call, sentence", [
    (lambda: spar(filled="both"), "filled = 'both': must be None or one of shared, separate"),
    (lambda: spar(filled=None).fill(upper=1.0), "filled = None: must be one of shared, separate"),
    (lambda: spar().inflate(upper=0.01), "filled = 'shared': must be None where pressures"),
    (lambda: spar().fill(upper=float("nan")), "upper = nan mm^3: must be finite"),
])
def test_what_cannot_be_is_refused(call, sentence):
    with pytest.raises(InputError) as refused:
        call()
    assert str(refused.value).startswith(sentence)


def test_what_was_open_or_filled_at_first_remains_so():
    scene = spar()
    led(scene, upper=[0.0, ROW])
    led(scene, upper=0.5 * ROW)
    for other in ({"lower": 100.0}, {"upper": ROW, "lower": 0.0}):
        with pytest.raises(InputError, match="rows filled = .*: must be upper as in the first"):
            scene.fill(**other)
    sealed = led(spar(), upper=ROW, lower=0.0)[-1].measures
    assert sealed["lower_MPa"] != 0.0
