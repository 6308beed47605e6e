"""Swept hexahedra with named regions: a grid of blocks, some solid, some empty, then mapped."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass

import numpy as np

# Corners of a hexahedron in tensor-product order and the facets numbered as finite elements do:
# z-, y-, x-, x+, y+, z+.
_CORNERS = np.array([(i, j, k) for k in (0, 1) for j in (0, 1) for i in (0, 1)])
FACET_VERTICES = np.array(
    [(0, 1, 2, 3), (0, 1, 4, 5), (0, 2, 4, 6), (1, 3, 5, 7), (2, 3, 6, 7), (4, 5, 6, 7)]
)
_FACET_NEIGHBOURS = ((0, 0, -1), (0, -1, 0), (-1, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 1))


@dataclass(frozen=True)
class HexMesh:
    """First-order hexahedra with names for regions and facets.

    Attributes
    ----------
    points : (n, 3) array
        Coordinates in mm.
    cells : (m, 8) array
        Vertices in tensor-product order (x fastest, z slowest).
    regions : mapping of name to (k,) array
        Cells of each region.
    facets : mapping of name to (k, 2) array
        Facets of each face as pairs (cell, facet of the cell 0..5).
    """

    points: np.ndarray
    cells: np.ndarray
    regions: Mapping[str, np.ndarray]
    facets: Mapping[str, np.ndarray]

    def volume(self) -> float:
        """Return the volume in mm^3 of all cells, by quadrature that is exact for them."""
        ends = 0.5 + np.array([-0.5, 0.5]) / np.sqrt(3.0)
        total = 0.0
        for place in np.array(np.meshgrid(ends, ends, ends)).reshape(3, -1).T:
            each = np.where(_CORNERS == 1, place, 1.0 - place)  # of each corner, by direction
            signs = np.where(_CORNERS == 1, 1.0, -1.0)
            slopes = np.stack([signs[:, i] * np.delete(each, i, axis=1).prod(axis=1)
                               for i in range(3)], axis=1)
            jacobians = np.einsum("cvx,vi->cxi", self.points[self.cells], slopes)
            total += float(np.linalg.det(jacobians).sum()) / 8.0
        return total

    def facet_points(self, name: str) -> np.ndarray:
        """Return the corners of a face's facets, shape (k, 4, 3), in mm."""
        pairs = self.facets[name]
        vertices = self.cells[pairs[:, 0][:, None], FACET_VERTICES[pairs[:, 1]]]
        return self.points[vertices]

    def beyond(self, name: str) -> np.ndarray:
        """Return a place just outside the body at each facet of a face, shape (k, 3), in mm."""
        middles = self.facet_points(name).mean(axis=1)
        cells = self.points[self.cells[self.facets[name][:, 0]]].mean(axis=1)
        return middles + 0.1 * (middles - cells)


def breakpoints(*pieces: tuple[float, np.ndarray]) -> tuple[np.ndarray, np.ndarray]:
    """Join pieces ``(length, fractions in [0, 1])`` to a line.

    Returns
    -------
    points : (n + 1,) array
        Coordinates from 0.
    piece : (n,) int array
        Number of the piece of each interval.
    """
    points, owner, start = [0.0], [], 0.0
    for number, (length, fractions) in enumerate(pieces):
        points.extend(start + length * fractions[1:])
        owner.extend([number] * (len(fractions) - 1))
        start += length
    return np.array(points), np.array(owner)


def uniform(n: int) -> np.ndarray:
    """Return n equal intervals of [0, 1]."""
    return np.linspace(0.0, 1.0, n + 1)


def geometric(n: int, ratio: float) -> np.ndarray:
    """Return n intervals of [0, 1], each ``ratio`` times as long as the one before."""
    lengths = ratio ** np.arange(n)
    return np.concatenate([[0.0], np.cumsum(lengths) / lengths.sum()])


def two_sided(n: int, ratio: float) -> np.ndarray:
    """Return n intervals of [0, 1], symmetric, growing by ``ratio`` from both ends inwards."""
    steps = np.minimum(np.arange(n), np.arange(n)[::-1])
    lengths = ratio ** steps
    return np.concatenate([[0.0], np.cumsum(lengths) / lengths.sum()])


def swept_blocks(
    lines: tuple[np.ndarray, np.ndarray, np.ndarray],
    kind: np.ndarray,
    names: Mapping[int, str],
    mapping: Callable[[np.ndarray], np.ndarray] | None = None,
    faces: Callable[[np.ndarray, np.ndarray], Mapping[str, np.ndarray]] | None = None,
) -> HexMesh:
    """Build the mesh of the solid blocks of a grid.

    Parameters
    ----------
    lines
        Grid coordinates along x, y, z.
    kind : (nx, ny, nz) int array
        What fills each block: positive for solid regions, zero or negative for empty ones.
    names
        Name of each kind. A solid's is a region; an empty one's, the face that surrounds it.
        Kind 0 is the outside: its facets are passed to ``faces``.
    mapping
        From grid points (n, 3) to points in mm (n, 3).
    faces
        From the midpoints (in grid coordinates) and normals of the outer facets, both (k, 3), to
        masks of named outer faces.
    """
    shape = kind.shape
    i, j, k = np.nonzero(kind > 0)
    blocks = np.stack([i, j, k], axis=1)
    corner = blocks[:, None, :] + _CORNERS[None]
    number = np.ravel_multi_index(
        tuple(np.moveaxis(corner, -1, 0)), tuple(n + 1 for n in shape)
    )
    used, cells = np.unique(number, return_inverse=True)
    cells = cells.reshape(number.shape)
    index = np.stack(np.unravel_index(used, tuple(n + 1 for n in shape)), axis=1)
    grid = np.stack([lines[axis][index[:, axis]] for axis in range(3)], axis=1)

    solid = kind[i, j, k]
    regions = {name: np.nonzero(solid == value)[0] for value, name in names.items() if value > 0}
    facets, outer = _neighbouring(kind, blocks, names)
    if faces is not None and len(outer):
        vertices = cells[outer[:, 0][:, None], FACET_VERTICES[outer[:, 1]]]
        midpoints = grid[vertices].mean(axis=1)
        normals = np.array(_FACET_NEIGHBOURS, dtype=float)[outer[:, 1]]
        facets |= {name: outer[mask] for name, mask in faces(midpoints, normals).items()}
    points = grid if mapping is None else mapping(grid)
    return HexMesh(points, cells, regions, facets)


def _neighbouring(
    kind: np.ndarray, blocks: np.ndarray, names: Mapping[int, str]
) -> tuple[dict[str, np.ndarray], np.ndarray]:
    """Return facets by the empty kind that they face, and those that face the outside."""
    padded = np.pad(kind, 1)
    pairs, beyond = [], []
    for facet, step in enumerate(_FACET_NEIGHBOURS):
        other = padded[tuple((blocks + 1 + np.array(step)).T)]
        cells = np.nonzero(other <= 0)[0]
        pairs.append(np.stack([cells, np.full(len(cells), facet)], axis=1))
        beyond.append(other[cells])
    pairs, beyond = np.concatenate(pairs), np.concatenate(beyond)
    named = {name: pairs[beyond == value] for value, name in names.items() if value < 0}
    return named, pairs[beyond == 0]
