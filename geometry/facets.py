"""Quadrilateral facets in space: their shape functions, and the points on them closest to others.

A facet of degree d has (d + 1)^2 nodes in tensor-product order, first direction fastest, and
natural coordinates xi in [-1, 1]^2. Its normal ``x_,1 x x_,2`` looks out of the body it bounds.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.spatial import cKDTree

BEYOND = 1.2
"""How far in natural coordinates a facet is continued over its edges."""

_NEAREST_NODES = 4
_ITERATIONS = 8


@dataclass(frozen=True)
class Closest:
    """The nearest place on a surface of each of n points.

    Attributes
    ----------
    facet : (n,) int array
        Facet; -1 where the point lies beyond the surface's boundary.
    xi : (n, 2) array
        Natural coordinates there.
    gap : (n,) array
        Distance in mm along the facet's normal, negative inside the body; infinite beyond.
    """

    facet: np.ndarray
    xi: np.ndarray
    gap: np.ndarray


def shape_functions(degree: int, xi: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return Lagrange's shape functions and their derivatives by xi_1 and xi_2.

    Parameters
    ----------
    degree
        1 or 2 in each direction.
    xi : (..., 2) array
        Natural coordinates.

    Returns
    -------
    three (..., (degree + 1)^2) arrays
    """
    (a, da), (b, db) = (_along_a_line(degree, xi[..., axis]) for axis in (0, 1))
    size = (*xi.shape[:-1], (degree + 1) ** 2)

    def product(first: np.ndarray, second: np.ndarray) -> np.ndarray:
        return (second[..., :, None] * first[..., None, :]).reshape(size)

    return product(a, b), product(da, b), product(a, db)


def project(nodes: np.ndarray, points: np.ndarray, start: np.ndarray | None = None) -> np.ndarray:
    """Return the natural coordinates of the points closest to others on one facet each.

    The distance is stationary at them also outside [-1, 1], up to `BEYOND`.

    Parameters
    ----------
    nodes : (n, (degree + 1)^2, 3) array
        Nodes of each point's facet, mm.
    points : (n, 3) array
        In mm.
    start : (n, 2) array, optional
        Where to begin.
    """
    degree = 1 if nodes.shape[1] == 4 else 2
    xi = np.zeros((len(points), 2)) if start is None else start.copy()
    for _ in range(_ITERATIONS):
        x, first, second = _on(nodes, degree, xi)
        apart = points - x
        a, b, c = (np.sum(u * v, axis=1) for u, v in
                   ((first, first), (first, second), (second, second)))
        r, s = np.sum(apart * first, axis=1), np.sum(apart * second, axis=1)
        determinant = np.maximum(a * c - b * b, 1e-300)
        step = np.stack([c * r - b * s, a * s - b * r], axis=1) / determinant[:, None]
        new = np.clip(xi + np.clip(step, -1.0, 1.0), -BEYOND, BEYOND)
        if np.abs(new - xi).max(initial=0.0) < 1e-13:
            break
        xi = new
    return xi


def gaps(nodes: np.ndarray, points: np.ndarray, xi: np.ndarray) -> np.ndarray:
    """Return the distances in mm of points from their facets along the normals at ``xi``."""
    x, first, second = _on(nodes, 1 if nodes.shape[1] == 4 else 2, xi)
    normal = np.cross(first, second)
    length = np.maximum(np.linalg.norm(normal, axis=1), 1e-300)
    return np.sum((points - x) * normal, axis=1) / length


def closest(points: np.ndarray, nodes: np.ndarray, facets: np.ndarray) -> Closest:
    """Find the nearest place on a surface for each of some points.

    Parameters
    ----------
    points : (n, 3) array
        In mm.
    nodes : (m, 3) array
        The surface's nodes, mm.
    facets : (k, (degree + 1)^2) int array
        Nodes of each facet.
    """
    degree, n = (1 if facets.shape[1] == 4 else 2), len(points)
    around = _facets_around_nodes(facets, len(nodes))
    _, near = cKDTree(nodes).query(points, k=min(_NEAREST_NODES, len(nodes)))
    candidates = around[near.reshape(n, -1)].reshape(n, -1)
    number = candidates.ravel()
    flat = np.repeat(points, candidates.shape[1], axis=0)
    xi = project(nodes[facets[number]], flat)
    inside = np.clip(xi, -1.0, 1.0)
    x, *_ = _on(nodes[facets[number]], degree, inside)
    # Rounding must not decide between facets that share an edge.
    distance = np.round(np.linalg.norm(flat - x, axis=1), 9)
    distance[number < 0] = np.inf
    best = np.arange(n) * candidates.shape[1] + distance.reshape(n, -1).argmin(axis=1)
    facet, xi = number[best].copy(), xi[best]
    gap = gaps(nodes[facets[facet]], points, xi)
    beyond = (np.abs(xi) >= BEYOND).any(axis=1)
    facet[beyond], gap[beyond] = -1, np.inf
    return Closest(facet, xi, gap)


def node_areas(nodes: np.ndarray, facets: np.ndarray) -> np.ndarray:
    """Return each node's share of a surface's area in mm^2, by the Lobatto rule of its facets.

    The shares are the nodal forces of a uniform pressure of one on flat rectangles.
    """
    degree = 1 if facets.shape[1] == 4 else 2
    ends, weights = ([-1.0, 1.0], [1.0, 1.0]) if degree == 1 else (
        [-1.0, 0.0, 1.0], [1.0 / 3.0, 4.0 / 3.0, 1.0 / 3.0])
    area = np.zeros(len(nodes))
    for j, eta in enumerate(ends):
        for i, xi in enumerate(ends):
            at = np.broadcast_to([xi, eta], (len(facets), 2))
            _, first, second = _on(nodes[facets], degree, at)
            share = weights[i] * weights[j] * np.linalg.norm(np.cross(first, second), axis=1)
            np.add.at(area, facets[:, j * (degree + 1) + i], share)
    return area


def _on(
    nodes: np.ndarray, degree: int, xi: np.ndarray
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return points and tangents of facets, each (n, 3)."""
    return tuple(np.einsum("na,nai->ni", N, nodes) for N in shape_functions(degree, xi))


def _along_a_line(degree: int, t: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    if degree == 1:
        return (np.stack([0.5 * (1 - t), 0.5 * (1 + t)], axis=-1),
                np.stack([np.full_like(t, -0.5), np.full_like(t, 0.5)], axis=-1))
    return (np.stack([0.5 * t * (t - 1), 1 - t * t, 0.5 * t * (t + 1)], axis=-1),
            np.stack([t - 0.5, -2 * t, t + 0.5], axis=-1))


def _facets_around_nodes(facets: np.ndarray, n_nodes: int) -> np.ndarray:
    """Return the facets at each node, shape (n_nodes, most), filled up with -1."""
    node, facet = facets.ravel(), np.repeat(np.arange(len(facets)), facets.shape[1])
    order = np.lexsort((facet, node))
    node, facet = node[order], facet[order]
    count = np.bincount(node, minlength=n_nodes)
    first = np.cumsum(count) - count
    table = np.full((n_nodes, count.max(initial=1)), -1)
    table[node, np.arange(len(node)) - first[node]] = facet
    return table
