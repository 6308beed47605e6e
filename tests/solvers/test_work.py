"""The sum of external work, on springs whose work is known."""

import numpy as np
import pytest

from morphing_wing.work import ExternalWork


def led(laws, steps):
    """Lead springs through loads; each law returns displacement and compliance at a load."""

    def at(loads):
        load = dict(zip(laws, loads, strict=True))
        found = {name: law(load[name]) for name, law in laws.items()}
        return load, {n: q for n, (q, _) in found.items()}, np.diag([c for _, c in found.values()])

    work = ExternalWork()
    load, displacement, compliance = at(steps[0])
    work.stand(load, displacement)
    assert not work.knows_compliance
    work.learn(compliance)
    for loads in steps[1:]:
        work.add(*at(loads))
    return work


def cubic(load):
    return 7.0 + load + 2.0 * load**2 + 3.0 * load**3, 1.0 + 4.0 * load + 9.0 * load**2


def limit(load):
    """Return displacement and compliance of a spring that gives way at a load of 1."""
    return 1.0 - np.sqrt(1.0 - load), 0.5 / np.sqrt(1.0 - load)


pytestmark = pytest.mark.quick


def test_work_on_a_cubic_spring_is_exact_in_one_step_and_back():
    exact = 0.5 + 4.0 / 3.0 + 9.0 / 4.0
    assert led({"a": cubic}, [[0.0], [1.0]]).amount == pytest.approx(exact, rel=1e-14)
    assert led({"a": cubic}, [[0.0], [1.0], [0.0]]).amount == pytest.approx(0.0, abs=1e-13)


def test_two_loads_may_change_one_after_the_other_or_together():
    laws = {"a": cubic, "b": lambda load: (-2.0 + 5.0 * load, 5.0)}
    exact = 0.5 + 4.0 / 3.0 + 9.0 / 4.0 + 5.0 / 2.0
    for way in ([[0.0, 0.0], [1.0, 1.0]], [[0.0, 0.0], [0.0, 1.0], [1.0, 1.0]]):
        assert led(laws, way).amount == pytest.approx(exact, rel=1e-14)


@pytest.mark.parametrize("near", [0.9, 0.99, 0.9999])
def test_near_a_limit_point_the_sum_is_better_than_the_trapezium(near):
    def error(law):
        q = limit(near)[0]
        return abs(led({"a": law}, [[0.0], [near]]).amount / (q**2 - q**3 / 3.0) - 1.0)

    assert error(limit) < 0.6 * error(lambda load: (limit(load)[0], np.nan))


def test_a_restart_needs_the_compliance_of_the_same_loads_only():
    work = led({"a": cubic}, [[0.0], [0.5]])
    again, other = ExternalWork(), ExternalWork()
    again.stand({"a": 0.5}, {"a": cubic(0.5)[0]})
    other.stand({"a": 0.5, "b": 0.0}, {"a": cubic(0.5)[0], "b": 1.0})
    for new in (again, other):
        new.recall(work.memory())
    for goes_on in (work, again):
        goes_on.add({"a": 1.0}, {"a": cubic(1.0)[0]}, np.array([[cubic(1.0)[1]]]))
    assert again.amount == work.amount
    assert not other.knows_compliance
