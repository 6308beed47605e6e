r"""Enhanced strains: a linear hexahedron that bends, and that no incompressibility locks.

The deformation gradient of the displacement follows one of the cell's own,

.. math:: \tilde F = F (I + H), \qquad
    H = \frac{j_0}{j} \left( \sum_A \xi_A \, (J_0^{-T} e_A) \otimes a_A + \theta I \right), \qquad
    \theta = \alpha_1 \xi \eta + \alpha_2 \eta \zeta + \alpha_3 \zeta \xi ,

with natural coordinates xi in [-1, 1] and the Jacobian J of the cell's map, J_0 in its middle. The
three vectors a_A and the alpha are unknowns of the same minimisation. H vanishes in the mean and at
the middle of every cell, so that homogeneous states are met exactly. The a_A take the parasitic
shear from bending, the alpha what is left of volumetric locking. Cells should be nearly
parallelepipeds: tapered ones lock in bending, as MacNeal showed in the plane (Int. J. Numer. Meth.
Engng 24 (1987) 1793-1799).

References
----------
Simo, Armero, Taylor, Comput. Methods Appl. Mech. Engng 110 (1993) 359-386: the twelve modes.
Glaser, Armero, Engineering Computations 14 (1997) 759-791: xi_A on the rows of H, against
hourglasses in compression. (Theirs is multiplied by F in the middle of the cell, this one by F at
the point.)
"""

from __future__ import annotations

from typing import Any

import ufl

N_MODES = 12
"""Unknowns of each cell: a_1, a_2, a_3 and the alpha."""


def enhanced_deformation_gradient(
    F: Any, modes: Any, natural: Any, middle_jacobian: Any, jacobian_determinant: Any
) -> Any:
    """Return ``F (I + H)``.

    Parameters
    ----------
    F
        Deformation gradient of the displacement.
    modes
        The cell's a_A and the alpha.
    natural
        Natural coordinates, 3 components in [-1, 1].
    middle_jacobian, jacobian_determinant
        Jacobian of the cell's map at its middle, 3 x 3, and its determinant anywhere.
    """
    xi, inverse = natural, ufl.inv(middle_jacobian)
    ratio = ufl.det(middle_jacobian) / jacobian_determinant
    rows = ufl.as_matrix([[ratio * xi[A] * inverse[A, i] for i in range(3)] for A in range(3)])
    columns = ufl.as_matrix([[modes[3 * A + j] for j in range(3)] for A in range(3)])
    bending = ufl.transpose(rows) * columns
    theta = sum(modes[9 + A] * xi[A] * xi[(A + 1) % 3] for A in range(3))
    return (1.0 + ratio * theta) * F + F * bending
