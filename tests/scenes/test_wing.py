"""The wing as a scene: only what it needs, mirror symmetry, steps, energy, glue, contact."""

from dataclasses import replace

import numpy as np
import pytest
from mpi4py import MPI

from morphing_wing import compat
from morphing_wing.errors import InputError
from morphing_wing.forms.enhanced import N_MODES
from morphing_wing.geometry.frame import local_axes
from morphing_wing.geometry.rib import RibGeometry
from morphing_wing.geometry.wing import WingGeometry
from morphing_wing.geometry.wing_mesh import WingMeshing, wing_mesh
from morphing_wing.wing import Wing
from tests.scenes.small_wing import GEOMETRY, MESHING, move_elastomer, small_wing

NO_RIBS = {"rib": None}
NO_SKIN = {"skin_thickness": None}
SPAR = NO_RIBS | NO_SKIN
THIN_SKIN = {"n_cells": 4, "skin_thickness": 0.4}
PRESSURE = 0.02


def wing(**changes):
    return small_wing(MPI.COMM_SELF, geometry=replace(GEOMETRY, **changes))


def actuated(scene, **loads):
    path = scene.actuate(**loads)
    assert path.converged, path.reason
    return path


def angles(state):
    return {name: value for name, value in state.measures.items() if name.endswith("_deg")}


def elastomer_unknowns(geometry):
    """Three displacements of each point of the linear mesh, and the strains of the skin's cells.

    Clamped displacements count, and stay zero.
    """
    mesh = wing_mesh(geometry, MESHING)
    return 3 * len(mesh.points) + N_MODES * len(mesh.regions["skin"])


def rib_unknowns(geometry):
    """Six unknowns of each end and each middle of a bar."""
    frame = geometry.rib.frame()
    return 6 * (len(frame.points) + len(frame.bars)) * len(geometry.rib_positions)


# -- only what it needs --------------------------------------------------------------------------


@pytest.mark.quick
@pytest.mark.parametrize("changes", [SPAR, NO_RIBS], ids=["spar alone", "skin"])
def test_a_wing_without_ribs_has_the_elastomers_unknowns_only(changes):
    scene = wing(**changes)
    assert scene.dofs == elastomer_unknowns(scene.geometry)
    assert set(scene.functions) == {"elastomer"}


@pytest.mark.quick
def test_ribs_bring_their_own_unknowns_and_glue_brings_none():
    for changes in ({}, NO_SKIN, {"n_cells": 6, "rib_positions": (0.25, 0.75)}):
        scene = wing(**changes)
        assert scene.dofs == elastomer_unknowns(scene.geometry) + rib_unknowns(scene.geometry)


def test_loads_that_nobody_asks_for_cost_no_integral():
    scene = wing(**NO_SKIN)
    actuated(scene, upper=0.001, lower=0.0, cable=[0.0])
    assert set(scene.loads) == {"upper_MPa"}
    actuated(scene, upper=0.001, cable=0.01)
    assert set(scene.loads) == {"upper_MPa", "cable_N"}


def test_another_load_compiles_no_tangent_anew_but_its_own(monkeypatch):
    compiled, form = [], compat.form

    def noted(expression):
        if len(expression.arguments()) == 2:
            compiled.append(expression.signature())
        return form(expression)

    monkeypatch.setattr(compat, "form", noted)
    actuated(wing(), upper=0.001)
    few = set(compiled)
    compiled.clear()
    actuated(wing(), upper=0.001, cable=0.01)
    assert few < set(compiled)
    assert len(set(compiled) - few) == 1


@pytest.mark.quick
def test_only_displacements_of_the_skin_have_its_mass():
    scene = wing()
    mass, moves = scene.body.region_mass("skin"), scene.body.is_displacement()
    assert len(mass) == scene.body.block.n_owned and not moves.all()
    assert np.all(mass[~moves] == 0.0)
    mesh = wing_mesh(GEOMETRY, MESHING)
    corners = mesh.points[mesh.cells[mesh.regions["skin"]]]
    middle = [corners[:, far].mean(axis=1) - corners[:, near].mean(axis=1)
              for far, near in (([1, 3, 5, 7], [0, 2, 4, 6]), ([2, 3, 6, 7], [0, 1, 4, 5]),
                                ([4, 5, 6, 7], [0, 1, 2, 3]))]
    volume = np.abs(np.linalg.det(np.stack(middle, axis=-1))).sum()
    assert mass.sum() == pytest.approx(3.0 * volume, rel=1e-2)


@pytest.mark.parametrize("changes, present, absent", [
    (SPAR, {"span_angle_deg"}, {"chord_angle_deg", "rib_1_rotation_deg", "contact"}),
    (NO_SKIN, {"chord_angle_deg", "rib_1_rotation_deg"}, {"gap_mm", "contact"}),
    (NO_RIBS, {"chord_angle_deg", "gap_mm", "contact"}, {"rib_1_rotation_deg"}),
], ids=["spar alone", "no skin", "no ribs"])
def test_only_what_a_wing_has_is_measured(changes, present, absent):
    found = set(actuated(wing(**changes), upper=0.001)[-1].measures)
    assert present <= found and not absent & found


# -- mirror symmetry -----------------------------------------------------------------------------


@pytest.fixture
def mirrored_ribs(monkeypatch):
    """Return a function that turns all ribs built from now on upside down."""
    frame = RibGeometry.frame

    def upside_down(rib):
        found = frame(rib)
        points = found.points * np.array([1.0, -1.0, 1.0])
        return replace(found, points=points, axes=local_axes(points, found.bars))

    return lambda: monkeypatch.setattr(RibGeometry, "frame", upside_down)


@pytest.mark.parametrize("changes", [SPAR, NO_RIBS, NO_SKIN, {}],
                         ids=["spar alone", "no ribs", "no skin", "all"])
def test_lower_chambers_mirror_the_upper_ones(changes, mirrored_ribs):
    up = actuated(wing(**changes), upper=PRESSURE)[-1]
    mirrored_ribs()
    down = actuated(wing(**changes), lower=PRESSURE)[-1]
    assert up.measures["span_angle_deg"] > 0.5
    for name, value in angles(up).items():
        assert down.measures[name] == pytest.approx(-value, rel=1e-6), name
    assert down.energy_Nmm == pytest.approx(up.energy_Nmm, rel=1e-8)


def test_a_ribs_own_lack_of_symmetry_changes_the_span_angle_by_less_than_a_thousandth():
    # Its middle bars rise and its outer bars fall: upside down it is another rib.
    up, down = (actuated(wing(), **{row: PRESSURE})[-1] for row in ("upper", "lower"))
    assert down.measures["span_angle_deg"] == pytest.approx(
        -up.measures["span_angle_deg"], rel=1e-3)
    assert down.energy_Nmm == pytest.approx(up.energy_Nmm, rel=1e-3)
    assert down.energy_Nmm != pytest.approx(up.energy_Nmm, rel=1e-8)


# -- steps ---------------------------------------------------------------------------------------


@pytest.mark.parametrize("changes, loads", [
    ({}, {"upper": 0.04}),
    (NO_RIBS | {"n_cells": 6, "skin_thickness": 0.4}, {"upper": 0.04}),
    (NO_SKIN, {"cable": 0.2}),
    (THIN_SKIN, {"cable": 0.3}),
    (NO_SKIN, {"upper": 0.025, "cable": 0.2}),
], ids=["pressure", "thin skin", "cable", "cable, thin skin", "both"])
def test_any_split_of_the_loads_ends_in_the_same_state(changes, loads):
    one, four = (
        actuated(wing(**changes), **{name: np.linspace(0, value, n + 1)[1:]
                                     for name, value in loads.items()})[-1]
        for n in (1, 4)
    )
    assert max(map(abs, angles(one).values())) > 1.0
    for name, value in one.measures.items():
        assert four.measures[name] == pytest.approx(value, rel=1e-5, abs=1e-6), name
    assert four.energy_Nmm == pytest.approx(one.energy_Nmm, rel=1e-6)


def test_pressure_before_cable_ends_where_cable_before_pressure_does():
    first = actuated(wing(**NO_SKIN), upper=[0.02, 0.02], cable=[0.0, 0.1])[-1]
    last = actuated(wing(**NO_SKIN), upper=[0.0, 0.02], cable=[0.1, 0.1])[-1]
    for name, value in first.measures.items():
        assert last.measures[name] == pytest.approx(value, rel=1e-5), name


def test_unloaded_the_wing_is_straight_again():
    start, *_, end = actuated(wing(), upper=[0.0, 0.03, 0.0], cable=[0.0, 0.1, 0.0])
    assert end.energy_Nmm == pytest.approx(0.0, abs=1e-9)
    for name, value in start.measures.items():
        assert end.measures[name] == pytest.approx(value, abs=1e-6), name


# -- energy --------------------------------------------------------------------------------------


@pytest.mark.parametrize("changes, loads", [
    ({}, {"upper": 0.03}), (NO_SKIN, {"cable": 0.1}), (NO_SKIN, {"upper": 0.02, "cable": 0.1}),
], ids=["pressure", "cable", "both"])
def test_external_work_tends_to_the_stored_energy_with_the_square_of_the_steps(changes, loads):
    errors = []
    for n in (4, 8, 16):
        steps = {name: np.linspace(0, value, n + 1)[1:] for name, value in loads.items()}
        last = actuated(wing(**changes), **steps)[-1]
        errors.append(abs(last.external_work_Nmm / last.energy_Nmm - 1.0))
    orders = np.log2(np.array(errors[:-1]) / errors[1:])
    assert errors[-1] < 1e-3
    assert orders == pytest.approx(2.0, abs=0.1)


# -- glue ----------------------------------------------------------------------------------------


def glue_and_rib_energy(scene):
    """Energy in N mm of glue and ribs for the functions' present values."""
    x = scene.system.x.duplicate()
    scene.system.push(x)
    scene.system.pull(x)  # hands the ribs' ends on to the glue
    return [compat.assemble_scalar(MPI.COMM_SELF, compat.form(owner.energy))
            for owner in (scene.glue, scene.ribs)]


def rigid_motion(points, angle):
    """Displacement of points that turn about an axis askew and move, and the rotation vector."""
    theta = angle * np.array([2.0, -1.0, 2.0]) / 3.0
    K = np.array([[0, -theta[2], theta[1]], [theta[2], 0, -theta[0]], [-theta[1], theta[0], 0]])
    R = np.eye(3) + np.sin(angle) / angle * K + (1 - np.cos(angle)) / angle**2 * K @ K
    return points @ (R - np.eye(3)).T + np.array([1.0, -2.0, 0.5]), theta


@pytest.mark.quick
@pytest.mark.parametrize("changes", [{}, NO_SKIN], ids=["foot and bond", "foot"])
def test_a_foot_takes_over_a_rigid_motion_of_the_elastomer_without_energy(changes):
    scene = wing(**changes)
    move_elastomer(scene, lambda points: rigid_motion(points, 0.7)[0])
    apart, _ = glue_and_rib_energy(scene)
    ribs = scene.ribs.function
    u, theta = rigid_motion(ribs.function_space.tabulate_dof_coordinates(), 0.7)
    ribs.x.array[:] = np.concatenate([u, np.broadcast_to(theta, u.shape)], axis=1).ravel()
    together, bending = glue_and_rib_energy(scene)
    assert apart > 1.0
    assert abs(together) < 1e-12 * apart
    assert abs(bending) < 1e-12 * apart


@pytest.mark.parametrize("fidelity", ["draft", "standard"])
def test_glue_is_as_stiff_as_the_area_of_the_foot_and_its_second_moment(fidelity):
    scene = Wing(replace(GEOMETRY, skin_thickness=None), fidelity=fidelity, comm=MPI.COMM_SELF)
    height, width = scene.geometry.foot()
    area = {0: width * height, 5: width * height**3 / 12.0}  # pulled along x, turned about z
    for component, expected in area.items():
        small = 1e-4
        scene.ribs.function.x.array[:] = 0.0
        scene.ribs.function.x.array.reshape(-1, 6)[:, component] = small
        energy, _ = glue_and_rib_energy(scene)
        found = energy / (0.5 * scene.geometry.glue_stiffness * small**2)
        assert found == pytest.approx(expected, rel=0.05)


def test_stiffer_glue_tends_to_perfect_glue_with_the_reciprocal_of_its_stiffness():
    found = [actuated(wing(**NO_SKIN, glue_stiffness=k), cable=0.1)[-1].measures
             for k in (50.0, 500.0, 5e3, 5e4, 5e5)]
    rotation = np.array([measures["rib_1_rotation_deg"] for measures in found])
    changes = -np.diff(rotation) / rotation[1:]
    assert (changes > 0).all() and (np.diff(changes) < 0).all()
    assert changes[-2] / changes[-1] == pytest.approx(10.0, rel=0.1)
    assert changes[-1] < 1e-3


# -- contact -------------------------------------------------------------------------------------


def test_contact_is_marked_from_the_tension_on_at_which_the_skin_meets_a_rib():
    scene = wing(n_cells=4, skin_thickness=0.3, rib_positions=(0.75,))
    path = actuated(scene, cable=[0.1, 0.15, 0.3])
    found = {s.load["cable_N"]: s.measures for s in path if s.requested}
    assert [found[t]["contact"] for t in (0.1, 0.15, 0.3)] == [0.0, 0.0, 1.0]
    assert all((m["gap_mm"] < 0.0) == (m["contact"] == 1.0) for m in found.values())


@pytest.mark.quick
@pytest.mark.parametrize("changes", [{}, NO_RIBS], ids=["on a rib", "on the other side"])
@pytest.mark.parametrize("part, contact", [(0.0, 0.0), (0.5, 0.0), (1.1, 1.0)])
def test_upper_skin_pushed_through_is_contact(changes, part, contact):
    scene = wing(**changes)
    # Half-way along the pocket, by a part of the way down to the lower skin or the rib's top.
    x_dent = 0.5 * (scene.geometry.spar_end + scene.geometry.pocket_end)
    inner = float(scene.geometry.section.half_thickness(x_dent)) - 1.0
    rib = scene.geometry.rib
    way = 2.0 * inner if rib is None else inner - 0.5 * (rib.height + rib.shaft_width)

    def dent(points):
        x, y, _ = points.T
        down = np.where((x > 78.0) & (y > 1e-6), np.exp(-((x - x_dent) / 15.0) ** 2), 0.0)
        return -part * way * np.outer(down, [0.0, 1.0, 0.0])

    move_elastomer(scene, dent)
    assert scene._measures()["contact"] == contact


# -- bad input -----------------------------------------------------------------------------------


@pytest.mark.quick
@pytest.mark.parametrize("tension, shown", [(0.2, "0.2"), ([0.0, 0.1, 0.3], "0.3")])
def test_cables_without_ribs_are_refused_in_one_sentence(tension, shown):
    with pytest.raises(InputError, match=rf"^cable = {shown} N: must be 0 N or left out in a wing "
                                         r"without ribs[^\n]*$"):
        wing(**SPAR).actuate(upper=0.01, cable=tension)


@pytest.mark.quick
def test_a_slack_cable_is_no_cable():
    path = actuated(wing(**SPAR), upper=0.001, cable=np.zeros(2))
    assert len(path) == 2


@pytest.mark.quick
@pytest.mark.parametrize("changes", [SPAR, NO_SKIN], ids=["spar alone", "ribs"])
def test_cables_do_not_push(changes):
    with pytest.raises(InputError, match=r"^cable = -0\.1 N: must be 0 N or more: cables only"):
        wing(**changes).actuate(cable=[0.1, -0.1])


@pytest.mark.quick
@pytest.mark.parametrize("load, text", [
    ({"upper": float("nan")}, r"^upper = nan MPa: must be finite"),
    ({"cable": float("inf")}, r"^cable = inf N: must be finite"),
    ({"cable": "0.1 N"}, r"^cable = '0\.1 N': must be a number"),
    ({"upper": [0.01, 0.02], "cable": [0.1] * 3}, "^loads have lengths upper 2, lower 1, cable 3"),
])
def test_loads_that_are_none_are_refused_in_one_sentence(load, text):
    with pytest.raises(InputError, match=text):
        wing(**NO_SKIN).actuate(**load)


@pytest.mark.quick
@pytest.mark.parametrize("changes, text", [
    ({"aerofoil": "12"}, "^aerofoil = '12': must be four digits"),
    ({"aerofoil": "0006"}, "^top_thickness = 2 mm: must be less than .* taller than the aerofoil$"),
    ({"rib": RibGeometry.prototype(n_cells=40)}, r"^rib\.n_cells = 40: must be at most \d+, or "),
    ({"skin_thickness": 2.5}, "^skin_thickness = 2.5 mm: must be .* less than top_thickness = 2"),
    ({"cavity_length": -5.0}, "^cavity_length = -5 mm: must be greater than 0 mm$"),
    ({"middle_thickness": float("nan")}, "^middle_thickness = nan mm: must be greater than 0 mm$"),
])
def test_a_wing_that_cannot_be_built_is_refused_before_it_is_meshed(changes, text, monkeypatch):
    monkeypatch.setattr("morphing_wing.wing.wing_mesh", None)
    with pytest.raises(InputError, match=text):
        small_wing(MPI.COMM_SELF, geometry=WingGeometry.prototype(**changes))


@pytest.mark.quick
def test_a_fidelity_that_no_wing_has_is_refused_in_one_sentence():
    with pytest.raises(InputError, match=r"^fidelity = 'best': must be one of draft, standard$"):
        Wing(GEOMETRY, fidelity="best", comm=MPI.COMM_SELF, meshing=WingMeshing.coarse())
