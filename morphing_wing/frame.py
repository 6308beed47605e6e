"""A frame of beams on a branching interval mesh: its energy."""

from __future__ import annotations

from typing import Any

from mpi4py import MPI

from morphing_wing.forms.beam import beam_energy, beam_strains
from morphing_wing.forms.mixed_point import mixed_point_correction
from morphing_wing.geometry.frame import Frame
from morphing_wing.materials import Elastic

from .bar_mesh import BarMesh


class BeamFrame(BarMesh):
    """Bars as quadratic beams, see `morphing_wing.forms.beam`.

    Parameters
    ----------
    comm, frame, material, clamped
        See `BarMesh`.

    Attributes
    ----------
    energy
        UFL functional: stored energy in N mm.
    tangent_correction
        Bilinear form that makes the tangent robust.
    """

    def __init__(
        self, comm: MPI.Comm, frame: Frame, material: Elastic, clamped: bool = False
    ) -> None:
        super().__init__(comm, frame, material, 2, clamped)
        axes = self.cellwise(frame.axes)
        stiffness = self.cellwise(frame.stiffness(material.E, material.nu))
        dx = self.measure
        self.energy = beam_energy(self.function, axes, stiffness) * dx

        def strains(w: Any) -> list[Any]:
            return [part[i] for part in beam_strains(w, axes) for i in range(3)]

        self.tangent_correction = mixed_point_correction(
            strains, [stiffness[i] for i in range(6)], self.function, self.iterate.last,
            self.iterate.step,
        ) * dx
