"""The problems of ``morphing-wing verify``: all of their numbers hold."""

import pytest
from mpi4py import MPI

from morphing_wing.verification import PROBLEMS, Check

MARKED = [pytest.param(problem, id=name, marks=[pytest.mark.quick] if problem.quick else [])
          for name, problem in PROBLEMS.items()]


@pytest.mark.parametrize("problem", MARKED)
def test_all_numbers_of_a_problem_hold(problem):
    checks = list(problem.run(MPI.COMM_SELF))
    assert checks
    missed = [f"{c.name}: {c.value:.8g}, not {c.reference:.8g} {c.unit}" for c in checks
              if not c.holds]
    assert not missed, "; ".join(missed)


@pytest.mark.quick
@pytest.mark.parametrize("value, reference, holds", [
    (1.009, 1.0, True), (0.989, 1.0, False), (-1.009, -1.0, True), (0.009, 0.0, True),
    (0.011, 0.0, False), (float("nan"), 1.0, False), (float("inf"), 1.0, False)])
def test_a_check_is_relative_unless_the_answer_is_zero(value, reference, holds):
    assert Check("", value, reference, "", 0.01).holds is holds
