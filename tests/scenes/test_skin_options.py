"""How the skin may be built changes how the trailing edge gives way."""

from tests.scenes.small_wing import actuated, wing


def chord_angle(cable=0.05, **changes):
    """Rotation of the trailing edge in degrees under a cable."""
    return actuated(wing(**changes), cable=cable)[-1].measures["chord_angle_deg"]


def test_a_skin_that_is_free_at_the_root_gives_way_to_the_cables():
    assert chord_angle(skin_root="free") > 50.0 * abs(chord_angle()) > 0.0


def test_a_tip_wall_holds_the_free_end_of_the_trailing_edge():
    free = {"skin_root": "free"}
    assert 0.0 < chord_angle(**free, tip_wall=True) < 0.9 * chord_angle(**free)
