"""How angles answer to Figure 6's factors, judged by angles made up, and what a bulge is."""

from dataclasses import dataclass
from types import SimpleNamespace

import numpy as np
import pytest

from morphing_wing.bulge import Bulge
from morphing_wing.figure6.claims import claims
from morphing_wing.figure6.points import PANELS, value_of
from morphing_wing.figure6.sensitivities import sensitivities
from morphing_wing.geometry.spar import SparGeometry

pytestmark = pytest.mark.quick

SPAR, RIB = PANELS["spar"], PANELS["rib"]


def part_of(panel, angle):
    """Return a panel's points, their angle a function of the three factors' values."""
    points = panel.points
    values = {name: points[name].map(value_of) for name in panel.levels}
    return points.assign(**{panel.table.angle: angle(values)})


def facts_of(part, panel):
    return {fact["factor"]: fact for fact in sensitivities(part, panel)}


def test_sensitivities_of_a_product_of_powers_are_its_exponents():
    part = part_of(SPAR, lambda x: 3.0 * x["l_s1"] ** 2 / x["h_t"] + 0.0 * x["l_c"])
    facts = facts_of(part, SPAR)
    assert facts["l_s1"]["power"] == pytest.approx(2.0)
    assert facts["l_s1"]["slope"] == pytest.approx(2 * 3.0 * 2.2 / 1.2)  # of a parabola exactly
    assert facts["l_s1"]["elasticity"] == pytest.approx(2.0)
    assert facts["l_s1"]["table_range_deg"] == pytest.approx(3.0 / 1.2 * (2.4**2 - 2.0**2))
    assert facts["l_s1"]["range_deg"] == pytest.approx(3.0 / 1.2 * (2.6**2 - 1.6**2))
    assert facts["l_s1"]["first_slope"] == pytest.approx(3.0 / 1.2 * (1.6 + 1.8))
    assert facts["h_t"]["power"] == pytest.approx(-1.0)
    assert [facts[name]["trend"] for name in SPAR.levels] == ["rises", "turns", "falls"]
    assert (facts["l_c"]["range_deg"], facts["l_c"]["off_straight"]) == (0.0, 0.0)


def test_a_parabola_is_off_its_chord_by_a_quarter_of_its_rise_in_the_middle():
    part = part_of(RIB, lambda x: 10.0 + (x["alpha"] - 60.0) ** 2)
    # (x - 60)^2 against 50 (x - 60): at 80 and 90 it is 600 below, of 2500.
    assert facts_of(part, RIB)["alpha"]["off_straight"] == pytest.approx(600.0 / 2500.0)


def test_slopes_at_unequal_distances_are_those_of_the_parabola():
    part = part_of(RIB, lambda x: 1.0 + x["D_cs/l_rs"] ** 2)
    middle = 1.5 / 6.5
    assert facts_of(part, RIB)["D_cs/l_rs"]["slope"] == pytest.approx(2.0 * middle)


def test_of_missing_points_nothing_is_made_up():
    part = part_of(SPAR, lambda x: x["h_t"])
    part.loc[part["h_t"] == "1.0", "span_angle_deg"] = np.nan
    fact = facts_of(part, SPAR)["h_t"]
    assert fact["points"] == 5 and np.isnan(fact["table_range_deg"])
    assert fact["range_deg"] == pytest.approx(1.0)
    assert claims(part, SPAR) == []


def test_claims_are_refuted_by_figures_that_contradict_them():
    def holds(panel, angle, **columns):
        return [claim["holds"] for claim in claims(part_of(panel, angle).assign(**columns), panel)]

    def thin(x):
        return 20.0 / x["h_t"]

    bulges = part_of(SPAR, thin)["span_angle_deg"]
    assert holds(SPAR, thin, bulge_mm=bulges**2) == [True, True, True]
    assert holds(SPAR, thin, bulge_mm=bulges**0.5) == [True, True, False]
    assert holds(SPAR, lambda x: 20.0 * x["h_t"]) == [True, False]
    assert holds(SPAR, lambda x: x["l_s1"] - 0.2 * x["h_t"]) == [False, False]
    assert holds(RIB, lambda x: x["D_cs/l_rs"] + 1e-6 / x["T_rs/l_cs"]) == [False, True]
    assert holds(RIB, lambda x: 9.0 - x["T_rs/l_cs"] - x["alpha"] / 100) == [True, False]


@dataclass(eq=False)
class Geometry:
    """What a bulge asks of a scene."""

    geometry: SparGeometry
    fidelity: str


@pytest.mark.parametrize("fidelity, turn", [("draft", 12.0), ("cell", 1.5)])
def test_a_wall_that_only_turns_has_no_bulge_and_one_that_stands_out_has_it(fidelity, turn):
    spar = SparGeometry.validation(n_cells=4)
    scene = Geometry(spar, fidelity)
    # A cell from its wall's middle to its chamber's; a spar's ends, and three places a chamber.
    z = np.array([0.0, 1.1, 2.5]) if fidelity == "cell" else np.concatenate([[0.0], *(
        np.array([2.2, 3.6, 5.0]) + 5.0 * i for i in range(4)), [22.2]])
    points = np.column_stack([0.0 * z, 0.0 * z + spar.height / 2, z])
    angle = np.radians(turn)
    out = 0.1 * (np.isclose(z, 2.5) if fidelity == "cell" else np.isclose(z, 8.6))
    up, along = points[:, 1] + out, z
    moved = np.column_stack([0.0 * z, np.cos(angle) * up - np.sin(angle) * along,
                             np.sin(angle) * up + np.cos(angle) * along])
    # Of a cell the middle of its chamber turns by half of its angle.
    state = SimpleNamespace(measures={"span_angle_deg": 2 * 4 * turn})
    found = Bulge(scene)._largest(points, moved - points, state)
    assert found == pytest.approx(0.1, abs=1e-12)
