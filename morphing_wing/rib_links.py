r"""The condensed pieces of a rib as links between points of its axis, exact for loads at its ends.

Sections deform; but where loads work on the ends alone, the six resultants at the middle of a piece
say how its sections do. With the displacements U of all cuts under six unit loads of the tail,
:math:`K_e` the stiffness of piece e and :math:`S_e` the resultants at its middle, statics alone,

.. math:: C_e = S_e^{-T}\, U_e^T K_e U_e\, S_e^{-1} , \qquad \Pi = \sum_e \tfrac12 d_e \cdot
    C_e^{-1} d_e

has the compliance of the joined pieces: each link stores what its piece stores, the ends' effect on
those next to them with it. d is how far one end moves seen from
the other, in axes turned half the way between them. What the mirror z = 0 leaves as it is and what
it reverses are independent.
"""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
from scipy.sparse import lil_matrix
from scipy.sparse.linalg import splu

from .cut_fields import MIRRORED, rigid
from .geometry.rib import HALF, RibGeometry
from .geometry.rib_cell import axis_points, cut, piece_of

__all__ = ["DEFORMATIONS", "link_stiffness"]

DEFORMATIONS = ((0, 1, 5), (2, 3, 4))
"""Of each parity the components of d: along x and y and about z; along z and about x and y."""


def link_stiffness(
    rib: RibGeometry, pieces: Mapping[str, np.ndarray], E: float, parity: int
) -> np.ndarray:
    """Return each link's stiffness against the `DEFORMATIONS` of a parity, shape (n + 1, 3, 3).

    Parameters
    ----------
    rib
        Dimensions.
    pieces
        Stiffness of its pieces, see `morphing_wing.condensation.Condensed`.
    E
        Young's modulus, MPa.
    parity
        Of the fields, see `morphing_wing.cut_fields`.
    """
    n, size = rib.n_cells, len(pieces["root"])
    first = [cut(rib, layer, 1) for layer in HALF]
    # The last piece sees its cut's motion from the tail's plate, the cell's pitch away.
    seen = np.hstack([np.eye(size), -rigid(first, [rib.pitch, 0.0, 0.0], parity)])
    kinds = {name: 2.0 * E * stiffness for name, stiffness in pieces.items()}  # of halves
    kinds["tail"] = seen.T @ kinds["tail"] @ seen
    stiffness = [kinds[piece_of(e, n)] for e in range(n + 1)]
    starts = size * np.maximum(np.arange(n + 1) - 1, 0)
    spans = [slice(start, start + len(K)) for start, K in zip(starts, stiffness, strict=True)]
    total = lil_matrix((size * n + 3, size * n + 3))
    for span, K in zip(spans, stiffness, strict=True):
        total[span, span] += K
    loads = np.zeros((size * n + 3, 3))
    loads[-3:] = np.eye(3)
    moved = splu(total.tocsc()).solve(loads)
    x = axis_points(rib)
    found = []
    for e, (span, K) in enumerate(zip(spans, stiffness, strict=True)):
        stored = moved[span].T @ K @ moved[span]
        resultants = np.eye(3)
        away = x[-1] - 0.5 * (x[e] + x[e + 1])
        if parity == MIRRORED:  # a force along y turns about z
            resultants[2, 1] = away
        else:  # one along z about y, the other way
            resultants[2, 0] = -away
        inverse = np.linalg.inv(resultants)
        found.append(np.linalg.inv(inverse.T @ stored @ inverse))
    return 0.5 * (np.array(found) + np.transpose(found, (0, 2, 1)))
