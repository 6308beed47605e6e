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
