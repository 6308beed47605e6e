import io
from types import SimpleNamespace

from morphing_wing.path import State
from morphing_wing.progress import Progress


def state(pressure=0.02, requested=True, pivots=0, contact=0.0):
    return State({"upper_MPa": pressure}, {"span_angle_deg": 19.245, "contact": contact}, 7, 12.5,
                 13.0, pivots, 1.25, requested)


def printed(*states, comm=None):
    out = io.StringIO()
    progress = Progress(comm, out)
    for item in states:
        progress(item)
    return out.getvalue().splitlines()


def test_each_step_is_one_line_under_one_heading():
    lines = printed(state(0.01, requested=False), state())
    assert len(lines) == 3
    assert lines[0].split() == ["step", "upper", "kPa", "phi_1", "deg", "iterations", "energy", "N",
                                "mm", "neg.", "piv.", "s"]
    assert lines[1].split()[:2] == ["1", "10"] and lines[1].endswith("in between")
    assert lines[2].split() == ["2", "20", "19.245", "7", "12.5", "0", "1.2"]


def test_columns_stand_under_their_headings():
    lines = printed(state())
    assert len(lines[0]) == len(lines[1])


def test_zero_has_no_sign():
    resting = State({"torque_Nmm": 0.0}, {"chord_angle_deg": -1e-9}, 0, 0.0, 0.0, 0, 0.1, True)
    assert printed(resting)[1].split()[:3] == ["1", "0", "0.000"]


def test_contact_is_told():
    assert printed(state(contact=1.0))[1].endswith("skin passes through itself or a rib")


def test_cut_steps_and_the_end_are_told():
    out = io.StringIO()
    progress = Progress(None, out)
    progress.cut({"upper_MPa": 0.03, "lower_MPa": 0.0}, "Newton diverged")
    progress.end(False, "the smallest step failed")
    cut, end = out.getvalue().splitlines()
    assert cut.strip() == "smaller step: upper = 30 kPa: Newton diverged"
    assert end.startswith("stopped after 0 steps") and end.endswith("the smallest step failed")


def test_other_ranks_are_silent():
    assert printed(state(), comm=SimpleNamespace(rank=1)) == []
