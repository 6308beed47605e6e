"""Principal stretches at the nodes of a displacement, by the element's shape functions."""

from __future__ import annotations

from functools import lru_cache

import basix
import numpy as np

__all__ = ["nodal_stretches"]

_SIMPLICES = {"interval": 1, "triangle": 2, "tetrahedron": 3}
_BOXES = {"quadrilateral": 2, "hexahedron": 3}


def nodal_stretches(
    cell: str, nodes: np.ndarray, points: np.ndarray, displacement: np.ndarray
) -> np.ndarray:
    r"""Return the two largest principal stretches at points, means over the cells that meet there.

    With the tangents of a cell before and after,
    :math:`A_{i\alpha} = \sum_a X_{ai} N_{a,\alpha}` and
    :math:`a = A + \sum_a u_a N_{a,\alpha}`, the squared stretches are the eigenvalues of
    :math:`(A^T A)^{-1} a^T a`. For solids that is :math:`C = F^T F` in the cell's own coordinates;
    for a line it is the stretch of its axis.

    Parameters
    ----------
    cell
        DOLFINx's name of the cell.
    nodes : (n_cells, n_nodes) int array
        Points of each cell in the finite element's order (not VTK's).
    points : (n_points, 3) array
        Coordinates in mm.
    displacement : (n_points, 3) array
        In mm.

    Returns
    -------
    (n_points, 2) array, the largest first; 1 where nothing is stretched, and for lines the second.
    """
    derivatives = _derivatives(cell, nodes.shape[1])
    before = np.einsum("cai,pxa->cpix", points[nodes], derivatives)
    after = before + np.einsum("cai,pxa->cpix", displacement[nodes], derivatives)
    metric = np.swapaxes(before, -1, -2) @ before
    # L^-1 (a^T a) L^-T with metric = L L^T is symmetric and has the same eigenvalues.
    inverse = np.linalg.inv(np.linalg.cholesky(metric))
    squares = inverse @ (np.swapaxes(after, -1, -2) @ after) @ np.swapaxes(inverse, -1, -2)
    stretches = np.sqrt(np.linalg.eigvalsh(squares).clip(min=0.0))[..., :-3:-1]
    found = np.ones((len(points), 2))
    count = np.bincount(nodes.ravel(), minlength=len(points)).clip(min=1)
    for i in range(stretches.shape[-1]):
        values = stretches[..., i].ravel()
        found[:, i] = np.bincount(nodes.ravel(), weights=values, minlength=len(points)) / count
    return found


@lru_cache
def _derivatives(cell: str, n_nodes: int) -> np.ndarray:
    """Return dN_a/dX_alpha at the element's own nodes, shape (n_nodes, dimension, n_nodes)."""
    degree = 1
    while _count(cell, degree) < n_nodes:
        degree += 1
    element = basix.create_element(
        basix.ElementFamily.P, getattr(basix.CellType, cell), degree,
        basix.LagrangeVariant.gll_warped)
    values = element.tabulate(1, element.points)[1:, :, :, 0]
    return np.ascontiguousarray(np.moveaxis(values, 0, 1))


def _count(cell: str, degree: int) -> int:
    if cell in _BOXES:
        return (degree + 1) ** _BOXES[cell]
    count = 1
    for i in range(_SIMPLICES[cell]):
        count = count * (degree + 1 + i) // (i + 1)
    return count
