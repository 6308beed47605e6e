"""Pieces of the half rib between cuts through its bars: of them a rib of any length is made.

Each bar is cut perpendicularly a quarter of its length from its first joint, where it is plain.
Between the cuts through bars k and those through bars k + 1 lies a cell, the same for all k;
before the first cuts lies the root's piece, behind the last ones the tail's.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

import numpy as np

from morphing_wing.errors import InputError

from .frame import Frame, local_axes
from .rib import HALF, RibGeometry
from .rib_solid import Bar, Pivot, meshed
from .section import Lattice
from .tetmesh import TetMesh

CUT = 0.25
"""Where a bar is cut, over its length between joints."""


PIECES = ("root", "cell", "tail")

_NEAR = 1e-6


@dataclass(frozen=True)
class Cut:
    """The section of a cut bar.

    Attributes
    ----------
    layer
        0, of which the half z > 0 is there, or 1.
    place : (3,) array
        Its middle (of the whole section, where it is halved), mm.
    along, across : (3,) arrays
        Unit vectors: its normal, and the one in it that is perpendicular to z.
    half_width, half_depth
        Along ``across`` and z, mm.
    """

    layer: int
    place: np.ndarray
    along: np.ndarray
    across: np.ndarray
    half_width: float
    half_depth: float

    def coordinates(self, x: np.ndarray) -> np.ndarray:
        """Return places (k, 3) in the section over its half width and depth, shape (k, 2)."""
        away = x - self.place
        return np.stack([away @ self.across / self.half_width, away[:, 2] / self.half_depth], 1)

    def holds(self, x: np.ndarray) -> np.ndarray:
        """Return whether places (k, 3) are in the section."""
        inside = (np.abs(self.coordinates(x)) < 1.0 + _NEAR).all(axis=1)
        return inside & (np.abs((x - self.place) @ self.along) < _NEAR)


def cut(rib: RibGeometry, layer: int, number: int) -> Cut:
    """Return where bar ``number`` of a layer is cut."""
    start, end = (np.array(rib.joint(*key, layer)) for key in rib.bar_ends(layer, number))
    along = (end - start) / rib.shaft_length
    across = np.array([-along[1], along[0], 0.0])
    return Cut(layer, start + CUT * (end - start), along, across, 0.5 * rib.shaft_width,
               0.5 * rib.shaft_thickness)


def axis_points(rib: RibGeometry) -> np.ndarray:
    """Return x in mm of the root, the middles of the cuts and the tail, shape (n + 2,)."""
    n = rib.n_cells
    return rib.pitch * np.array([0.0, *(np.arange(n) + CUT), n])


def piece_of(link: int, n_cells: int) -> str:
    """Return which piece lies between the axis points ``link`` and ``link + 1``."""
    return PIECES[(link > 0) + (link == n_cells)]


def link_frame(rib: RibGeometry) -> Frame:
    """Return the links between the axis points, with the volume of all bars shared among them."""
    bars, n = rib.frame(), rib.n_cells
    points = np.zeros((n + 2, 3))
    points[:, 0] = axis_points(rib)
    links = np.arange(n + 1)[:, None] + [0, 1]
    area = float(bars.areas() @ bars.lengths()) / rib.length
    whole = Lattice(area, rib.height + rib.pivot_diameter)
    return Frame(
        points=points, bars=links, names=PIECES, axes=local_axes(points, links),
        kinds=np.array([PIECES.index(piece_of(link, n)) for link in range(n + 1)]),
        sections=(dict.fromkeys(PIECES, whole),), ribs=np.zeros(n + 1, dtype=int),
        roots=np.array([0]), tails=np.array([n + 1]))


def one_cell(rib: RibGeometry) -> RibGeometry:
    """Return the rib of one cell, to which root and tail piece belong whatever the length."""
    return replace(rib, n_cells=1)


def cuts(rib: RibGeometry, piece: str) -> dict[str, Cut]:
    """Return the cuts of a piece by the names of their faces, see `rib_piece`."""
    ends = {"root": {"stop": 1}, "cell": {"start": 1, "stop": 2}, "tail": {"start": 1}}[piece]
    return {f"{end}_{layer}": cut(rib, layer, number)
            for end, number in ends.items() for layer in HALF}


def rib_piece(rib: RibGeometry, piece: str, around: int) -> TetMesh:
    """Return the root's piece, the first cell or, of a rib of one cell, the tail's piece.

    Faces are ``symmetry`` (z = 0), ``start_0``, ``start_1``, ``stop_0`` and ``stop_1`` (cuts
    towards root and tail, by layer), ``root`` (x = 0) and ``tail`` (x = p), where there are any.

    Parameters
    ----------
    rib
        Dimensions; the number of cells does not matter.
    piece
        "root", "cell" or "tail".
    around
        Elements around a cylinder, see `morphing_wing.geometry.rib_solid`.

    Raises
    ------
    InputError
        If parts collide that are not joined, or the root's plane meets the cuts.
    """
    check_cuts(rib)
    faces = {name: found.holds for name, found in cuts(rib, piece).items()}
    if piece == "root":
        bars, pivots = [Bar(layer, 1, 0.0, CUT) for layer in HALF], []
        faces["root"] = lambda x: np.abs(x[:, 0]) < _NEAR
        return meshed(one_cell(rib), bars, pivots, around, True, faces, bodies=len(bars))
    bars, pivots = [Bar(layer, 1, CUT, 1.0) for layer in HALF], [Pivot("C", 1)]
    if piece == "tail":
        faces["tail"] = lambda x: np.abs(x[:, 0] - rib.pitch) < _NEAR
        return meshed(one_cell(rib), bars, pivots, around, True, faces)
    bars += [Bar(layer, 2, 0.0, CUT) for layer in HALF]
    pivots += [Pivot(name, 1) for name in "TB"]
    return meshed(replace(rib, n_cells=2), bars, pivots, around, True, faces)


def check_cuts(rib: RibGeometry) -> None:
    """Refuse a rib whose bars are so wide and steep that the root's plane meets the cuts.

    Raises
    ------
    InputError
        If it does.
    """
    reach = 0.5 * rib.shaft_width * math.tan(math.radians(rib.crossing_angle) / 2.0)
    room = CUT * rib.shaft_length
    if reach > 0.95 * room:
        raise InputError(
            f"crossing_angle = {rib.crossing_angle:g} degrees: the root cuts shafts off over "
            f"{reach:.4g} mm of their length: must be at most {0.95 * room:.4g} mm for a rib that "
            "is made of one cell")
