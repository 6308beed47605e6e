"""One or several ribs as chains of condensed cells, with the same ends as a frame of them has."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
import ufl
from mpi4py import MPI

from .bar_mesh import BarMesh
from .condensation import condensed
from .cut_fields import MIRRORED, REVERSED
from .forms.beam import beam_strains
from .forms.mixed_point import mixed_point_correction
from .geometry.frame import join
from .geometry.rib import RibGeometry
from .geometry.rib_cell import link_frame
from .materials import Elastic
from .rib_links import DEFORMATIONS, link_stiffness


class LinkedRibs(BarMesh):
    r"""Ribs of which each cell is one link, as stiff as its solid, see `morphing_wing.rib_links`.

    A link of length L between two nodes is a linear beam with its one point of integration in the
    middle (`morphing_wing.forms.beam`), but for its stiffness K against the motion of one end seen
    from the other:

    .. math:: \Pi = \tfrac12 d \cdot K d, \qquad d = L (\Gamma, K_1, K_2, K_3) .

    However far it has turned, it stores what it stores in small displacements; that a bent link's
    chord is a little shorter is left out, 0.07 % where it bends by 7.5 degrees.

    Root, cell and tail are condensed once in a process for all ribs that differ in the number of
    cells and Young's modulus alone. What works on a rib between its ends, as contact and weight do,
    works on its axis between the cells.

    Parameters
    ----------
    comm
        Communicator.
    rib, material
        Dimensions, the same of each; resin.
    around
        Elements around a cylinder, see `morphing_wing.geometry.rib_solid`.
    roots : (n_ribs, 3) array
        Where each one's root is, mm.
    clamped
        Whether roots do not move.
    planar
        Whether the axis stays in its plane z = constant and sections turn about z alone.
    prefix
        Of the condensation's PETSc options.

    Attributes
    ----------
    energy
        UFL functional: stored energy in N mm.
    tangent_correction
        Bilinear form that makes the tangent robust.
    mesh_dofs
        Unknowns of the meshes that were condensed.

    Raises
    ------
    InputError
        If a rib has not three layers, parts collide, or the root's plane meets the cuts.
    """

    def __init__(
        self, comm: MPI.Comm, rib: RibGeometry, material: Elastic, around: int,
        roots: Sequence[Sequence[float]] = ((0.0, 0.0, 0.0),), clamped: bool = False,
        planar: bool = False, prefix: str = "ribs_factor_",
    ) -> None:
        one, parities = link_frame(rib), (MIRRORED,) if planar else (MIRRORED, REVERSED)
        super().__init__(comm, join([one.placed(root) for root in roots]), material, 1, clamped,
                         held=DEFORMATIONS[REVERSED] if planar else ())
        self.carried = join([rib.frame().placed(root) for root in roots])
        pieces = [condensed(comm, rib, material.nu, around, prefix, p) for p in parities]
        self.mesh_dofs = pieces[0].dofs
        # K = A A^T of each, so that the energy is a sum of squares as mixed points want it.
        lengths = np.sqrt(self.frame.lengths())[:, None, None]
        A = [self.cellwise(lengths * np.tile(np.linalg.cholesky(
            link_stiffness(rib, found.stiffness, material.E, parity)), (len(roots), 1, 1)))
            for found, parity in zip(pieces, parities, strict=True)]
        axes = self.cellwise(self.frame.axes)

        def strains(w: Any) -> list[Any]:
            d = [part[i] for part in beam_strains(w, axes) for i in range(3)]
            return [sum(A[p][j, i] * d[DEFORMATIONS[p][j]] for j in range(i, 3))
                    for p in parities for i in range(3)]

        dx = ufl.dx(domain=self.mesh, metadata={"quadrature_degree": 0})
        self.energy = 0.5 * sum(s**2 for s in strains(self.function)) * dx
        self.tangent_correction = mixed_point_correction(
            strains, [1.0] * 3 * len(parities), self.function, self.iterate.last,
            self.iterate.step) * dx
