r"""A rib of any length as a chain of condensed pieces: root, equal cells, tail.

The middles :math:`x_0 .. x_{n+1}` of root, cuts 1..n and tail are nodes on the rib's axis. Piece e
lies between nodes e and e + 1; its chord is :math:`\ell_e` long and turned by :math:`\alpha_e`. A
section is turned by :math:`\theta_k`, and in a frame that turns with it deforms by
:math:`\eta_k`, quadratic fields that hold no translation and no turn. Seen from the chord the piece
moves little, so that it stores

.. math:: \Pi_e = \tfrac12 D \cdot K D, \qquad D = (\ell_e - L_e, \theta_e - \alpha_e, \eta_e,
    \theta_{e+1} - \alpha_e, \eta_{e+1})

with the stiffness K of small displacements, however far it has turned. The sum is quadratic in
:math:`\theta, \eta, \alpha, \ell`: what no load works on is eliminated once for all. Lengths and
turns only meet in the place of the tail, :math:`\sum \ell_e (\cos\alpha_e, \sin\alpha_e)`. That an
arc's chord is shorter is left out: 0.07 % where a cell turns by 7.5 degrees, 0.3 % at 15.
"""

from __future__ import annotations

import numpy as np
from scipy.linalg import null_space
from scipy.sparse import lil_matrix
from scipy.sparse.linalg import splu

from .condensation import Condensed
from .cut_fields import SIZE, shift, turn
from .geometry.rib import RibGeometry
from .geometry.rib_cell import CUT, HALF, PIECES, Cut, cut


class RibChain:
    """Stiffness of a rib by what positions and turns of its tail depend on.

    Its unknowns are the turns of n + 1 chords in radians, their elongations in mm, and the turn of
    the tail.

    Parameters
    ----------
    rib
        Dimensions.
    pieces
        Its pieces; of half of it.
    E
        Young's modulus, MPa.

    Attributes
    ----------
    lengths : (n + 1,) array
        Of the chords at rest, mm.
    stiffness : (2 n + 3, 2 n + 3) array
        Of the whole rib, N mm, N and N/mm.
    dofs
        Unknowns before elimination.
    """

    def __init__(self, rib: RibGeometry, pieces: Condensed, E: float) -> None:
        n = rib.n_cells
        self.lengths = rib.pitch * np.array([CUT, *[1.0] * (n - 1), 1.0 - CUT])
        section = section_deformations(rib)
        kinds = {piece: 2.0 * E * chord_stiffness(rib, piece, pieces.stiffness[piece], section)
                 for piece in PIECES}
        own = 1 + section.shape[1]  # a section's turn and deformations
        self.dofs = own * n + 2 * n + 3
        chords, tail = np.arange(own * n, self.dofs - 1).reshape(2, n + 1), self.dofs - 1
        total = lil_matrix((self.dofs, self.dofs))
        for e in range(n + 1):
            piece = PIECES[(e > 0) + (e == n)]
            sides = [[] if k == 0 else [tail] if k > n else range(own * (k - 1), own * k)
                     for k in (e, e + 1)]
            numbers = np.concatenate([chords[:, e], *sides]).astype(int)
            total[np.ix_(numbers, numbers)] += kinds[piece]
        total = total.tocsc()
        inner, outer = slice(0, own * n), slice(own * n, None)
        coupling = total[inner, outer].toarray()
        self.stiffness = total[outer, outer].toarray() - coupling.T @ splu(
            total[inner, inner]).solve(coupling)

    def tail(self, y: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Return x and y of the tail from the root in mm, first and second derivatives by y.

        Shapes (2,), (2, m) and (2, m, m).
        """
        count = len(self.lengths)
        alpha, length = y[:count], self.lengths + y[count:-1]
        along = np.stack([np.cos(alpha), np.sin(alpha)])
        across = np.stack([-along[1], along[0]])
        first, second = np.zeros((2, len(y))), np.zeros((2, len(y), len(y)))
        first[:, :-1] = np.hstack([length * across, along])
        i = np.arange(count)
        second[:, i, i] = -length * along
        second[:, i, count + i] = second[:, count + i, i] = across
        return along @ length, first, second


def _both(rib: RibGeometry, number: int) -> list[Cut]:
    return [cut(rib, layer, number) for layer in HALF]


def _centre(rib: RibGeometry, number: int) -> np.ndarray:
    """Return the middle of both cuts, which is on the axis."""
    return np.mean([found.place * [1.0, 1.0, 0.0] for found in _both(rib, number)], axis=0)


def section_deformations(rib: RibGeometry) -> np.ndarray:
    """Return a basis of the fields of a section that hold no translation and no turn."""
    rigid = [shift(0), shift(1), turn(_both(rib, 1), _centre(rib, 1))]
    return null_space(np.array(rigid))


def chord_stiffness(
    rib: RibGeometry, piece: str, stiffness: np.ndarray, section: np.ndarray
) -> np.ndarray:
    """Return a piece's stiffness by its chord's turn and length, and both sides' own unknowns.

    Those of a section are turn and deformations, of the tail's plate its turn; the root's is held.
    """
    spin = turn(_both(rib, 1), _centre(rib, 1))[:, None]
    free = np.hstack([spin, section])  # seen from the chord's first node, as all that follows
    ahead, still = shift(0)[:, None], np.zeros((SIZE, 1))
    if piece == "root":  # the plate turns backwards as the chord turns
        plate = turn(_both(rib, 1), np.zeros(3))[:, None]
        return _seen(stiffness, np.hstack([plate - spin, ahead, free]))
    if piece == "tail":  # the section's motion as the plate sees it
        plate = turn(_both(rib, 1), [rib.pitch, 0.0, 0.0])[:, None]
        return _seen(stiffness, np.hstack([plate - spin, -ahead, free, -plate]))
    none = np.zeros_like(free)
    return _seen(stiffness, np.block([[-spin, still, free, none], [-spin, ahead, none, free]]))


def _seen(stiffness: np.ndarray, fields: np.ndarray) -> np.ndarray:
    return fields.T @ stiffness @ fields
