"""Cells that are built in stretched: how far, and a number that leads there."""

from __future__ import annotations

from typing import Any

import numpy as np
from dolfinx import fem

from . import compat
from .forms.prestretch import prestretch_gradient


class Prestretch:
    """The prestretch of some hexahedra of a mesh.

    Parameters
    ----------
    mesh
        Mesh of hexahedra.
    cells
        Local cells that are stretched.
    stretches
        Along x and z.

    Attributes
    ----------
    part
        Constant between 0, at which nothing is stretched, and 1.
    gradient
        Deformation gradient of the prestretch, the identity in all other cells.
    """

    def __init__(self, mesh: Any, cells: np.ndarray, stretches: tuple[float, float]) -> None:
        self.part = compat.constant(mesh, 0.0)
        inside = fem.Function(compat.discontinuous_space(mesh, 0))
        for cell in cells:
            inside.x.array[inside.function_space.dofmap.cell_dofs(cell)] = 1.0
        surplus = (compat.constant(mesh, s - 1.0) for s in stretches)
        self.gradient = prestretch_gradient(*(1.0 + self.part * inside * s for s in surplus))
