r"""A slender beam peeled off a rigid foot, as half of a double cantilever beam.

A beam on an elastic foundation (Kanninen, Int. J. Fracture 9 (1973) 83-92) of k = ``stiffness`` a
width, with lambda^4 = k/(4 E I), opens at its end, ``a`` beyond the glue, and in the glue by

.. math:: \delta = \frac{P}{3 E I} \Big( A^3 + \frac{1}{2 \lambda^3} \Big), \qquad
    v(x) = \frac{P e^{-\lambda x}}{2 E I \lambda^3}
    (\cos \lambda x + \lambda a (\cos \lambda x - \sin \lambda x)), \qquad A = a + 1/\lambda,

and releases P^2 A^2/(2 E I) per length of crack, which is the toughness once it grows.
"""

import numpy as np
import pytest

from morphing_wing.geometry.hexmesh import breakpoints, swept_blocks, uniform
from morphing_wing.materials import Adhesive, Yeoh
from tests.verification.moved import Moved, glued

HEIGHT, WIDTH, FREE, GLUED = 1.0, 1.0, 30.0, 30.0
BEAM = Yeoh((200.0,), bulk=800.0 / 3.0)  # Poisson's ratio is nothing
YOUNG, INERTIA = 800.0, WIDTH * HEIGHT**3 / 12.0
DECAY = 1.0 / 2.5  # lambda in 1/mm
STIFFNESS = 4.0 * YOUNG * INERTIA * DECAY**4 / WIDTH
STRENGTH = 0.001
ONSET = STRENGTH**2 / (2.0 * STIFFNESS)
LAW = Adhesive(STIFFNESS, STRENGTH, 5.0 * ONSET, 0.2 * STRENGTH)


def beam(law=LAW):
    """The beam: free end at x = 0, glue from ``FREE`` on."""
    x, _ = breakpoints((FREE, uniform(12)), (GLUED, uniform(60)))

    def faces(midpoints, normals):
        return {"below": normals[:, 1] < 0, "end": normals[:, 0] < 0, "sides": normals[:, 2] != 0}

    grid = swept_blocks((x, HEIGHT * uniform(1), WIDTH * uniform(1)),
                        np.ones((len(x) - 1, 1, 1), int), {1: "body"}, faces=faces)
    box = ((FREE, -1.0, -1.0), (1e3, 1.0, 2.0))
    return Moved(grid, BEAM, "Q1 enhanced", glued("below", law, box),
                 symmetry={"end": 1, "sides": 2})


def opening(pull, arm):
    """Delta in mm at the end."""
    return pull / (3 * YOUNG * INERTIA) * (arm**3 + 0.5 / DECAY**3)


def peeled(scene, ends):
    """Lift the end through openings; return of each opening and pull, front, work, and losses."""
    rows, work, before = [], 0.0, (0.0, 0.0)

    def measure(end):
        nonlocal work, before
        pull = scene.reaction("end", 1)
        work += 0.5 * (pull + before[1]) * (end - before[0])
        before = end, pull
        rows.append((end, pull, front(scene), work, scene.stored(), scene.part.dissipated(),
                     turned(scene)))

    scene.on_step = measure
    for start, end in zip([0.0, *ends[:-1]], ends, strict=True):
        scene.lead("end", 1, start, end)
    return np.array(rows)


def turned(scene):
    """Slope of the beam at its end."""
    normal = scene.body.mean_normal("end")
    return abs(normal[1] / normal[0])


def front(scene):
    """Where in mm the damage is a half."""
    x, damage = scene.part.points.place[:, 0], scene.part.damage()
    order = np.argsort(x)
    x, damage = x[order], damage[order]
    return float(np.interp(-0.5, -damage, x)) if damage.max() > 0.5 else FREE


@pytest.fixture(scope="module")
def elastic():
    scene = beam()
    return scene, peeled(scene, [0.005])[0]


@pytest.fixture(scope="module")
def propagated():
    # A crack that starts from a 30 mm arm runs 15 mm; delta goes with the arm's square.
    force = np.sqrt(2.0 * YOUNG * INERTIA * WIDTH * LAW.toughness)
    arms = np.linspace(0.75 * FREE, FREE + 15.0, 120)
    return peeled(beam(), [opening(force / arm, arm) for arm in arms])


def test_initial_stiffness_is_that_of_the_beam_on_its_foundation(elastic):
    _, (end, pull, *_) = elastic
    assert end / pull == pytest.approx(opening(1.0, FREE + 1 / DECAY), rel=0.02)


def test_strength_is_reached_at_the_pull_of_the_beam_on_its_foundation(elastic):
    scene, (_, pull, *_) = elastic
    first = scene.part.utilisation.argmax()
    x = DECAY * (scene.part.points.place[first, 0] - FREE)
    assert 0.0 < x < 0.05  # the integration point next to the crack's tip
    tip = np.exp(-x) / (2 * YOUNG * INERTIA * DECAY**3) * (
        np.cos(x) + DECAY * FREE * (np.cos(x) - np.sin(x)))
    onset = STRENGTH / STIFFNESS / tip
    found = pull / scene.part.utilisation[first]
    assert found == pytest.approx(onset, rel=0.02)


def test_damage_begins_when_the_strength_is_reached():
    scene = beam()
    end = peeled(scene, [0.005])[0, 0] / scene.part.utilisation.max()
    peeled(scene, [0.99 * end])
    assert scene.part.damage().max() == 0.0
    peeled(scene, [1.02 * end])
    assert scene.part.damage().max() > 0.0


def test_a_growing_crack_takes_its_toughness(propagated):
    _, _, at, work, stored, dissipated, _ = propagated.T
    a, b = np.searchsorted(at, [FREE + 4.0, FREE + 11.0])
    area = WIDTH * (at[b] - at[a])
    assert area > 6.0
    for spent in (dissipated, work - stored):
        assert (spent[b] - spent[a]) / area == pytest.approx(LAW.toughness, rel=0.02)


def test_pull_and_opening_of_a_growing_crack_are_those_of_fracture_mechanics(propagated):
    end, pull, at, *_ = propagated.T
    grown = (at > FREE + 3.0) & (at < FREE + 12.0)
    assert grown.sum() > 10
    arm = np.sqrt(2.0 * YOUNG * INERTIA * WIDTH * LAW.toughness) / pull[grown]
    np.testing.assert_allclose(opening(pull[grown], arm), end[grown], rtol=0.02)


def test_pull_times_slope_at_the_end_is_the_toughness_of_a_growing_crack(propagated):
    # The J integral around a beam on any foundation.
    _, pull, at, *_, slope = propagated.T
    grown = (at > FREE + 3.0) & (at < FREE + 12.0)
    np.testing.assert_allclose(pull[grown] * slope[grown], WIDTH * LAW.toughness, rtol=0.02)


def test_work_of_peeling_is_stored_or_dissipated_all_along(propagated):
    _, _, _, work, stored, dissipated, _ = propagated.T
    assert dissipated[-1] > 0.2 * work[-1]
    np.testing.assert_allclose(stored + dissipated, work, rtol=0.005)
