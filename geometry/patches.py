"""Integration points on the parts of facets that lie in a box: glued patches need no mesh lines."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from .facets import shape_functions

# Three Gauss points a direction integrate the products of two quadratic functions exactly.
_GAUSS, _WEIGHTS = np.polynomial.legendre.leggauss(3)


@dataclass(frozen=True)
class PatchPoints:
    """Integration points on facets.

    Attributes
    ----------
    facet : (n,) int array
        Facet of each point.
    shapes : (n, nodes of a facet) array
        Shape functions of the facet's nodes.
    place, normal : (n, 3) arrays
        Position in mm, and unit normal of the facet.
    area : (n,) array
        What each point stands for, mm^2.
    """

    facet: np.ndarray
    shapes: np.ndarray
    place: np.ndarray
    normal: np.ndarray
    area: np.ndarray


def patch_points(nodes: np.ndarray, facets: np.ndarray, box: np.ndarray) -> PatchPoints:
    """Return the points of the facets' parts inside a box.

    Facets are taken for rectangles along two axes when they are cut; they may be curved across.

    Parameters
    ----------
    nodes : (m, 3) array
        In mm.
    facets : (k, 4 or 9) int array
        Nodes of each facet in tensor-product order.
    box : (2, 3) array
        Lower and upper corner, mm.
    """
    degree = 1 if facets.shape[1] == 4 else 2
    found: list[tuple[int, np.ndarray, np.ndarray]] = []
    for number, corners in enumerate(nodes[facets]):
        low, high = corners.min(axis=0), corners.max(axis=0)
        if not ((low < box[1]) & (high > box[0])).all():
            continue
        ends = [_cut(corners[0], corners[last], box) for last in (degree, -degree - 1)]
        if all(end > start for start, end in ends):
            (s, ws), (t, wt) = (_points(*part) for part in ends)
            xi = np.stack(np.meshgrid(s, t, indexing="ij"), axis=-1).reshape(-1, 2)
            found.append((number, xi, np.outer(ws, wt).ravel()))
    facet = np.repeat([number for number, *_ in found], 9).astype(int)
    xi = np.concatenate([np.empty((0, 2)), *(part for _, part, _ in found)])
    weight = np.concatenate([np.empty(0), *(part for *_, part in found)])
    shapes, first, second = shape_functions(degree, xi)
    place, a, b = (np.einsum("na,nai->ni", N, nodes[facets[facet]])
                   for N in (shapes, first, second))
    normal = np.cross(a, b)
    size = np.linalg.norm(normal, axis=1)
    return PatchPoints(facet, shapes, place, normal / size[:, None], weight * size)


def joined(parts: list[PatchPoints], first_facets: list[int]) -> PatchPoints:
    """Return the points of several patches as one; facets counted on from ``first_facets``."""
    facet = [part.facet + first for part, first in zip(parts, first_facets, strict=True)]
    others = (np.concatenate([getattr(part, name) for part in parts])
              for name in ("shapes", "place", "normal", "area"))
    return PatchPoints(np.concatenate(facet), *others)


def _cut(start: np.ndarray, end: np.ndarray, box: np.ndarray) -> tuple[float, float]:
    """Return the part of an edge in the box, in natural coordinates along it."""
    axis = np.abs(end - start).argmax()
    inside = np.sort((box[:, axis] - start[axis]) / (end[axis] - start[axis]))
    return tuple(2.0 * np.clip(inside, 0.0, 1.0) - 1.0)


def _points(start: float, end: float) -> tuple[np.ndarray, np.ndarray]:
    half = 0.5 * (end - start)
    return start + half * (1.0 + _GAUSS), half * _WEIGHTS
