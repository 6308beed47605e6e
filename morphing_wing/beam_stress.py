"""The largest stress in the bars of a frame, from the stress resultants of its beams."""

from __future__ import annotations

import numpy as np
import ufl
from mpi4py import MPI

from . import compat
from .forms.beam import beam_strains
from .frame import BeamFrame
from .materials import Elastic

__all__ = ["BeamStress"]


class BeamStress:
    r"""Von Mises' stress at the ends of every bar, where it is largest between point loads.

    Normal force, bending and twisting moments are N = EA Gamma_1, M_i = EI_i K_i, T = GJ K_1; in a
    bar of a section with area A they make

    .. math:: \sigma = \sqrt{\sigma_x^2 + 3 \tau^2}, \qquad
        \sigma_x = \frac{|N|}{A} + \frac{|M_2| c_2}{I_2} + \frac{|M_3| c_3}{I_3}

    with the largest shear stress tau of torsion; shear by the transverse forces is left out. In
    a round bar the two moments act as one, sqrt(M_2^2 + M_3^2). The nearly rigid pieces where bars
    meet have no stress; nor are stress concentrations beside them in it.

    Parameters
    ----------
    beams
        The frame's finite-element side.
    material
        The bars' resin.
    """

    def __init__(self, beams: BeamFrame, material: Elastic) -> None:
        self._beams = beams
        frame, mesh = beams.frame, beams.mesh
        stiffness = beams.cellwise(frame.stiffness(material.E, material.nu))
        strains = [part[i] for part in beam_strains(beams.function, beams.cellwise(frame.axes))
                   for i in range(3)]
        self._space = compat.discontinuous_space(mesh, 1, (4,))
        wanted = ufl.as_vector([stiffness[i] * strains[i] for i in (0, 3, 4, 5)])
        self._projected = compat.form(
            ufl.inner(wanted, ufl.TestFunction(self._space)) * beams.measure)

    def resultants(self) -> np.ndarray:
        """Return N, T, M2, M3 (N, N mm) at both ends of each local bar, shape (n_local, 2, 4).

        Projected onto linear functions with the two Gauss points of the energy, which is to pass
        straight through the values there: exact for loads at a bar's ends.
        """
        nodes = self._space.dofmap.index_map
        moments = np.zeros(4 * (nodes.size_local + nodes.num_ghosts))
        compat.assemble_vector(self._projected, moments)
        n_cells = len(self._beams.bars)
        cells = [self._space.dofmap.cell_dofs(cell) for cell in range(n_cells)]
        frame = self._beams.frame
        ends = frame.points[frame.bars[self._beams.bars]]
        length = np.linalg.norm(ends[:, 1] - ends[:, 0], axis=1)
        inverse_mass = np.array([[4.0, -2.0], [-2.0, 4.0]])
        values = moments.reshape(-1, 4)[np.array(cells, dtype=int).reshape(n_cells, 2)]
        return np.einsum("ab,cbi->cai", inverse_mass, values) / length[:, None, None]

    def largest(self) -> float:
        """Return the largest stress of all bars in MPa. Collective."""
        frame, bars = self._beams.frame, self._beams.bars
        owned = self._beams.mesh.topology.index_map(1).size_local
        bars, found = bars[:owned], self.resultants()[:owned]
        largest = 0.0
        for rib, sections in enumerate(frame.sections):
            for kind, name in enumerate(frame.names):
                chosen = (frame.ribs[bars] == rib) & (frame.kinds[bars] == kind)
                if name in sections and chosen.any():
                    stress = sections[name].largest_stress(*np.moveaxis(found[chosen], -1, 0))
                    largest = max(largest, float(np.max(stress)))
        return self._beams.comm.allreduce(largest, op=MPI.MAX)
