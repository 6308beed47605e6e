"""Gravity on elastomer and ribs: their weight, in multiples of standard gravity."""

from __future__ import annotations

from . import compat
from .elastomer import Elastomer
from .forms.beam import displacement
from .forms.gravity import gravity_potential, specific_weight
from .frame import BeamFrame


class Weight:
    """The weight of an elastomer body, and of a frame of ribs if there is one, along -y.

    Bars weigh by their whole length: the little in which they overlap at joints weighs twice.

    Attributes
    ----------
    multiples
        The constants that carry the multiple of standard gravity, one a mesh.
    potentials
        UFL functionals in N mm, one a mesh.
    """

    def __init__(self, body: Elastomer, ribs: BeamFrame | None) -> None:
        self._comm = body.comm
        weight = compat.constant(body.mesh, specific_weight(body.material.density))
        rises = [gravity_potential(weight, body.u) * body.volume_measure()]
        meshes = [body.mesh]
        if ribs is not None:
            weight = compat.constant(ribs.mesh, specific_weight(ribs.material.density))
            line = weight * ribs.cellwise(ribs.frame.areas())
            rises.append(gravity_potential(line, displacement(ribs.function)) * ribs.measure)
            meshes.append(ribs.mesh)
        self.multiples = [compat.constant(mesh, 0.0) for mesh in meshes]
        self.potentials = [n * rise for n, rise in zip(self.multiples, rises, strict=True)]
        self._rises = [compat.form(rise) for rise in rises]

    def fall(self) -> float:
        """Return what a multiple of standard gravity does work on, -sum of rho g u_y, in N mm."""
        return -sum(compat.assemble_scalar(self._comm, rise) for rise in self._rises)
