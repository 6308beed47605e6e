"""A run that was interrupted and resumed is the run that was not: same table, same fields."""

import shutil

import numpy as np
import pytest

from morphing_wing import restart
from morphing_wing.errors import InputError
from morphing_wing.geometry.rib import RibGeometry
from morphing_wing.geometry.spar import SparGeometry
from morphing_wing.rib import Rib
from morphing_wing.spar import Spar
from morphing_wing.stepping import Stepping
from tests.scenes.small_wing import small_wing

RELATIVE = 1e-10
UPPER, LOWER = [0.01, 0.02, 0.03], [0.0, 0.0, 0.005]


class Killed(Exception):
    """What ends a run from outside."""


def after(steps):
    """Return an ``on_step`` that kills the run after so many steps."""
    left = iter(range(steps - 1, -1, -1))

    def on_step(state):
        if next(left) == 0:
            raise Killed

    return on_step


def spar(n_cells=2, **options):
    return Spar(SparGeometry.validation(n_cells), **{"fidelity": "draft"} | options)


def inflate(scene, **options):
    return scene.inflate(upper=UPPER, lower=LOWER, **options)


def assert_same(resumed, whole, new):
    """Compare all columns but the time, and the fields of the ``new`` states and the one before."""
    there, here = (path.table().drop(columns="step_seconds") for path in (whole, resumed))
    assert list(here) == list(there) and len(here) == len(there)
    for name in there:
        np.testing.assert_allclose(
            here[name].astype(float), there[name].astype(float),
            rtol=RELATIVE, atol=1e-12, err_msg=name)
    assert (resumed.converged, resumed.reason) == (whole.converged, whole.reason)
    with_fields = [bool(state.fields) for state in resumed]
    assert with_fields == [i >= len(whole) - new - 1 for i in range(len(whole))]
    for state, reference in zip(resumed, whole, strict=True):
        for name, values in state.fields.items():
            largest = np.abs(reference.fields[name]).max()
            np.testing.assert_allclose(
                values, reference.fields[name], rtol=0, atol=RELATIVE * largest)


@pytest.fixture(scope="module")
def whole():
    """Return the spar's run that nothing interrupted."""
    return inflate(spar())


@pytest.fixture(scope="module")
def interrupted(tmp_path_factory):
    """Return the folder of a spar's run that was killed after its second step."""
    folder = tmp_path_factory.mktemp("interrupted")
    with pytest.raises(Killed):
        inflate(spar(), restart=folder, on_step=after(2))
    return folder


@pytest.mark.quick
@pytest.mark.parametrize("steps", [1, 2])
def test_killed_and_resumed_spar_gives_the_table_of_one_run(steps, whole, tmp_path):
    with pytest.raises(Killed):
        inflate(spar(), restart=tmp_path, on_step=after(steps))
    assert_same(inflate(spar(), resume=tmp_path), whole, new=len(whole) - steps)


@pytest.mark.quick
def test_a_run_may_be_killed_after_every_step(whole, tmp_path):
    with pytest.raises(Killed):
        inflate(spar(), restart=tmp_path, on_step=after(1))
    with pytest.raises(Killed):
        inflate(spar(), restart=tmp_path, resume=tmp_path, on_step=after(1))
    assert_same(inflate(spar(), resume=tmp_path), whole, new=1)


@pytest.mark.quick
def test_killed_between_two_wanted_loads_it_takes_the_same_steps(tmp_path):
    def run(**options):
        scene = spar()
        scene.stepping = Stepping(largest={"upper_MPa": 0.004})
        return scene.inflate(upper=[0.01, 0.02], **options)

    whole = run()
    assert [state.requested for state in whole] == [False, False, True] * 2
    with pytest.raises(Killed):
        run(restart=tmp_path, on_step=after(4))
    assert_same(run(resume=tmp_path), whole, new=2)


@pytest.mark.quick
def test_a_scene_that_went_elsewhere_resumes_as_a_new_one_does(whole, interrupted):
    scene = spar()
    scene.inflate(lower=0.03)
    assert_same(inflate(scene, resume=interrupted), whole, new=1)


@pytest.mark.quick
def test_a_finished_run_resumed_is_the_same_path_without_a_step(whole, tmp_path):
    inflate(spar(), restart=tmp_path)
    steps = []
    resumed = inflate(spar(), resume=tmp_path, on_step=steps.append)
    assert not steps
    assert_same(resumed, whole, new=0)


@pytest.mark.quick
def test_a_finished_run_goes_on_to_further_loads(tmp_path):
    whole = spar().inflate(upper=[0.01, 0.02, 0.03])
    spar().inflate(upper=[0.01, 0.02], restart=tmp_path)
    assert_same(spar().inflate(upper=[0.01, 0.02, 0.03], resume=tmp_path), whole, new=1)


@pytest.mark.quick
def test_killed_and_resumed_rib_gives_the_table_of_one_run(tmp_path):
    def run(**options):
        return Rib(RibGeometry.validation()).bend(torque=[2.0, 4.0, 5.0], **options)

    with pytest.raises(Killed):
        run(restart=tmp_path, on_step=after(2))
    whole = run()
    assert_same(run(resume=tmp_path), whole, new=len(whole) - 2)


def test_killed_and_resumed_wing_with_ribs_skin_and_cables_gives_the_table_of_one_run(tmp_path):
    def run(**options):
        loads = {"upper": [0.003, 0.006, 0.006], "cable": [0.0, 0.05, 0.1]}
        return small_wing(None).actuate(**loads, **options)

    with pytest.raises(Killed):
        run(restart=tmp_path, on_step=after(2))
    whole = run()
    resumed = run(resume=tmp_path)
    assert set(resumed[-1].fields) == {"elastomer", "ribs"}
    assert_same(resumed, whole, new=len(whole) - 2)


@pytest.mark.quick
def test_wall_time_of_all_runs_is_added_up(interrupted):
    spent = restart.read(interrupted, spar()).seconds
    assert spent > 0.0
    resumed = inflate(spar(), resume=interrupted)
    assert resumed.seconds >= spent + resumed[-1].step_seconds


@pytest.mark.quick
@pytest.mark.parametrize("other, told", [
    (lambda: spar(3), "geometry.n_cells is 2 in it and 3 here"),
    (lambda: spar(fidelity="standard"), "fidelity is draft in it and standard here"),
    (lambda: Rib(RibGeometry.validation()), "scene is spar in it and rib here"),
])  # fmt: skip
def test_another_scene_is_refused_and_told_where_it_differs(other, told, interrupted):
    with pytest.raises(InputError, match=told):
        restart.read(interrupted, other())


@pytest.mark.quick
@pytest.mark.parametrize("upper, told", [
    ([0.01, 0.025], "upper_MPa = 0.025 in load 2: must be 0.02 as in the run to resume"),
    (0.01, "number of loads = 1: must be 2 or more"),
])  # fmt: skip
def test_other_loads_than_those_done_are_refused(upper, told, interrupted):
    with pytest.raises(InputError, match=told):
        spar().inflate(upper=upper, resume=interrupted)


@pytest.mark.quick
def test_a_missing_or_broken_file_is_refused_in_one_sentence(interrupted, tmp_path):
    with pytest.raises(InputError, match="no such file, there is nothing to resume"):
        inflate(spar(), resume=tmp_path)
    content = (interrupted / "restart.npz").read_bytes()
    broken = tmp_path / "half.npz"
    for text in (b"", b"something else", content[: len(content) // 2]):
        broken.write_bytes(text)
        with pytest.raises(InputError, match="must be a restart file of this version"):
            inflate(spar(), resume=broken)


@pytest.mark.quick
def test_a_state_from_before_the_restart_tells_why_it_cannot_be_drawn(interrupted, tmp_path):
    resumed = inflate(spar(), resume=interrupted)
    with pytest.raises(InputError, match="state at upper = 0.01 MPa, lower = 0 MPa: has no fields"):
        resumed[0].render(tmp_path / "state.png")


def test_a_resumed_path_saves_all_rows_and_the_fields_that_it_has(interrupted, tmp_path):
    folder = shutil.copytree(interrupted, tmp_path / "run")
    resumed = inflate(spar(), resume=folder)
    resumed.save(folder)
    rows = (folder / "table.csv").read_text().splitlines()
    assert len(rows) == 1 + len(UPPER)
    written = sorted(file.name for file in (folder / "fields").glob("*.vtu"))
    assert written == ["elastomer_0001.vtu", "elastomer_0002.vtu"]


def test_fields_that_the_first_run_saved_stay_if_they_are_of_the_same_states(tmp_path):
    def files():
        return {file.name: file.read_bytes() for file in (tmp_path / "fields").glob("*.vtu")}

    first = spar().inflate(upper=[0.005, 0.01], restart=tmp_path)
    first.save(tmp_path)
    old = files()
    spar().inflate(upper=[0.005, 0.01, 0.015], resume=tmp_path).save(tmp_path)
    assert sorted(files()) == [f"elastomer_000{step}.vtu" for step in range(3)]
    assert files()["elastomer_0000.vtu"] == old["elastomer_0000.vtu"]
    series = (tmp_path / "fields" / "path.pvd").read_text()
    assert all(name in series for name in files())

    spar().inflate(upper=[0.004, 0.01]).save(tmp_path)
    spar().inflate(upper=[0.005, 0.01, 0.015], resume=tmp_path).save(tmp_path)
    assert sorted(files()) == ["elastomer_0001.vtu", "elastomer_0002.vtu"]
