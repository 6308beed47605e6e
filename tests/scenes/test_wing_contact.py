"""A wing whose skin passes through itself or a rib says so."""

import numpy as np
import pytest

from tests.scenes.small_wing import NO_RIBS, actuated, move_elastomer, wing


def test_contact_is_marked_from_the_tension_on_at_which_the_skin_meets_a_rib():
    scene = wing(n_cells=4, skin_thickness=0.3, rib_positions=(0.75,))
    path = actuated(scene, cable=[0.1, 0.15, 0.3])
    found = {s.load["cable_N"]: s.measures for s in path if s.requested}
    assert [found[t]["contact"] for t in (0.1, 0.15, 0.3)] == [0.0, 0.0, 1.0]
    assert all((m["gap_mm"] < 0.0) == (m["contact"] == 1.0) for m in found.values())


@pytest.mark.quick
@pytest.mark.parametrize("changes", [{}, NO_RIBS], ids=["on a rib", "on the other side"])
@pytest.mark.parametrize("part, contact", [(0.0, 0.0), (0.5, 0.0), (1.1, 1.0)])
def test_upper_skin_pushed_through_is_contact(changes, part, contact):
    scene = wing(**changes)
    # Half-way along the pocket, by a part of the way down to the lower skin or the rib's top.
    x_dent = 0.5 * (scene.geometry.spar_end + scene.geometry.pocket_end)
    inner = float(scene.geometry.section.half_thickness(x_dent)) - 1.0
    rib = scene.geometry.rib
    way = 2.0 * inner if rib is None else inner - 0.5 * (rib.height + rib.shaft_width)

    def dent(points):
        x, y, _ = points.T
        down = np.where((x > 78.0) & (y > 1e-6), np.exp(-((x - x_dent) / 15.0) ** 2), 0.0)
        return -part * way * np.outer(down, [0.0, 1.0, 0.0])

    move_elastomer(scene, dent)
    assert scene._measures()["contact"] == contact
