"""The pantographic rib as a solid: bars and pivots fused by OpenCASCADE, meshed by gmsh.

Bars are prisms along z, cylinders run between them, or, with bosses and where bars are as wide as
cylinders, through them. A cylinder as wide as the bar touches its flanks along lines, which
OpenCASCADE does not survive and no mesh resolves: there the flanks are notched, by less than
`NOTCH` of the cylinder's radius and only beside the cylinder, so that both cross at an angle.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from typing import Any

import numpy as np

from morphing_wing.errors import InputError, require

from .rib import HALF, LAYERS, RibGeometry
from .tetmesh import EDGES, TetMesh, with_faces

NOTCH = 0.006
"""Depth of the flanks' notches over the radius of the cylinder; it fills all but the rims."""

_TOUCHING = 0.05  # flanks nearer than this to a cylinder's side, over its radius, are notched
_CLEARANCE = 0.02  # mm; parts nearer than that are taken to collide
_CURVED = 0.1  # smallest ratio of a curved cell's volume to the straight one's, at any node
_HALVINGS = 20  # of an edge's bend, until its cells are sound


@dataclass(frozen=True)
class Bar:
    """One bar, or a part of it.

    Attributes
    ----------
    layer, number
        Its layer (-1, 0, 1) and which bar of the layer it is, from 1.
    start, stop
        Where the part begins and ends along the bar, over its length between joints.
    """

    layer: int
    number: int
    start: float = 0.0
    stop: float = 1.0


@dataclass(frozen=True)
class Pivot:
    """A cylinder at a joint, from layer to layer: ``"T"``, ``"B"`` or ``"C"`` and its number."""

    name: str
    number: int


def rib_solid(rib: RibGeometry, around: int, half: bool = True) -> TetMesh:
    """Return the rib between x = 0 and x = n p, ends cut off along z-y planes.

    Faces are ``root`` (x = 0), ``tail`` (x = n p), ``crests`` (what is higher or lower than all
    joints) and, of a half, ``symmetry`` (z = 0).

    Parameters
    ----------
    rib
        Dimensions.
    around
        Elements around a cylinder; in bars, edges are as long as the smallest dimension is wide
        for 12, and shorter in proportion.
    half
        Whether only what lies at z > 0.

    Raises
    ------
    InputError
        If parts collide that are not joined.
    """
    n, length = rib.n_cells, rib.length
    layers = HALF if half else LAYERS[rib.layers]
    bars = [Bar(layer, i) for layer in layers for i in range(1, n + 1)]
    pivots = [Pivot(name, i) for name in "TB" for i in range(1, n)]
    pivots += [Pivot("C", i) for i in range(1, n + 1)]
    at = {"root": lambda x: np.abs(x[:, 0]) < 1e-6,
          "tail": lambda x: np.abs(x[:, 0] - length) < 1e-6,
          "crests": lambda x: np.abs(x[:, 1]) > 0.5 * rib.height}
    return meshed(rib, bars, pivots, around, half, at)


def meshed(
    rib: RibGeometry, bars: list[Bar], pivots: list[Pivot], around: int, half: bool,
    faces: dict[str, Any], bodies: int = 1,
) -> TetMesh:
    """Return some bars and pivots of a rib as one mesh; see `rib_solid` and `with_faces`.

    ``bodies`` is how many solids that are not joined they must make.
    """
    check_room(rib)
    if half:
        faces = faces | {"symmetry": lambda x: np.abs(x[:, 2]) < 1e-6}
    size = 12 / around * min(rib.shaft_width, rib.shaft_thickness, rib.pivot_diameter)
    with _gmsh() as gmsh:
        build = gmsh.model.occ
        shapes = [_add_bar(build, rib, bar, half) for bar in bars]
        shapes += [tag for pivot in pivots for tag in _add_pivot(build, rib, pivot, half)]
        solids = [(3, tag) for tag in shapes]
        if len(solids) > 1:
            build.fuse(solids[:1], solids[1:])
        build.synchronize()
        parts = len(gmsh.model.getEntities(3))
        if parts != bodies:
            raise RuntimeError(f"the rib's parts were fused to {parts} bodies, must be {bodies}")
        for name, value in {
            "CharacteristicLengthMax": size, "CharacteristicLengthFromCurvature": 1,
            "MinimumElementsPerTwoPi": around, "CharacteristicLengthMin": 0.1 * size,
            "Optimize": 1,
        }.items():
            gmsh.option.setNumber(f"Mesh.{name}", value)
        gmsh.model.mesh.generate(3)
        gmsh.model.mesh.setOrder(2)
        points, cells = _taken(gmsh)
    return _unfolded(with_faces(points, cells, faces))


def check_room(rib: RibGeometry) -> None:
    """Refuse a rib of two layers, and one of which parts collide that are not joined.

    Raises
    ------
    InputError
        If there is no middle layer to halve, or if neighbouring bars of a layer collide: they
        are l_rs/2 sin(alpha) apart, and one has a cylinder where the other passes.
    """
    require(rib.layers == 3, "layers", rib.layers, "", "3 for a rib as a solid, which is halved")
    apart = 0.5 * rib.shaft_length * math.sin(math.radians(rib.crossing_angle))
    needed = 0.5 * rib.shaft_width + max(0.5 * rib.pivot_diameter, 0.5 * rib.shaft_width)
    if apart < needed + _CLEARANCE:
        raise InputError(
            f"crossing_angle = {rib.crossing_angle:g} degrees: neighbouring shafts of a layer are "
            f"{apart:.4g} mm apart, and collide with the pivots on each other: must leave "
            f"{needed + _CLEARANCE:.4g} mm between their axes")


# -- parts ------------------------------------------------------------------------------------


def _add_bar(build: Any, rib: RibGeometry, bar: Bar, half: bool) -> int:
    """Add a prism, return its tag."""
    outline, bend = _outline(rib, bar)
    depth, z = rib.shaft_thickness, bar.layer * rib.spacing
    bottom, height = (z, 0.5 * depth) if half and bar.layer == 0 else (z - 0.5 * depth, depth)
    tags = [build.addPoint(x, y, bottom) for x, y in outline]
    lines = []
    for i, tag in enumerate(tags):
        nxt = tags[(i + 1) % len(tags)]
        if i in bend:
            centre = build.addPoint(*bend[i], bottom)
            lines.append(build.addCircleArc(tag, centre, nxt))
        else:
            lines.append(build.addLine(tag, nxt))
    face = build.addPlaneSurface([build.addCurveLoop(lines)])
    return next(tag for dim, tag in build.extrude([(2, face)], 0.0, 0.0, height) if dim == 3)


def _add_pivot(build: Any, rib: RibGeometry, pivot: Pivot, half: bool) -> list[int]:
    """Add the cylinders of a joint, return their tags."""
    x, y, _ = rib.joint(pivot.name, pivot.number)
    overlap = 0.5 * rib.shaft_thickness * (1.0 if rib.runs_through else -1.0)
    if half:
        spans = [(max(overlap * -1.0, 0.0), rib.spacing + overlap)]
    elif rib.runs_through:
        spans = [(-rib.spacing - overlap, rib.spacing + overlap)]
    else:
        spans = [(-rib.spacing - overlap, overlap), (-overlap, rib.spacing + overlap)]
    return [build.addCylinder(x, y, low, 0.0, 0.0, high - low, 0.5 * rib.pivot_diameter)
            for low, high in spans]


def _outline(
    rib: RibGeometry, bar: Bar
) -> tuple[list[tuple[float, float]], dict[int, tuple[float, float]]]:
    """Return the corners of a bar in its plane, and which edges are arcs about which centres."""
    a, b = (np.array(rib.joint(*key)[:2]) for key in rib.bar_ends(bar.layer, bar.number))
    along = (b - a) / rib.shaft_length
    across = np.array([-along[1], along[0]])
    half = 0.5 * rib.shaft_width
    flank = np.array(_flank(rib, bar.start, bar.stop))
    t, w = rib.shaft_length * flank[:, 0], flank[:, 1]
    lower = a + t[:, None] * along - w[:, None] * across
    upper = a + t[:, None] * along + w[:, None] * across
    at_root = bar.start == 0.0 and bar.number == 1
    at_tail = bar.stop == 1.0 and bar.number == rib.n_cells
    for cut, row, x in ((at_root, 0, 0.0), (at_tail, -1, rib.length)):
        if cut:  # off by the plane through the joint
            for side in (lower, upper):
                side[row] += (x - side[row][0]) / along[0] * along
    outline = [tuple(p) for p in lower] + [tuple(p) for p in upper[::-1]]
    bend = {}
    if not rib.runs_through:  # else the cylinder is the bar's end
        if bar.stop == 1.0 and not at_tail:
            outline.insert(len(lower), tuple(b + half * along))
            bend |= {len(lower) - 1: tuple(b), len(lower): tuple(b)}
        if bar.start == 0.0 and not at_root:
            outline.append(tuple(a - half * along))
            bend |= {len(outline) - 2: tuple(a), len(outline) - 1: tuple(a)}
    return outline, bend


def _flank(rib: RibGeometry, start: float, stop: float) -> list[tuple[float, float]]:
    """Return places along a bar over its length, and its half width there in mm."""
    R, half = 0.5 * rib.pivot_diameter, 0.5 * rib.shaft_width
    if abs(half - R) > _TOUCHING * R:
        return [(start, half), (stop, half)]
    deep, reach = min((1.0 - NOTCH) * R, half), 0.5 * R / rib.shaft_length
    knots = {}
    for joint in (0.0, 0.5, 1.0):
        knots |= {joint - reach: half, joint: deep, joint + reach: half}
    knots = {t: w for t, w in knots.items() if start < t < stop}
    ends = {t: deep if t in (0.0, 1.0) else half for t in (start, stop)}
    return sorted((knots | ends).items())


# -- gmsh -------------------------------------------------------------------------------------


@contextmanager
def _gmsh() -> Iterator[Any]:
    import gmsh  # optional and slow to load

    ours = not getattr(gmsh, "isInitialized", bool)()  # gmsh 4.8 cannot tell
    if ours:
        gmsh.initialize(["morphing-wing"], readConfigFiles=False)
    gmsh.option.setNumber("General.Terminal", 0)
    gmsh.model.add("rib")
    try:
        yield gmsh
    finally:
        gmsh.model.remove()
        if ours:
            gmsh.finalize()


def _taken(gmsh: Any) -> tuple[np.ndarray, np.ndarray]:
    """Return points and ten-node tetrahedra in the order of finite elements."""
    tags, coordinates, _ = gmsh.model.mesh.getNodes()
    _, vertices = gmsh.model.mesh.getElementsByType(11)
    used, cells = np.unique(vertices, return_inverse=True)
    row = np.empty(int(tags.max()) + 1, dtype=np.int64)
    row[tags.astype(np.int64)] = np.arange(len(tags))
    points = np.reshape(coordinates, (-1, 3))[row[used.astype(np.int64)]]
    # gmsh's edges are (0,1), (1,2), (0,2), (0,3), (2,3), (1,3).
    return points, cells.reshape(-1, 10)[:, [0, 1, 2, 3, 8, 9, 5, 7, 6, 4]]


def _unfolded(mesh: TetMesh) -> TetMesh:
    """Return the mesh with less bent edges where bent ones fold a cell, as they do thin ones."""
    points = mesh.points.copy()
    for _ in range(_HALVINGS):
        bad = TetMesh(points, mesh.cells, mesh.facets).smallest_jacobian() < _CURVED
        if not bad.any():
            break
        middles, first = np.unique(mesh.cells[bad, 4:], return_index=True)
        ends = points[mesh.cells[bad][:, EDGES].reshape(-1, 2)[first]]
        points[middles] = 0.5 * (points[middles] + ends.mean(axis=1))
    return TetMesh(points, mesh.cells, mesh.facets)
