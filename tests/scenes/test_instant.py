"""The paper's formulas as scenes: its own figures, and what formulas cannot do."""

from dataclasses import replace

import numpy as np
import pytest
from scipy.integrate import trapezoid

from morphing_wing.analytic_rib import rib_compliance
from morphing_wing.analytic_spar import SparFormula
from morphing_wing.errors import InputError
from morphing_wing.geometry.rib import RibGeometry
from morphing_wing.geometry.spar import SparGeometry, SparMeshing
from morphing_wing.instant import InstantRib, InstantSpar
from morphing_wing.materials import DRAGON_SKIN_30, Elastic, Yeoh
from morphing_wing.modes import modes
from morphing_wing.path import load_table
from morphing_wing.rib import Rib
from morphing_wing.spar import Spar

pytestmark = pytest.mark.quick

VALIDATION = SparGeometry.validation()
# Table 2 of the paper at 20 kPa: l_s1, l_c, h_t in mm, printed angle in degrees.
TABLE_2 = [
    (2.0, 2.0, 1.0, 15.13), (2.0, 2.4, 1.2, 13.64), (2.0, 2.8, 1.4, 12.26),
    (2.2, 2.0, 1.2, 14.78), (2.2, 2.4, 1.4, 13.41), (2.2, 2.8, 1.0, 17.07),
    (2.4, 2.0, 1.4, 14.32), (2.4, 2.4, 1.0, 18.22), (2.4, 2.8, 1.2, 16.39),
]


def instant(**options):
    return Spar(VALIDATION, fidelity="instant", **options)


@pytest.mark.parametrize("wall, cavity, top, printed", TABLE_2)
def test_table_2_of_the_paper(wall, cavity, top, printed):
    geometry = replace(VALIDATION, wall_length=wall, cavity_length=cavity, top_thickness=top)
    assert SparFormula(geometry, DRAGON_SKIN_30).angle(0.02) == pytest.approx(printed, rel=0.0065)


def test_angles_over_pressure():
    path = instant().inflate(upper=[0.005, 0.01, 0.015, 0.02, 0.025, 0.03])
    assert type(path.scene) is InstantSpar and path.converged
    np.testing.assert_allclose(
        path.table()["span_angle_deg"], [4.080, 8.266, 12.561, 16.968, 21.491, 26.133], atol=6e-4)


def test_energy_is_the_work_of_the_pressure():
    pressures = np.linspace(0.0, 0.03, 301)
    path = instant().inflate(upper=pressures)
    turns = np.radians(path.table()["span_angle_deg"])
    lever = VALIDATION.top_thickness + VALIDATION.cavity_height + VALIDATION.middle_thickness / 2
    work = 1.5 * lever**2 * VALIDATION.width * trapezoid(pressures, turns)  # Eq 10
    assert path[-1].energy_Nmm == pytest.approx(work, rel=1e-4)


def test_lower_row_bends_upwards_and_lines_are_half_of_angles():
    up, down = instant().inflate(lower=0.01), instant().inflate(upper=0.01)
    assert up[0].measures["span_angle_deg"] == -down[0].measures["span_angle_deg"]
    line = down[0].measures["span_line_deg"]
    assert line == pytest.approx(0.5 * down[0].measures["span_angle_deg"], rel=0.01)


def test_past_the_formulas_limit_point_it_stops_and_says_where():
    soft = Yeoh((0.117, -0.005))
    path = Spar(VALIDATION, soft, fidelity="instant").inflate(upper=[0.02, 1.0])
    assert len(path) == 1 and not path.converged
    largest = SparFormula(VALIDATION, soft).largest_pressure
    assert f"goes to {1000 * largest:.4g} kPa at most, 1000 kPa were asked for" in path.reason


@pytest.mark.parametrize("loads", [{"upper": 0.01, "lower": 0.01}, {"upper": -0.01}])
def test_loads_that_the_formula_does_not_know_are_refused(loads):
    with pytest.raises(InputError, match="MPa: must be 0 MPa or more, and in one row only"):
        instant().inflate(**loads)


@pytest.mark.parametrize("option, value", [
    ("half", False), ("contact", True), ("filled", "shared"), ("meshing", SparMeshing.plain()),
    ("element", "Q1/P0")])
def test_options_of_other_fidelities_are_refused(option, value):
    with pytest.raises(InputError, match=f"^{option} = .*: must be .* fidelity is .instant.$"):
        instant(**{option: value})


def test_what_auto_took_is_named_where_it_cannot_serve():
    scene = Rib(RibGeometry.validation(), fidelity="auto", tolerance=0.5)
    with pytest.raises(InputError, match='is "instant", which "auto" took$'):
        scene.pull(0.1)


def test_there_is_no_field_to_draw_and_no_mode(tmp_path):
    scene = instant()
    path = scene.inflate(upper=0.01)
    with pytest.raises(InputError, match="a formula has none"):
        path[0].render(tmp_path / "spar.png")
    with pytest.raises(InputError, match="a formula without a field"):
        modes(scene, 1)
    with pytest.raises(InputError, match="a formula without a field"):
        scene.system  # noqa: B018
    with pytest.raises(InputError, match="leaves nothing to resume"):
        scene.inflate(upper=0.01, resume=tmp_path)
    path.save(tmp_path / "run")
    assert len(load_table(tmp_path / "run")) == 1
    assert not (tmp_path / "run" / "fields").exists()


def test_mended_rib_formula():
    resin = Elastic(2500.0, 0.35)
    assert rib_compliance(RibGeometry.validation("square"), resin) == pytest.approx(1.94, abs=5e-3)
    # With the moments that the energies ask for.
    softer = rib_compliance(RibGeometry.validation("square"), resin, consistent=True)
    assert softer == pytest.approx(2.042, abs=1e-3)


def test_rib_bends_as_the_formula_says_and_takes_no_cable():
    geometry = RibGeometry.validation()
    rib = Rib(geometry, fidelity="instant")
    path = rib.bend(torque=[0.0, 5.0])
    assert type(rib) is InstantRib
    assert path[-1].measures["chord_angle_deg"] == pytest.approx(
        5.0 * rib_compliance(geometry, rib.material))
    with pytest.raises(InputError, match="cable = 0.1 N: must be a torque"):
        rib.pull(0.1)
