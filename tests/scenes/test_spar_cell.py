"""One cell of a long spar between mirror planes, against whole spars."""

from dataclasses import replace

import numpy as np
import pytest
from mpi4py import MPI

from morphing_wing import compat
from morphing_wing.drawing import default_drawing
from morphing_wing.errors import InputError
from morphing_wing.geometry.spar import SparGeometry, SparMeshing
from morphing_wing.modes import modes
from morphing_wing.spar import Spar
from morphing_wing.spar_cell import SparCell

MESH = {"meshing": SparMeshing.graded(1), "element": "Q1/P0", "comm": MPI.COMM_SELF}


def cell(n_cells=1, **options):
    return Spar(SparGeometry.validation(n_cells), fidelity="cell", **(MESH | options))


def angle(path):
    assert path.converged, path.reason
    return path[-1].measures["span_angle_deg"]


def test_fidelity_cell_makes_one():
    assert type(cell()) is SparCell
    assert cell().dofs < 0.15 * Spar(SparGeometry.validation(4), **MESH).dofs


def test_its_picture_says_that_it_is_no_whole_spar():
    scene = cell()
    state = scene.inflate(upper=0.01)[-1]
    assert scene.drawing(state).what == "a quarter of one cell"
    assert default_drawing(scene).what == "whole"


def test_one_more_chamber_of_a_whole_spar_turns_as_the_cell():
    # The ends are felt for six chambers.
    few, more = (Spar(SparGeometry.validation(n), **MESH).inflate(upper=0.02) for n in (8, 9))
    assert angle(more) - angle(few) == pytest.approx(angle(cell().inflate(upper=0.02)), rel=1e-4)
    energies = more[-1].energy_Nmm - few[-1].energy_Nmm
    assert energies == pytest.approx(cell().inflate(upper=0.02)[-1].energy_Nmm, rel=1e-3)


def test_angle_and_line_are_those_of_a_long_spar_but_for_its_ends():
    whole = Spar(SparGeometry.validation(20), **MESH).inflate(upper=0.02)
    found = cell(20).inflate(upper=0.02)
    assert angle(found) == pytest.approx(angle(whole), rel=3e-4)
    lines = [path[-1].measures["span_line_deg"] for path in (found, whole)]
    assert lines[0] == pytest.approx(lines[1], rel=0.015)  # the clamped root turns by 0.1 degrees


def test_angle_is_that_of_one_cell_times_their_number():
    assert angle(cell(20).inflate(upper=0.01)) == pytest.approx(
        20 * angle(cell(1).inflate(upper=0.01)), rel=1e-10)


def test_the_lower_row_bends_upwards_and_both_only_lengthen():
    scene = cell()
    down = angle(scene.inflate(upper=0.01))
    assert angle(scene.inflate(lower=0.01)) == pytest.approx(-down, rel=1e-8)
    path = scene.inflate(upper=0.01, lower=0.01)
    assert abs(angle(path)) < 1e-8 * down
    assert scene._plane.distance > 1.01 * scene.geometry.pitch / 2


def test_work_of_the_pressure_is_the_stored_energy():
    path = cell().inflate(upper=np.linspace(0.0, 0.03, 4)[1:])
    assert path[-1].external_work_Nmm == pytest.approx(path[-1].energy_Nmm, rel=2e-4)


def test_volume_of_a_cut_chamber_is_that_of_its_box():
    scene = cell()
    scene.inflate(upper=1e-9)
    g = scene.geometry
    box = g.cavity_length * g.cavity_height * g.cavity_width
    assert 4 * scene._conjugates()["upper_MPa"] == pytest.approx(box, rel=1e-6)


def test_the_plane_stays_plane():
    scene = cell()
    scene.inflate(upper=0.02)
    turn = scene._plane.turn
    x = scene.body.X + scene.body.u
    gap = np.cos(turn) * x[2] - np.sin(turn) * x[1] - scene._plane.distance
    squared = compat.assemble_scalar(
        scene.comm, compat.form(scene.body.on_face("chamber_middle", gap**2)))
    assert np.sqrt(squared) < 1e-4  # mm, times mm of the root of its area


def test_any_meshing_is_cut_in_its_middle():
    plain = cell(meshing=SparMeshing.plain()).inflate(upper=0.01)
    assert angle(plain) == pytest.approx(angle(cell().inflate(upper=0.01)), rel=0.1)


@pytest.mark.parametrize("name, value", [("half", False), ("contact", True), ("filled", "shared")])
def test_what_a_cell_does_not_model_is_refused(name, value):
    with pytest.raises(InputError, match=f"^{name} = .*: must be .* where fidelity is 'cell'$"):
        cell(**{name: value})


@pytest.mark.parametrize("fidelity", ["cell", "instant"])
def test_walls_that_differ_are_refused(fidelity):
    geometry = replace(SparGeometry.validation(1), wall_lengths=(1.0, 2.0))
    with pytest.raises(InputError, match=r"^wall_lengths = \(1.0, 2.0\) mm: must be left out"):
        Spar(geometry, fidelity=fidelity)
    assert Spar(geometry, fidelity="auto", tolerance=0.5).fidelity == "draft"


def test_a_misspelt_option_is_no_option():
    with pytest.raises(TypeError, match="contcat"):
        cell(contcat=True)


def test_a_cell_has_no_modes_of_vibration():
    scene = cell()
    scene.inflate(upper=0.01)
    with pytest.raises(InputError, match="must be a whole spar's for modes"):
        modes(scene, 1)
    with pytest.raises(InputError, match="must be a whole spar's to be filled"):
        scene.fill(upper=100.0)


def test_another_geometry_is_another_angle():
    thick = Spar(replace(SparGeometry.validation(1), top_thickness=1.4), fidelity="cell", **MESH)
    assert angle(thick.inflate(upper=0.02)) < 0.9 * angle(cell().inflate(upper=0.02))
