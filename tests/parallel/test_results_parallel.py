import io
import json
import pathlib
import sys
import time

import numpy as np
import pytest
from mpi4py import MPI

sys.path.insert(0, str(pathlib.Path(__file__).parents[1] / "results"))

import pyvista
from fake_scenes import bent, box, line, spar_path, turned

from morphing_wing.errors import InputError
from morphing_wing.fields import FieldGrid
from morphing_wing.path import load_table
from morphing_wing.progress import Progress
from morphing_wing.root import on_root

COMM = MPI.COMM_WORLD


@pytest.fixture
def folder(tmp_path_factory):
    name = tmp_path_factory.mktemp("shared") if COMM.rank == 0 else None
    yield COMM.bcast(name)
    COMM.barrier()


def filled(make, comm, **options):
    function = make(comm, **options)

    def motion(x):
        return bent(x, 0.7, 3.0) + 0.1 * x[0] * x[1]

    function.interpolate(turned(motion) if options.get("rotations") else motion)
    return FieldGrid(function)


@pytest.mark.parametrize("make, options", [
    (box, {"degree": 1}), (box, {"degree": 2}), (line, {}), (line, {"rotations": True})])
def test_grid_is_the_same_as_on_one_rank(make, options):
    many = filled(make, COMM, **options).grid()
    one = filled(make, MPI.COMM_SELF, **options).grid()
    if COMM.rank != 0:
        assert many is None
        return
    np.testing.assert_array_equal(many.cells, one.cells)
    np.testing.assert_array_equal(many.celltypes, one.celltypes)
    np.testing.assert_allclose(many.points, one.points, atol=1e-14)
    for name in {"displacement", "rotation", "stretch"} & set(one.point_data):
        np.testing.assert_allclose(many.point_data[name], one.point_data[name], atol=1e-13)


def test_stale_ghosts_do_not_reach_the_grid():
    function = box(COMM)
    function.interpolate(lambda x: bent(x, 0.7, 3.0))
    index_map = function.function_space.dofmap.index_map
    function.x.array[3 * index_map.size_local:] = 1e9
    grid = FieldGrid(function).grid()
    if COMM.rank == 0:
        assert np.abs(grid.point_data["displacement"]).max() < 10.0


def test_saving_writes_everything_once(folder):
    path = spar_path(n_cells=2, comm=COMM)
    path.save(folder)
    COMM.barrier()
    names = {f.relative_to(folder).as_posix() for f in folder.rglob("*") if f.is_file()}
    assert names == {
        "summary.json", "table.csv", "angles.png", "shape.png", "path.png", "fields/path.pvd",
        *(f"fields/elastomer_{i:04d}.vtu" for i in range(4))}
    assert len(load_table(folder)) == 4
    assert json.loads((folder / "summary.json").read_text())["converged"] is True
    if COMM.rank == 0:
        read = pyvista.read(folder / "fields" / "elastomer_0003.vtu")
        one = spar_path(n_cells=2, comm=MPI.COMM_SELF)
        one.scene.show(one[3])
        grid = FieldGrid(one.scene.functions["elastomer"]).grid()
        np.testing.assert_array_equal(read.cells, grid.cells)
        np.testing.assert_allclose(
            read.point_data["displacement"], grid.point_data["displacement"], atol=1e-12)


def test_a_failure_of_rank_0_reaches_every_rank_as_the_same_error():
    def fails():
        raise InputError("directory = 'x': must be a folder, not a file")

    with pytest.raises(InputError, match="must be a folder"):
        on_root(COMM, fails)


def test_progress_prints_on_rank_0_alone():
    out = io.StringIO()
    progress = Progress(COMM, out)
    for state in spar_path(n_cells=1, comm=COMM):
        progress(state)
    assert len(out.getvalue().splitlines()) == (5 if COMM.rank == 0 else 0)


def test_ranks_that_still_make_meshes_of_their_own_are_waited_for():
    if COMM.rank != 0:
        time.sleep(0.3)
        box(MPI.COMM_SELF)
    assert box(COMM).function_space.mesh.comm.size == COMM.size
