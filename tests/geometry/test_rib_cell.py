"""Pieces of a rib between cuts: named faces, and together the whole rib."""

import numpy as np
import pytest

from morphing_wing.errors import InputError
from morphing_wing.geometry.rib import RibGeometry
from morphing_wing.geometry.rib_cell import PIECES, check_cuts, cut, cuts, rib_piece
from morphing_wing.geometry.rib_solid import NOTCH, rib_solid
from morphing_wing.geometry.tetmesh import FACET_VERTICES

pytestmark = pytest.mark.quick

AROUND = 12
RIBS = {"square": RibGeometry.validation("square", True), "flush": RibGeometry.prototype(3)}


@pytest.fixture(scope="module", params=RIBS)
def rib(request):
    return RIBS[request.param]


@pytest.fixture(scope="module")
def pieces(rib):
    return {piece: rib_piece(rib, piece, AROUND) for piece in PIECES}


def area(mesh, face):
    cells, facets = mesh.facets[face].T
    a, b, c = np.moveaxis(mesh.points[mesh.cells[cells[:, None], FACET_VERTICES[facets]]], 1, 0)
    return 0.5 * np.linalg.norm(np.cross(b - a, c - a), axis=1).sum()


def test_each_piece_has_the_faces_of_its_ends(pieces):
    assert set(pieces["root"].facets) == {"root", "stop_0", "stop_1", "symmetry"}
    assert set(pieces["cell"].facets) == {"start_0", "start_1", "stop_0", "stop_1", "symmetry"}
    assert set(pieces["tail"].facets) == {"start_0", "start_1", "tail", "symmetry"}


def test_cuts_have_the_area_of_the_bars_half_of_it_in_the_middle_layer(rib, pieces):
    section = rib.shaft_width * rib.shaft_thickness
    for piece, mesh in pieces.items():
        for face in cuts(rib, piece):
            share = 0.5 if face.endswith("_0") else 1.0
            assert area(mesh, face) == pytest.approx(share * section, rel=1e-9)


def test_both_layers_root_and_tail_are_as_large(rib, pieces):
    # A plane cuts a bar off along the width over cos(beta), but for a notch beside a pivot.
    along = np.cos(np.radians(rib.crossing_angle) / 2.0)
    ends = 1.5 * rib.shaft_width * rib.shaft_thickness / along
    assert area(pieces["root"], "root") == pytest.approx(ends, rel=NOTCH)
    assert area(pieces["tail"], "tail") == pytest.approx(ends, rel=NOTCH)


def test_pieces_fill_the_rib(rib, pieces):
    volume = {piece: mesh.volume() for piece, mesh in pieces.items()}
    whole = rib_solid(rib, AROUND).volume()
    assert volume["root"] + (rib.n_cells - 1) * volume["cell"] + volume["tail"] == pytest.approx(
        whole, rel=1e-3)


def test_cut_middles_are_a_quarter_of_the_bar_from_its_joint():
    rib = RibGeometry.validation()
    np.testing.assert_allclose(cut(rib, 0, 1).place, [rib.pitch / 4, -rib.height / 4, 0.0])
    np.testing.assert_allclose(
        cut(rib, 1, 3).place, [2.25 * rib.pitch, rib.height / 4, rib.spacing])


def test_bars_too_steep_and_wide_for_a_cut_are_refused():
    with pytest.raises(InputError, match="the root cuts shafts off over 1.538 mm of their length"):
        check_cuts(RibGeometry(5.5, 1.0, 1.5, 5.0, 128.0, 3))
