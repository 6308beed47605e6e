"""Swept hexahedra of the wing's elastomer: aerofoil-shaped spar and skin."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from .hexmesh import HexMesh, breakpoints, swept_blocks, two_sided, uniform
from .seams import with_seams
from .wing import WingGeometry

# Kinds of blocks: solid ones are positive.
_SPAR, _SKIN, _TIP_WALL, _UPPER, _LOWER, _POCKET, _NOTHING = 1, 2, 3, -1, -2, -3, -9
# Levels of the height coordinate: middle layer to 1, chamber to 2, inner and outer wall to 3 and 4.
_TOP = 4.0


@dataclass(frozen=True)
class WingMeshing:
    """Intervals of each piece of the wing, as breakpoints in [0, 1].

    Attributes
    ----------
    nose, cavity_width, side_thickness, pocket, tail : (n,) arrays
        Along the chord.
    cavity_height, middle_thickness, top_thickness, skin_thickness : (n,) arrays
        Along the height; the skin is the outer part of the wall over the chambers,
        ``top_thickness`` the rest.
    cavity_length, wall_length : (n,) arrays
        Along the span.
    """

    nose: np.ndarray
    cavity_width: np.ndarray
    side_thickness: np.ndarray
    pocket: np.ndarray
    tail: np.ndarray
    cavity_height: np.ndarray
    middle_thickness: np.ndarray
    top_thickness: np.ndarray
    skin_thickness: np.ndarray
    cavity_length: np.ndarray
    wall_length: np.ndarray

    @classmethod
    def of(cls, **counts: int | np.ndarray) -> WingMeshing:
        """Return a meshing with numbers of intervals (or breakpoints) a piece; 1 if not named."""
        pieces = dict.fromkeys(cls.__dataclass_fields__, 1) | counts
        return cls(**{name: uniform(value) if isinstance(value, int) else value
                      for name, value in pieces.items()})

    @classmethod
    def coarse(cls) -> WingMeshing:
        """Return one interval a wall and a chamber, for quadratic elements."""
        return cls.of(cavity_width=6, pocket=9)

    @classmethod
    def graded(cls) -> WingMeshing:
        """Return a mesh graded towards the chambers' corners, for quadratic elements."""
        return cls.of(cavity_width=two_sided(6, 2.0), pocket=9, cavity_length=two_sided(3, 3.0))

    @classmethod
    def resolved(cls) -> WingMeshing:
        """Return two quadratic elements through each wall, and five graded ones along a chamber."""
        return cls.of(
            cavity_width=two_sided(8, 2.0), pocket=9, cavity_length=two_sided(5, 2.5),
            cavity_height=2, wall_length=2, top_thickness=2, middle_thickness=2, side_thickness=2)

    @classmethod
    def fine(cls) -> WingMeshing:
        """Return a mesh for linear elements; in height it resolves the ribs' feet."""
        return cls.of(cavity_width=8, pocket=10, cavity_height=two_sided(4, 2.0), cavity_length=2)


def wing_mesh(geometry: WingGeometry, meshing: WingMeshing) -> HexMesh:
    """Return swept hexahedra; x chordwise from the leading edge, y up, z along the span.

    Regions: ``spar`` and ``skin``, and ``tip_wall`` where there is one. Faces: ``root`` (what is
    clamped at z = 0), ``tip`` (the spar's end), ``upper_chambers``, ``lower_chambers``,
    ``rear_wall`` (where ribs are glued), and with a skin ``pocket_upper``, ``pocket_lower`` (its
    inner sides), ``trailing_edge``.
    """
    wing, parts, skin = geometry, meshing, geometry.skin_thickness is not None
    pieces = [(wing.nose_length, parts.nose),
              (wing.cavity_end - wing.nose_length, parts.cavity_width),
              (wing.side_thickness, parts.side_thickness)]
    if skin:
        pieces += [(wing.pocket_end - wing.spar_end, _with_end_of_tip_wall(wing, parts.pocket)),
                   (wing.chord - wing.pocket_end, parts.tail)]
    x, x_piece = breakpoints(*pieces)
    cavity_height = _with_foot_edge(wing, parts.cavity_height)
    upper = [(1.0, cavity_height), (1.0, parts.top_thickness), (1.0, parts.skin_thickness)]
    lower = [(length, 1.0 - part[::-1]) for length, part in reversed(upper)]
    v, v_piece = breakpoints(*lower, (2.0, parts.middle_thickness), *upper)
    cell = [(wing.cavity_length, parts.cavity_length), (wing.wall_length, parts.wall_length)]
    z, z_piece = breakpoints((wing.wall_length, parts.wall_length), *cell * wing.n_cells)

    kind = np.full((len(x_piece), len(v_piece), len(z_piece)), _SPAR)
    for row, value in ((4, _UPPER), (2, _LOWER)):
        kind[np.ix_(x_piece == 1, v_piece == row, z_piece % 2 == 1)] = value
    behind, outer = x_piece >= 3, (v_piece == 0) | (v_piece == 6)
    kind[np.ix_(behind, outer)] = _SKIN
    kind[np.ix_(x_piece == 3, ~outer)] = _POCKET
    kind[np.ix_(x_piece == 4, ~outer)] = _NOTHING
    names = {_SPAR: "spar", _SKIN: "skin", _UPPER: "upper_chambers", _LOWER: "lower_chambers",
             _POCKET: "pocket"}
    if wing.tip_wall:
        # Hexahedra cannot fill the sharp end, where all levels meet: there the tip stays open.
        filled = np.where(x[1:][x_piece == 3] < wing.tip_wall_end + 1e-9, _TIP_WALL, _NOTHING)
        at_tip = z_piece == z_piece[-1]
        kind[np.ix_(x_piece == 3, ~outer, at_tip)] = filled[:, None, None]
        names[_TIP_WALL] = "tip_wall"

    def faces(midpoints: np.ndarray, normals: np.ndarray) -> dict[str, np.ndarray]:
        in_spar = midpoints[:, 0] < wing.spar_end + 1e-9
        held = in_spar | (wing.skin_root == "clamped")
        named = {"root": (normals[:, 2] < 0) & held, "tip": (normals[:, 2] > 0) & in_spar}
        named["trailing_edge" if skin else "rear_wall"] = normals[:, 0] > 0
        return named

    def mapping(grid: np.ndarray) -> np.ndarray:
        return _to_aerofoil(wing, grid - np.array([0.0, _TOP, 0.0]))

    mesh = swept_blocks((x, v, z), kind, names, mapping, faces)
    return with_seams(_with_pocket_sides(mesh), wing) if skin else mesh


def _with_foot_edge(wing: WingGeometry, fractions: np.ndarray) -> np.ndarray:
    """Return a chamber's breakpoints with one at the edge of the ribs' feet on the rear wall."""
    if wing.rib is None:
        return fractions
    bottom = wing.middle_thickness / 2.0
    top = float(wing.section.half_thickness(wing.spar_end)) - wing.outer_wall
    edge = (wing.foot()[0] / 2.0 - bottom) / (top - bottom)
    if not 0.02 < edge < 0.98:
        return fractions
    return _with_point(fractions, edge, apart=0.1)


def _with_end_of_tip_wall(wing: WingGeometry, fractions: np.ndarray) -> np.ndarray:
    """Return the pocket's breakpoints with one at the end of its tip wall."""
    if not wing.tip_wall:
        return fractions
    end = (wing.tip_wall_end - wing.spar_end) / (wing.pocket_end - wing.spar_end)
    return _with_point(fractions, end, apart=0.02)


def _with_point(fractions: np.ndarray, point: float, apart: float) -> np.ndarray:
    """Return breakpoints with one more, in place of the nearest if that is less than apart."""
    inner = fractions[1:-1]
    if len(inner) and np.abs(inner - point).min() < apart:
        inner = np.delete(inner, np.abs(inner - point).argmin())
    return np.concatenate([[0.0], np.sort(np.append(inner, point)), [1.0]])


def _to_aerofoil(wing: WingGeometry, grid: np.ndarray) -> np.ndarray:
    """Map (x, level, z) to points in mm."""
    x, level, z = grid.T
    section = wing.section
    behind_nose = np.maximum(x, wing.nose_length)
    y = np.sign(level) * _height(wing, behind_nose, np.abs(level))
    # In the nose, columns run from its rear edge to points of the contour around the leading edge.
    part = np.clip(x / wing.nose_length, 0.0, 1.0)
    bluntest = 0.1 * wing.nose_length
    front_y = y / section.half_thickness(wing.nose_length) * section.half_thickness(bluntest)
    in_nose = part < 1.0
    front_x = np.zeros_like(x)
    for value in np.unique(np.abs(front_y[in_nose])):
        same = np.abs(front_y) == value
        value = min(value, float(section.half_thickness(bluntest)))
        front_x[same] = section.x_where_half_thickness(value, front=True) if value > 0 else 0.0
    x = np.where(in_nose, (1 - part) * front_x + part * wing.nose_length, x)
    y = np.where(in_nose, (1 - part) * front_y + part * y, y)
    return np.stack([x, y + section.camber(x), z], axis=1)


def _height(wing: WingGeometry, x: np.ndarray, level: np.ndarray) -> np.ndarray:
    """Return the height in mm above the mean line at a level between 0 and 4."""
    outside = wing.section.half_thickness(x)
    skin = wing.skin_thickness or wing.top_thickness / 2.0
    inside = np.maximum(outside - skin, 0.0)
    inside[x > _closed(wing)] = 0.0
    chamber = [np.full_like(x, wing.middle_thickness / 2.0), outside - wing.outer_wall]
    behind = x > wing.spar_end
    if behind.any():
        # In a tip wall the levels of the spar's end become lower with the pocket.
        front = wing.section.half_thickness(wing.spar_end)
        ends = wing.middle_thickness / 2.0, front - wing.outer_wall
        for height, end in zip(chamber, ends, strict=True):
            height[behind] = end / (front - skin) * inside[behind]
    heights = np.stack([np.zeros_like(x), *chamber, inside, outside])
    below = np.minimum(level.astype(int), 3)
    column = np.arange(len(x))
    low, high = heights[below, column], heights[below + 1, column]
    return low + (level - below) * (high - low)


def _closed(wing: WingGeometry) -> float:
    return np.inf if wing.skin_thickness is None else wing.pocket_end - 1e-9


def _with_pocket_sides(mesh: HexMesh) -> HexMesh:
    """Name the pocket's sides by where their facets look."""
    facets = dict(mesh.facets)
    pocket = facets.pop("pocket")
    for name, side in (("rear_wall", 3), ("pocket_upper", 1), ("pocket_lower", 4)):
        facets[name] = pocket[pocket[:, 1] == side]
    return replace(mesh, facets=facets)
