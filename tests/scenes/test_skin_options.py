"""How the skin may be built changes how the trailing edge gives way."""

import pytest

from tests.scenes.small_wing import actuated, wing


def chord_angle(cable=0.05, **changes):
    """Rotation of the trailing edge in degrees under a cable."""
    return actuated(wing(**changes), cable=cable)[-1].measures["chord_angle_deg"]


def test_a_skin_that_is_free_at_the_root_gives_way_to_the_cables():
    assert chord_angle(skin_root="free") > 50.0 * abs(chord_angle()) > 0.0


def test_a_tip_wall_holds_the_free_end_of_the_trailing_edge():
    free = {"skin_root": "free"}
    assert 0.0 < chord_angle(**free, tip_wall=True) < 0.9 * chord_angle(**free)


def test_a_skin_over_the_spar_does_as_much_as_a_top_wall_that_is_thicker_by_it():
    both = [actuated(wing(**changes), upper=0.01)[-1].measures["span_angle_deg"]
            for changes in ({"skin_over_spar": True}, {"top_thickness": 3.0})]
    assert both[0] == pytest.approx(both[1], rel=1e-9)


def test_cables_do_more_work_on_a_slit_skin():
    # Much more on one cut behind the spar; the ribs' tails still hold its trailing edges together.
    work = {slit: actuated(wing(skin_root="free", skin_slit=slit), cable=0.01)[-1]
            for slit in ("none", "lower", "trailing_edge")}
    none, lower, edge = (state.external_work_Nmm for state in work.values())
    assert lower > 1.3 * none and 1.2 * none > edge > none > 0.0
