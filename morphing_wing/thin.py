"""Cells of thin regions: where an enhanced element has strains of its own."""

from __future__ import annotations

from typing import Any

import numpy as np
import ufl
from dolfinx import fem

from . import compat
from .forms.enhanced import enhanced_deformation_gradient

BULKY, THIN = 0, 1
"""Tags of cells without and with strains of their own."""


class ThinCells:
    """What the enhanced strains of some hexahedra of a mesh need.

    Parameters
    ----------
    mesh
        Mesh of hexahedra.
    cells
        Local cells that have strains of their own, sorted.

    Attributes
    ----------
    tags
        Mesh tags: `THIN` on those cells, `BULKY` on the others.
    """

    def __init__(self, mesh: Any, cells: np.ndarray) -> None:
        self._mesh = mesh
        everywhere = np.arange(len(compat.original_cells(mesh)), dtype=np.int32)
        self._others = np.setdiff1d(everywhere, cells)
        self.tags = compat.cell_tags(mesh, np.isin(everywhere, cells).astype(np.int32))
        self._natural = fem.Function(compat.discontinuous_space(mesh, 1, (3,)))
        space = self._natural.function_space
        corners = 2.0 * compat.interpolation_points(space) - 1.0
        for cell in everywhere:
            self._natural.x.array.reshape(-1, 3)[space.dofmap.cell_dofs(cell)] = corners
        self._jacobian = compat.interpolated(
            compat.discontinuous_space(mesh, 0, (3, 3)), ufl.Jacobian(mesh), np.full((1, 3), 0.5)
        )

    def deformation_gradient(self, F: Any, modes: Any) -> Any:
        """Return the enhanced deformation gradient, see `morphing_wing.forms.enhanced`."""
        return enhanced_deformation_gradient(
            F, modes, self._natural, self._jacobian, ufl.JacobianDeterminant(self._mesh)
        )

    def absent(self, modes: Any) -> np.ndarray:
        """Return the dofs of the modes' (sub)space in cells that have none."""
        found = [modes.dofmap.cell_dofs(cell) for cell in self._others]
        return np.concatenate([np.empty(0, dtype=np.int32), *found])
