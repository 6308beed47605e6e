"""The wing as a scene has, costs and measures only what it needs."""

import numpy as np
import pytest

from morphing_wing import compat
from morphing_wing.forms.enhanced import N_MODES
from morphing_wing.geometry.wing_mesh import wing_mesh
from tests.scenes.small_wing import GEOMETRY, MESHING, NO_RIBS, NO_SKIN, SPAR, actuated, wing


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
    mass, moves = scene.body.lumped_volume("skin"), scene.body.is_displacement()
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
    (SPAR, {"span_angle_deg"}, {"chord_angle_deg", "rib_1_rotation_deg", "touching"}),
    (NO_SKIN, {"chord_angle_deg", "rib_1_rotation_deg"}, {"gap_mm", "touching"}),
    (NO_RIBS, {"chord_angle_deg", "gap_mm", "touching"}, {"rib_1_rotation_deg", "contact"}),
], ids=["spar alone", "no skin", "no ribs"])
def test_only_what_a_wing_has_is_measured(changes, present, absent):
    found = set(actuated(wing(**changes), upper=0.001)[-1].measures)
    assert present <= found and not absent & found
