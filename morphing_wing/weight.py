"""Gravity on elastomer and ribs: their weight, in multiples of standard gravity."""

from __future__ import annotations

from . import compat
from .bar_mesh import BarMesh
from .elastomer import Elastomer
from .forms.gravity import gravity_potential, specific_weight
from .solid_ribs import SolidRibs


class Weight:
    """The weight of an elastomer body, and of ribs if there are any, along -y.

    Attributes
    ----------
    multiples
        The constants that carry the multiple of standard gravity, one a mesh.
    potentials
        UFL functionals in N mm, one a mesh.
    """

    def __init__(self, body: Elastomer, ribs: BarMesh | SolidRibs | None) -> None:
        self._comm = body.comm
        weight = compat.constant(body.mesh, specific_weight(body.material.density))
        rises = [gravity_potential(weight, body.u) * body.volume_measure()]
        meshes = [body.mesh]
        if ribs is not None:
            rises.append(ribs.rise(specific_weight(ribs.material.density)))
            meshes.append(ribs.function.function_space.mesh)
        self.multiples = [compat.constant(mesh, 0.0) for mesh in meshes]
        self.potentials = [n * rise for n, rise in zip(self.multiples, rises, strict=True)]
        self._rises = [compat.form(rise) for rise in rises]

    def fall(self) -> float:
        """Return what a multiple of standard gravity does work on, -sum of rho g u_y, in N mm."""
        return -sum(compat.assemble_scalar(self._comm, rise) for rise in self._rises)
