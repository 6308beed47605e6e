r"""A strip pulled along its glue, from a rigid foot: Volkersen's shear lag.

With one side rigid, E t u'' = k_t u along the glued length l (Volkersen, Luftfahrtforschung 15
(1938) 41-47): a pull P a width at its end gives

.. math:: u(x) = \frac{P \cosh \beta x}{E t \beta \sinh \beta l}, \qquad
    \beta^2 = \frac{k_t}{E t}, \qquad \tau = k_t u.
"""

import numpy as np
import pytest

from morphing_wing.geometry.hexmesh import breakpoints, swept_blocks, uniform
from morphing_wing.materials import Adhesive, Yeoh
from tests.verification.moved import Moved, glued

THICKNESS, WIDTH, YOUNG = 0.5, 1.0, 800.0
STRIP = Yeoh((200.0,), bulk=800.0 / 3.0)  # Poisson's ratio is nothing
STRENGTH, SHEAR_STRENGTH, STIFFNESS = 0.4, 0.2, 8.0
SHEAR_STIFFNESS = STIFFNESS * (SHEAR_STRENGTH / STRENGTH) ** 2
ONSET = STRENGTH**2 / (2.0 * STIFFNESS)
BARE = 2.0
BETA = np.sqrt(SHEAR_STIFFNESS / (YOUNG * THICKNESS))


def strip(length, cells, toughness):
    """The strip, kept from bending as half of a double lap is, bare for ``BARE`` mm at its end."""
    def faces(midpoints, normals):
        return {"glued": normals[:, 1] < 0, "middle": normals[:, 1] > 0,
                "sides": normals[:, 2] != 0, "end": normals[:, 0] > 0}

    x, _ = breakpoints((length, uniform(cells)), (BARE, uniform(2)))
    lines = x, THICKNESS * uniform(1), WIDTH * uniform(1)
    grid = swept_blocks(lines, np.ones((cells + 2, 1, 1), int), {1: "body"}, faces=faces)
    law = Adhesive(STIFFNESS, STRENGTH, toughness, SHEAR_STRENGTH)
    box = ((-1.0, -1.0, -1.0), (length, 1.0, 2.0))
    return Moved(grid, STRIP, "Q1 enhanced", glued("glued", law, box),
                 symmetry={"middle": 1, "sides": 2, "end": 0})


@pytest.fixture(scope="module")
def long_lap():
    scene = strip(40.0, 40, 8.0 * ONSET)
    scene.move("end", 0, 0.01)
    scene.solve()
    assert scene.part.damage().max() == 0.0
    return scene


def test_stiffness_of_a_long_lap_is_volkersens(long_lap):
    lap = YOUNG * THICKNESS * BETA * np.tanh(BETA * 40.0) * WIDTH
    exact = 1.0 / (1.0 / lap + BARE / (YOUNG * THICKNESS * WIDTH))
    assert BETA * 40.0 > 2.0
    assert long_lap.reaction("end", 0) / 0.01 == pytest.approx(exact, rel=0.02)


def test_shear_along_a_long_lap_is_volkersens(long_lap):
    nodes = long_lap.part.surface.nodes
    x = nodes.reference[:, 0]
    inside = x < 40.0 + 1e-9
    shear = SHEAR_STIFFNESS * nodes.displacements()[inside, 0]
    pull = long_lap.reaction("end", 0) / WIDTH
    exact = pull * BETA * np.cosh(BETA * x[inside]) / np.sinh(BETA * 40.0)
    assert exact.max() > 3.0 * exact.min()
    np.testing.assert_allclose(shear, exact, rtol=0.02)


def test_a_short_lap_fails_at_its_area_times_the_shear_strength():
    length = 2.0
    scene = strip(length, 4, 8.0 * ONSET)
    assert BETA * length < 0.2
    reach = SHEAR_STRENGTH / SHEAR_STIFFNESS
    pulls = []
    for end in reach * np.concatenate([np.linspace(0.9, 1.1, 21), np.linspace(1.5, 10.0, 10)]):
        scene.move("end", 0, end)
        scene.solve()
        pulls.append(scene.reaction("end", 0))
    area = length * WIDTH
    assert max(pulls) == pytest.approx(area * SHEAR_STRENGTH, rel=0.02)
    assert abs(pulls[-1]) < 1e-8 * max(pulls)
    assert scene.part.dissipated() == pytest.approx(8.0 * ONSET * area, rel=1e-12)
