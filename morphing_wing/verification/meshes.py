"""Meshes of the problems with known answers."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from itertools import permutations

import numpy as np

from morphing_wing.geometry.hexmesh import HexMesh, geometric, swept_blocks, uniform
from morphing_wing.geometry.tetmesh import EDGES, TetMesh, with_faces

__all__ = ["SIDES", "cook", "cube", "cylinder", "disc", "distorted", "octant", "prism",
           "tetrahedra", "tube"]

SIDES = tuple(f"{axis}{sign}" for axis in "xyz" for sign in "-+")
"""Names of the outer faces of what is made from a cube."""


def _sides(midpoints: np.ndarray, normals: np.ndarray) -> dict[str, np.ndarray]:
    return {f"{axis}{sign}": normals[:, i] * step > 0
            for i, axis in enumerate("xyz") for sign, step in (("-", -1), ("+", 1))}


def cube(n: int = 3, warp: float = 0.08, affine: np.ndarray | None = None) -> HexMesh:
    """Return the unit cube in n^3 hexahedra, distorted inside by ``warp``, then by a matrix."""

    def mapping(x: np.ndarray) -> np.ndarray:
        moved = distorted(x, warp)
        return moved if affine is None else moved @ affine.T

    return swept_blocks((uniform(n),) * 3, np.ones((n, n, n), int), {1: "body"}, mapping, _sides)


def distorted(x: np.ndarray, warp: float = 0.08) -> np.ndarray:
    """Return points of the unit cube moved by ``warp`` mm at most, those of its faces not at all.

    Edges between them are curved where their middles are moved too.
    """
    inside = np.prod(4.0 * x * (1.0 - x), axis=1)[:, None]
    return x + warp * inside * np.stack([
        np.cos(5 * x[:, 1] + x[:, 2]), np.sin(4 * x[:, 2] - x[:, 0]),
        np.cos(6 * x[:, 0] + 2 * x[:, 1])], axis=1)


def tetrahedra(n: int = 2, mapping: Callable[[np.ndarray], np.ndarray] = distorted) -> TetMesh:
    """Return the unit cube in n^3 cubes of six tetrahedra, all their nodes then mapped.

    Each has the cube's diagonal and goes from one of its ends to the other along three edges
    (Kuhn, IBM J. Res. Dev. 4 (1960) 518-524).
    """
    # In half edges of a cube, so that the middles of edges have whole numbers too.
    ways = np.array([np.cumsum(np.vstack([np.zeros(3, int), 2 * np.eye(3, dtype=int)[list(order)]]),
                               axis=0) for order in permutations(range(3))])
    mirrored = np.linalg.det(ways[:, 1:]) < 0
    ways[mirrored] = ways[mirrored][:, [0, 2, 1, 3]]
    corners = 2 * np.stack(np.indices((n,) * 3), axis=-1).reshape(-1, 1, 1, 3)
    vertices = (corners + ways).reshape(-1, 4, 3)
    nodes = np.concatenate([vertices, vertices[:, EDGES].sum(axis=2) // 2], axis=1)
    shape = (2 * n + 1,) * 3
    points = np.stack(np.indices(shape), axis=-1).reshape(-1, 3) / (2.0 * n)
    planes = {f"{axis}{sign}": lambda x, i=i, at=at: np.abs(x[:, i] - at) < 1e-9
              for i, axis in enumerate("xyz") for sign, at in (("-", 0.0), ("+", 1.0))}
    mesh = with_faces(points, np.ravel_multi_index(tuple(np.moveaxis(nodes, -1, 0)), shape), planes)
    return TetMesh(mapping(points), mesh.cells, mesh.facets)


def tube(x: np.ndarray) -> np.ndarray:
    """Return points of the unit cube as those of a quarter of a tube: radii 1 and 2, length 1."""
    r, angle = 1.0 + x[:, 0], np.pi / 2 * x[:, 1]
    return np.stack([r * np.cos(angle), r * np.sin(angle), x[:, 2]], axis=1)


def prism(size: Sequence[float], n: Sequence[int]) -> HexMesh:
    """Return a box of a size in mm from the origin, in n hexahedra along its edges."""
    lines = tuple(length * uniform(m) for length, m in zip(size, n, strict=True))
    return swept_blocks(lines, np.ones(n, int), {1: "body"}, None, _sides)


def cook(n: int) -> HexMesh:
    """Return Cook's tapered panel in n x n hexahedra, one layer of 1 mm."""

    def mapping(x: np.ndarray) -> np.ndarray:
        s, t, z = x.T
        lower, upper = 44.0 * s, 44.0 + 16.0 * s
        return np.stack([48.0 * s, lower + t * (upper - lower), z], axis=1)

    return swept_blocks((uniform(n), uniform(n), uniform(1)), np.ones((n, n, 1), int),
                        {1: "body"}, mapping, _sides)


def cylinder(inner: float, outer: float, n: int = 5, layers: int = 4) -> HexMesh:
    """Return a quarter of a tube, 0.4 mm of its length; planes of symmetry at its ends."""
    lines = (inner + (outer - inner) * geometric(layers, 1.3), uniform(n) * np.pi / 2,
             np.array([0.0, 0.4]))

    def mapping(grid: np.ndarray) -> np.ndarray:
        r, angle, z = grid.T
        return np.stack([r * np.cos(angle), r * np.sin(angle), z], axis=1)

    def faces(midpoints: np.ndarray, normals: np.ndarray) -> dict[str, np.ndarray]:
        return {"inner": normals[:, 0] < 0, "y": normals[:, 1] < 0, "x": normals[:, 1] > 0,
                "ends": normals[:, 2] != 0}

    return swept_blocks(lines, np.ones((layers, n, 1), int), {1: "body"}, mapping, faces)


def octant(inner: float, outer: float, n: int = 3, layers: int = 3) -> HexMesh:
    """Return an eighth of a hollow sphere: a block for each face of a cube that meets there."""
    lines = (uniform(n), uniform(n), inner + (outer - inner) * geometric(layers, 1.3))
    blocks = []
    for axis in range(3):
        def mapping(grid: np.ndarray, axis: int = axis) -> np.ndarray:
            direction = np.column_stack([np.tan(grid[:, :2] * np.pi / 4), np.ones(len(grid))])
            x = grid[:, 2:] * direction / np.linalg.norm(direction, axis=1)[:, None]
            return np.roll(x, axis, axis=1)

        def faces(
            midpoints: np.ndarray, normals: np.ndarray, axis: int = axis
        ) -> dict[str, np.ndarray]:
            return {"inner": normals[:, 2] < 0, "xyz"[axis]: normals[:, 0] < 0,
                    "xyz"[(1 + axis) % 3]: normals[:, 1] < 0}

        blocks.append(swept_blocks(lines, np.ones((n, n, layers), int), {1: "body"}, mapping,
                                   faces))
    return _merged(blocks)


def disc(radius: float, thickness: float, n: int = 4) -> HexMesh:
    """Return a quarter of a disc below z = 0 in three blocks of n x n cells, finer at the rim.

    Faces: ``top``, ``rim``, and ``x``, ``y`` in the planes of symmetry.
    """
    h, k = 0.5 * radius, 0.4 * radius
    on_arc = radius / np.sqrt(2.0)
    # Corners of each block, from (0, 0) counter-clockwise, and the sides that lie outside.
    corners = {
        "middle": [(0, 0), (h, 0), (k, k), (0, h)],
        "right": [(h, 0), (radius, 0), (on_arc, on_arc), (k, k)],
        "upper": [(0, h), (k, k), (on_arc, on_arc), (0, radius)],
    }
    blocks = []
    for name, quad in corners.items():
        a, b, c, d = np.array(quad, dtype=float)

        def mapping(
            grid: np.ndarray, name: str = name, a: np.ndarray = a, b: np.ndarray = b,
            c: np.ndarray = c, d: np.ndarray = d,
        ) -> np.ndarray:
            s, t, z = grid.T
            s, t = s[:, None], t[:, None]
            x = (1 - s) * (1 - t) * a + s * (1 - t) * b + s * t * c + (1 - s) * t * d
            out = {"middle": 0.0 * s, "right": s, "upper": t}[name]
            angle = {"middle": 0.0 * s, "right": t * np.pi / 4, "upper": np.pi / 2 - s * np.pi / 4}
            arc = radius * np.hstack([np.cos(angle[name]), np.sin(angle[name])])
            chord = {"middle": x, "right": (1 - t) * b + t * c, "upper": (1 - s) * d + s * c}[name]
            return np.column_stack([x + out * (arc - chord) * (name != "middle"), z])

        def faces(
            midpoints: np.ndarray, normals: np.ndarray, name: str = name
        ) -> dict[str, np.ndarray]:
            side = _sides(midpoints, normals)
            x, y = {"x": side["x-"]}, {"y": side["y-"]}
            own = {"middle": x | y, "right": y | {"rim": side["x+"]},
                   "upper": x | {"rim": side["y+"]}}[name]
            return own | {"top": side["z+"]}

        outwards = geometric(n, 0.7)
        lines = (outwards if name == "right" else uniform(n),
                 outwards if name == "upper" else uniform(n), np.array([-thickness, 0.0]))
        blocks.append(swept_blocks(lines, np.ones((n, n, 1), int), {1: "body"}, mapping, faces))
    return _merged(blocks)


def _merged(blocks: Sequence[HexMesh]) -> HexMesh:
    """Return blocks whose points coincide where they meet as one mesh."""
    points = np.concatenate([block.points for block in blocks])
    first_point = np.cumsum([0, *(len(block.points) for block in blocks)])
    first_cell = np.cumsum([0, *(len(block.cells) for block in blocks)])
    cells = np.concatenate([block.cells + start
                            for block, start in zip(blocks, first_point, strict=False)])
    names = {name for block in blocks for name in block.facets}
    facets = {name: np.concatenate([block.facets[name] + np.array([start, 0])
                                    for block, start in zip(blocks, first_cell, strict=False)
                                    if name in block.facets]) for name in sorted(names)}
    _, kept, number = np.unique(np.round(points, 9) + 0.0, axis=0, return_index=True,
                                return_inverse=True)
    return HexMesh(points[kept], number.ravel()[cells], {"body": np.arange(len(cells))}, facets)
