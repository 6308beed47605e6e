"""Second-order tetrahedra with named faces."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass

import numpy as np

# Facets and edges of a tetrahedron, numbered as finite elements do: facet i is opposite vertex i.
FACET_VERTICES = np.array([(1, 2, 3), (0, 2, 3), (0, 1, 3), (0, 1, 2)])
EDGES = np.array([(2, 3), (1, 3), (1, 2), (0, 3), (0, 2), (0, 1)])


@dataclass(frozen=True)
class TetMesh:
    """Tetrahedra with curved edges.

    Attributes
    ----------
    points : (n, 3) array
        Coordinates in mm, of vertices and of the edges' middles.
    cells : (m, 10) array
        Four vertices, then the middles of `EDGES`.
    facets : mapping of name to (k, 2) array
        Facets of each face as pairs (cell, facet of the cell 0..3).
    """

    points: np.ndarray
    cells: np.ndarray
    facets: Mapping[str, np.ndarray]

    def smallest_jacobian(self) -> np.ndarray:
        """Return of each cell the smallest ratio, over its nodes, of volumes mapped and straight.

        1 for a straight cell; zero or less where the mapping from a straight one folds over.
        """
        x = self.points[self.cells]
        straight = np.linalg.det(x[:, 1:4] - x[:, :1])
        jacobian = np.einsum("kai,mac->mkic", _gradients(), x)
        return np.linalg.det(jacobian).min(axis=1) / straight

    def volume(self) -> float:
        """Return the volume in mm^3, curved edges as they are."""
        x = self.points[self.cells]
        # The determinant is cubic: a rule of third order integrates it.
        places = np.full((5, 4), 1.0 / 6.0)
        places[0] = 0.25
        places[np.arange(1, 5), np.arange(4)] = 0.5
        weights = np.array([-4.0 / 5.0, 9 / 20, 9 / 20, 9 / 20, 9 / 20]) / 6.0
        jacobian = np.einsum("kai,mac->mkic", _gradients_at(places), x)
        return float(np.linalg.det(jacobian).dot(weights).sum())


def with_faces(
    points: np.ndarray, cells: np.ndarray, faces: Mapping[str, Callable[[np.ndarray], np.ndarray]]
) -> TetMesh:
    """Return a mesh whose outer facets have the names of the faces that they lie in.

    Parameters
    ----------
    points, cells
        See `TetMesh`.
    faces
        From places (k, 3) to whether they are in a face: asked of the vertices of outer facets.
    """
    vertices = cells[:, FACET_VERTICES].reshape(-1, 3)
    _, first, count = np.unique(np.sort(vertices, axis=1), axis=0, return_index=True,
                                return_counts=True)
    outer = first[count == 1]
    corners = points[vertices[outer]]
    pairs = np.stack([outer // 4, outer % 4], axis=1)
    found = {name: pairs[within(corners.reshape(-1, 3)).reshape(-1, 3).all(axis=1)]
             for name, within in faces.items()}
    return TetMesh(points, cells, found)


def joined(mesh: TetMesh, places: np.ndarray) -> TetMesh:
    """Return copies of a mesh, unconnected, each moved to one of the places (k, 3) in mm.

    The faces of copy i, from 0, have ``_i`` behind their names.
    """
    n, m = len(mesh.points), len(mesh.cells)
    each = range(len(places))
    return TetMesh(
        points=np.concatenate([mesh.points + place for place in places]),
        cells=np.concatenate([mesh.cells + n * i for i in each]),
        facets={f"{name}_{i}": pairs + [m * i, 0]
                for i in each for name, pairs in mesh.facets.items()},
    )


def _gradients() -> np.ndarray:
    """Gradients of the shape functions at the ten nodes, (10, 10, 3)."""
    places = np.vstack([np.eye(4), 0.5 * np.eye(4)[EDGES].sum(axis=1)])
    return _gradients_at(places)


def _gradients_at(places: np.ndarray) -> np.ndarray:
    """Gradients of the shape functions at barycentric places (k, 4), shape (k, 10, 3)."""
    slope = np.vstack([-np.ones(3), np.eye(3)])
    corner = (4.0 * places - 1.0)[:, :, None] * slope
    a, b = EDGES.T
    edge = 4.0 * (places[:, a, None] * slope[b] + places[:, b, None] * slope[a])
    return np.concatenate([corner, edge], axis=1)
