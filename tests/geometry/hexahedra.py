"""Volumes, areas and faces of trilinear hexahedra, computed apart from the package."""

import itertools

import numpy as np

_CORNERS = np.array([(i, j, k) for k in (0, 1) for j in (0, 1) for i in (0, 1)], dtype=float)
_GAUSS = np.array(list(itertools.product((0.5 - 12**-0.5, 0.5 + 12**-0.5), repeat=3)))


def jacobians(mesh, at=_GAUSS):
    """Determinants at reference points of every cell, shape (n_cells, n_points)."""
    x = mesh.points[mesh.cells]
    values = []
    for point in at:
        factor = np.where(_CORNERS == 1.0, point, 1.0 - point)
        slope = 2.0 * _CORNERS - 1.0
        gradient = np.stack(
            [slope[:, a] * np.delete(factor, a, axis=1).prod(axis=1) for a in range(3)], axis=1)
        values.append(np.linalg.det(np.einsum("cvi,va->cia", x, gradient)))
    return np.stack(values, axis=1)


def corner_jacobians(mesh):
    """Determinants at the corners: where a trilinear cell turns inside out first."""
    return jacobians(mesh, _CORNERS)


def volume(mesh, region=None):
    """Exact volume of a region's cells, of all without a name (2 x 2 x 2 Gauss points)."""
    cells = slice(None) if region is None else mesh.regions[region]
    return jacobians(mesh)[cells].sum() / len(_GAUSS)


def area_vectors(mesh, name):
    """Area vectors of a face's facets out of the solid, shape (k, 3)."""
    a, b, c, d = np.moveaxis(mesh.facet_points(name), 1, 0)
    area = 0.5 * np.cross(d - a, c - b)
    inside = mesh.points[mesh.cells[mesh.facets[name][:, 0]]].mean(axis=1)
    outwards = np.sum(area * ((a + b + c + d) / 4.0 - inside), axis=1)
    return area * np.sign(outwards)[:, None]


def area(mesh, name):
    """Area of a face whose facets are flat."""
    return np.linalg.norm(area_vectors(mesh, name), axis=1).sum()


def enclosed(mesh, name):
    """Volume that flat facets enclose, their normals pointing inwards."""
    midpoints = mesh.facet_points(name).mean(axis=1)
    return -np.sum(area_vectors(mesh, name) * midpoints) / 3.0


def boundary(mesh):
    """Facets (cell, facet) that belong to one cell only, as a set of pairs."""
    sides = [(0, 1, 2, 3), (0, 1, 4, 5), (0, 2, 4, 6), (1, 3, 5, 7), (2, 3, 6, 7), (4, 5, 6, 7)]
    owners = {}
    for cell, vertices in enumerate(mesh.cells):
        for facet, side in enumerate(sides):
            owners.setdefault(frozenset(vertices[list(side)]), []).append((cell, facet))
    return {pairs[0] for pairs in owners.values() if len(pairs) == 1}


def pairs(mesh, *names):
    """Facets of faces, each face by each, as a list of pairs."""
    return [tuple(map(int, pair)) for name in names for pair in mesh.facets[name]]
