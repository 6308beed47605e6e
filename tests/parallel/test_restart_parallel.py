"""A restart file is the same whatever the number of ranks, and any number goes on from it."""

import pathlib
import tempfile

import numpy as np
import pytest
from mpi4py import MPI

from morphing_wing import restart
from morphing_wing.geometry.rib import RibGeometry
from morphing_wing.geometry.spar import SparGeometry
from morphing_wing.rib import Rib
from morphing_wing.spar import Spar
from tests.parallel.tolerances import WORK
from tests.scenes.small_wing import small_wing

RELATIVE = 1e-10
COMM = MPI.COMM_WORLD
PAIRS = pytest.mark.parametrize(
    "first, second", [(COMM, MPI.COMM_SELF), (MPI.COMM_SELF, COMM)], ids=["many-one", "one-many"])


class Killed(Exception):
    """What ends a run from outside, on all ranks at the same step."""


def kill(state):
    raise Killed


@pytest.fixture
def folder(tmp_path):
    """Return a folder of all ranks together."""
    return pathlib.Path(COMM.bcast(str(tmp_path)))


def own(folder, comm):
    """Return where the runs on a communicator write: each its own file."""
    alone = comm.size == 1 and COMM.size > 1
    return folder / (f"alone-{COMM.rank}.npz" if alone else "together.npz")


def spar(comm, **options):
    scene = Spar(SparGeometry.validation(2), fidelity="draft", comm=comm)
    return scene.inflate(upper=[0.01, 0.03], lower=[0.0, 0.005], **options)


def rib(comm, **options):
    return Rib(RibGeometry.validation(), comm=comm).bend(torque=[2.0, 5.0], **options)


def wing(comm, **options):
    return small_wing(comm).actuate(upper=[0.005, 0.01], cable=[0.0, 0.1], **options)


def resumed_elsewhere(run, first, second, folder):
    """Compare a run begun on one communicator and ended on another with one on the latter alone."""
    with pytest.raises(Killed):
        run(first, restart=own(folder, first), on_step=kill)
    COMM.Barrier()
    resumed = run(second, resume=own(folder, first))
    there, here = (p.table().drop(columns=["step_seconds", "gap_mm"], errors="ignore")
                   for p in (run(second), resumed))
    assert len(here) == len(there) > 1
    for name in there:
        np.testing.assert_allclose(
            here[name].astype(float), there[name].astype(float),
            rtol=WORK if name == "external_work_Nmm" else RELATIVE, atol=1e-12, err_msg=name)


@pytest.mark.quick
@PAIRS
def test_spar_begun_on_some_ranks_ends_the_same_on_others(first, second, folder):
    resumed_elsewhere(spar, first, second, folder)


@pytest.mark.quick
@PAIRS
@pytest.mark.parametrize("filled", ["shared", "separate"])
def test_filled_spar_begun_on_some_ranks_ends_the_same_on_others(filled, first, second, folder):
    def fill(comm, **options):
        scene = Spar(SparGeometry.validation(2), fidelity="draft", comm=comm, filled=filled)
        return scene.fill(upper=[500.0, 1500.0], **options)

    resumed_elsewhere(fill, first, second, folder)


@PAIRS
def test_rib_begun_on_some_ranks_ends_the_same_on_others(first, second, folder):
    resumed_elsewhere(rib, first, second, folder)


@PAIRS
def test_wing_begun_on_some_ranks_ends_the_same_on_others(first, second, folder):
    resumed_elsewhere(wing, first, second, folder)


@pytest.mark.parametrize("element", ["Q2/P1disc", "Q2/Q1", "Q2 reduced"])
def test_each_kind_of_element_is_read_as_it_was_written(element, folder):
    def scene(comm):
        return Spar(SparGeometry.validation(1), element=element, comm=comm)

    together = scene(COMM)
    path = together.inflate(upper=[0.005, 0.01], restart=own(folder, COMM))
    alone = scene(MPI.COMM_SELF)
    earlier = restart.read(own(folder, COMM), alone)
    alone.show(earlier.states[-1])
    tip = alone.body.mean_displacement("tip")
    np.testing.assert_allclose(tip, together.body.mean_displacement("tip"), rtol=1e-12, atol=1e-14)
    assert path[-1].measures == earlier.states[-1].measures
    # Written again by one rank alone it is the same to the last bit.
    again = pathlib.Path(tempfile.mkdtemp()) / "again.npz"
    alone.inflate(upper=[0.005, 0.01], resume=own(folder, COMM))
    restart.write(again, alone, earlier.states, earlier.standing, earlier.seconds)
    with np.load(own(folder, COMM)) as there, np.load(again) as here:
        assert there["elastomer"].shape[0] == len(alone.body.grid.cells)
        np.testing.assert_array_equal(here["elastomer"], there["elastomer"])
