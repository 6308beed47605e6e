"""Load stepping: cuts, growth, what is kept, what is said. No equations but one: x = load."""

import numpy as np
import pytest

from morphing_wing.newton import NewtonResult
from morphing_wing.path import State
from morphing_wing.stepping import Stepping, follow

pytestmark = pytest.mark.quick


class Fake:
    """Converges to x = load where the step from the present x is short enough."""

    def __init__(self, longest=np.inf, barrier=np.inf, iterations=4):
        self.x, self.accepted = np.zeros(1), [0.0]
        self.longest, self.barrier, self.iterations = longest, barrier, iterations
        self.starts, self.tried, self.load = [], [], {"force_N": 0.0}

    def set_load(self, load):
        self.load = dict(load)

    def solve(self):
        wanted = self.load["force_N"]
        self.starts.append(float(self.x[0]))
        self.tried.append(wanted)
        step, self.x = abs(wanted - self.accepted[-1]), np.full(1, np.nan)
        good = step <= self.longest * (1 + 1e-12) and wanted <= self.barrier
        if good:
            self.x = np.array([wanted])
        return NewtonResult(good, "converged" if good else "an element broke",
                            self.iterations, 0.0, 0)

    def unknowns(self):
        return [self.x.copy()]

    def set_unknowns(self, values):
        self.x = values[0].copy()

    def accept(self):
        self.accepted.append(float(self.x[0]))

    def state(self, load, result, seconds, requested):
        return State(load=dict(load), measures={}, newton_iterations=result.iterations,
                     energy_Nmm=0.0, external_work_Nmm=0.0, negative_pivots=0,
                     step_seconds=seconds, requested=requested, fields={"x": self.x.copy()})


def led(scene, *forces, stepping=None, **callbacks):
    return follow(scene, {"force_N": 0.0}, [{"force_N": f} for f in forces],
                  stepping or Stepping(), **callbacks)


def loads(states):
    return [state.load["force_N"] for state in states]


def test_easy_loads_take_one_step_each():
    states, converged, reason = led(Fake(), 1.0, 3.0, -2.0)
    assert converged and reason == "the last load was reached"
    assert loads(states) == [1.0, 3.0, -2.0]
    assert all(state.requested for state in states)


def test_a_failure_halves_the_step_and_intermediate_states_are_kept():
    scene = Fake(longest=0.25)
    states, converged, _ = led(scene, 1.0)
    assert converged
    assert loads(states) == [0.25, 0.5, 0.75, 1.0]
    assert [state.requested for state in states] == [False, False, False, True]
    assert scene.tried[:3] == [1.0, 0.5, 0.25]


def test_every_converged_step_becomes_a_state_of_its_own_fields():
    scene = Fake(longest=0.3)
    states, *_ = led(scene, 1.0, 2.0)
    assert [float(state.fields["x"][0]) for state in states] == loads(states)
    assert scene.accepted[1:] == loads(states)


def test_after_a_failure_the_last_converged_state_is_where_the_next_try_starts():
    scene = Fake(longest=0.25)
    led(scene, 1.0)
    assert not np.isnan(scene.starts).any()
    assert scene.starts == [0.0, 0.0, 0.0, 0.25, 0.25, 0.5, 0.5, 0.75]


def test_steps_grow_again_after_easy_ones_only():
    class OnceHard(Fake):
        def solve(self):
            if len(self.tried) == 2:
                self.longest = np.inf
            return super().solve()

    easy = led(OnceHard(longest=0.1), 1.0)[0]
    assert loads(easy) == [0.25, 0.75, 1.0]
    hard = led(OnceHard(longest=0.1, iterations=9), 1.0)[0]
    assert loads(hard) == [0.25, 0.5, 0.75, 1.0]


def test_steps_never_pass_a_wanted_load():
    states, *_ = led(Fake(longest=0.3), 0.7, 1.1)
    assert 0.7 in loads(states) and 1.1 in loads(states)
    assert [s.load["force_N"] for s in states if s.requested] == [0.7, 1.1]


def test_where_no_step_is_small_enough_it_says_where_and_why_it_stopped():
    scene = Fake(barrier=0.6)
    states, converged, reason = led(scene, 0.5, 1.0)
    assert not converged
    last = loads(states)[-1]
    assert 0.6 - 0.5 / 256 <= last <= 0.6
    assert reason == f"stopped after force = {last:.6g} N: an element broke"
    # The scene is left in the last converged state, under its load.
    assert scene.x[0] == last == scene.load["force_N"]


def test_nothing_is_reached_where_the_first_step_fails_however_small():
    states, converged, reason = led(Fake(longest=-1.0), 1.0)
    assert states == [] and not converged
    assert reason == "stopped after force = 0 N: an element broke"


def test_smallest_step_is_the_one_asked_for():
    scene = Fake(longest=-1.0)
    led(scene, 1.0, stepping=Stepping(smallest=1 / 8))
    assert scene.tried == [1.0, 0.5, 0.25, 0.125]


def test_largest_change_of_a_load_bounds_the_step():
    states, *_ = led(Fake(), 1.0, stepping=Stepping(largest={"force_N": 0.25}))
    assert loads(states) == [0.25, 0.5, 0.75, 1.0]


def test_callbacks_hear_of_every_step_and_every_cut():
    steps, cuts = [], []
    states, *_ = led(Fake(longest=0.25), 1.0, on_step=steps.append,
                     on_cut=lambda load, why: cuts.append((load["force_N"], why)))
    assert steps == states
    assert cuts[:2] == [(1.0, "an element broke"), (0.5, "an element broke")]


def test_a_load_repeated_is_a_state_repeated():
    states, converged, _ = led(Fake(), 1.0, 1.0)
    assert converged and loads(states) == [1.0, 1.0]
