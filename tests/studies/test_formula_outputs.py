"""What formulas tell of many changes at once is what each case tells alone."""

import numpy as np
import pytest

from morphing_wing.studies.case import Case, run_case
from morphing_wing.studies.formula_outputs import formula_outputs

pytestmark = pytest.mark.quick

SPAR = Case.of("spar-validation", {"fidelity": "instant", "loads.upper": "20 kPa"})
RIB = Case.of("rib-validation", {"fidelity": "instant", "loads.torque": "5 N mm"})
SPAR_KEYS = {
    "geometry.cavity_length": (1.5, 4.0), "geometry.wall_length": (1.0, 3.0),
    "geometry.top_thickness": (0.8, 2.0), "geometry.cavity_height": (4.0, 7.0),
    "geometry.middle_thickness": (1.0, 4.0), "geometry.side_thickness": (0.8, 2.0),
    "geometry.cavity_width": (30.0, 50.0), "loads.upper": (0.0, 0.03),
    "elastomer.density": (1000.0, 1200.0)}
RIB_KEYS = {
    "geometry.shaft_length": (5.0, 9.0), "geometry.shaft_thickness": (0.8, 1.6),
    "geometry.pivot_diameter": (1.0, 2.0), "geometry.pivot_length": (4.0, 8.0),
    "geometry.crossing_angle": (60.0, 120.0), "resin.E": (2370.0, 2640.0),
    "resin.nu": (0.3, 0.4), "loads.torque": (-5.0, 10.0)}


def some(keys, n):
    random = np.random.default_rng(2)
    return {key: random.uniform(*ends, n) for key, ends in keys.items()}


@pytest.mark.parametrize("case, keys", [
    (SPAR, SPAR_KEYS), (RIB, RIB_KEYS), (RIB.changed({"geometry.section": "square"}), RIB_KEYS),
    (SPAR, {"elastomer.coefficients.0": (0.1, 0.2), "elastomer.coefficients.1": (-0.001, 0.0)}),
    (SPAR, {"geometry.wall_length": (1.0, 3.0)}),
], ids=["spar", "rib flush", "rib square", "elastomer", "one length"])
def test_arrays_tell_what_each_case_tells(case, keys):
    values = some(keys, 4)
    together = formula_outputs(case, values)
    assert {"mass_g", "length_mm", "height_mm", "energy_Nmm", "external_work_Nmm"} <= set(together)
    for i in range(4):
        alone = run_case(case.changed({key: v[i] for key, v in values.items()}), tuple(together))
        assert alone["refused"] == alone["stopped"] == ""
        for name, array in together.items():
            assert array[i] == pytest.approx(alone[name], rel=1e-12), name


def test_without_changes_there_is_one_set_of_figures():
    found = formula_outputs(SPAR, {})
    assert found["span_angle_deg"] == pytest.approx(16.968, abs=5e-4)


def test_what_cannot_be_built_or_has_no_equilibrium_is_not_a_number():
    wide = formula_outputs(RIB, {"geometry.pivot_diameter": np.array([1.5, 3.5, -1.0])})
    assert list(np.isnan(wide["chord_angle_deg"])) == [False, True, True]
    assert run_case(RIB.changed({"geometry.pivot_diameter": 3.5}))["refused"]
    burst = formula_outputs(SPAR, {"loads.upper": np.array([0.02, 5.0]),
                                   "geometry.wall_length": np.array([0.0, 2.0])})
    assert np.isnan(burst["span_angle_deg"]).all()


@pytest.mark.parametrize("case, key", [
    (Case.of("wing-pressure"), "geometry.chord"), (SPAR, "loads.lower"),
    (SPAR.changed({"loads.lower": "0 kPa"}), "geometry.wall_length"), (RIB, "geometry.bosses"),
    (RIB.changed({"geometry.layers": 2}), "geometry.shaft_length"),
])
def test_what_no_formula_knows_has_no_figures(case, key):
    assert formula_outputs(case, {key: np.array([1.0])}) == {}
