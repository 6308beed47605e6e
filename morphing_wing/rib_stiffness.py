r"""The rib's stiffness against the six motions of its tail, and what it is as a beam.

Clamped at its root, unloaded, the tail answers to small forces F and moments M by its translation
u and rotation theta,

.. math:: (u_x, u_y, u_z, \theta_x, \theta_y, \theta_z)^T = C \, (F_x, F_y, F_z, M_x, M_y, M_z)^T,

x chordwise, y along the height, z along the span and the pivots; u in mm at the point (n p, 0, 0),
theta in radians, forces in N, moments in N mm. By Maxwell and Betti C is symmetric. Each figure
below is the tail's motion under one load alone, all other motions free: a prismatic bar of the
rib's length L = n p with EI = M L / theta (GJ likewise) turns as much under the same moment, one
with EA = F L / u stretches as much. Root and tail are rigid blocks, which keep the ends from
warping.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
import pandas as pd

from .condensed_rib import CondensedRib
from .errors import require
from .geometry.rib import RibGeometry
from .materials import RESIN, Elastic
from .rib import Rib

if TYPE_CHECKING:
    from mpi4py import MPI

__all__ = ["RibStiffness", "rib_stiffness", "stiffness_table", "tail_compliance"]


@dataclass(frozen=True)
class RibStiffness:
    """What a rib's tail answers to small loads.

    Attributes
    ----------
    geometry
        The rib's dimensions.
    compliance : (6, 6) array
        C above: mm/N, mm/(N mm) and rad/N, rad/(N mm).
    """

    geometry: RibGeometry
    compliance: np.ndarray

    @property
    def chordwise_bending(self) -> float:
        """EI_z = M_z L / theta_z in N mm^2: what a cable works against."""
        return self.geometry.length / self.compliance[5, 5]

    @property
    def spanwise_bending(self) -> float:
        """EI_y = M_y L / theta_y in N mm^2: bending out of the rib's plane, towards the span."""
        return self.geometry.length / self.compliance[4, 4]

    @property
    def torsion(self) -> float:
        """GJ = M_x L / theta_x in N mm^2: twist about the chord."""
        return self.geometry.length / self.compliance[3, 3]

    @property
    def axial(self) -> float:
        """EA = F_x L / u_x in N."""
        return self.geometry.length / self.compliance[0, 0]

    @property
    def degrees_per_Nmm(self) -> float:
        """theta_z in degrees under M_z = 1 N mm, the slope of the paper's Figure 5B-2."""
        return float(np.degrees(self.compliance[5, 5]))

    @property
    def anisotropy(self) -> float:
        """EI_y / EI_z: how much stiffer spanwise than chordwise."""
        return self.spanwise_bending / self.chordwise_bending

    @property
    def anisotropy_of_full_bar(self) -> float:
        """EI_y / EI_z of a full rectangular bar as deep and as high as the rib."""
        rib = self.geometry
        return (rib.depth / (rib.height + rib.pivot_diameter)) ** 2

    @property
    def coupling(self) -> np.ndarray:
        """C_ij / sqrt(C_ii C_jj), shape (6, 6): between -1 and 1, 0 where i is free of load j."""
        size = np.sqrt(np.diag(self.compliance))
        return self.compliance / np.outer(size, size)

    def against_force(self, degrees: float | np.ndarray) -> float | np.ndarray:
        """Return F / u in N/mm of a force F across the tail, u its deflection along the force.

        Parameters
        ----------
        degrees
            Direction of the force in the plane of span and height: 0 along z, 90 along y.
        """
        angle = np.radians(degrees)
        along = np.stack([np.sin(angle), np.cos(angle)], axis=-1)
        return 1.0 / np.einsum("...i,ij,...j->...", along, self.compliance[1:3, 1:3], along)


class CondensedInSpace(CondensedRib):
    """A chain of condensed cells that may leave its plane."""

    planar = False


FIDELITIES = {"draft": Rib, "cell": CondensedInSpace}


def rib_stiffness(
    geometry: RibGeometry, material: Elastic = RESIN, comm: MPI.Comm | None = None,
    fidelity: str = "draft",
) -> RibStiffness:
    """Return the stiffness of a rib. Collective.

    Parameters
    ----------
    geometry, material, comm
        As a `Rib` has them.
    fidelity
        "draft", a frame of beams, which knows out of its plane too little of what joints stiffen;
        or "cell", a chain of condensed cells: half a minute, as good as a whole solid.

    Raises
    ------
    InputError
        If the fidelity is another one, or cells cannot be condensed.

    Examples
    --------
    >>> rib_stiffness(RibGeometry.validation()).degrees_per_Nmm          # doctest: +SKIP
    1.0288
    """
    require(fidelity in FIDELITIES, "fidelity", fidelity, "", f"one of {', '.join(FIDELITIES)}")
    rib = FIDELITIES[fidelity](geometry, material, fidelity, comm)
    return RibStiffness(geometry, tail_compliance(rib))


def stiffness_table(
    geometries: Mapping[str, RibGeometry], material: Elastic = RESIN, comm: MPI.Comm | None = None,
    fidelity: str = "draft",
) -> pd.DataFrame:
    """Return one row a rib: its stiffnesses and their ratios, units in the columns' names.

    Parameters
    ----------
    geometries
        Label of the row -> dimensions.
    material, comm, fidelity
        See `rib_stiffness`. Collective.
    """
    rows = {}
    for label, geometry in geometries.items():
        found = rib_stiffness(geometry, material, comm, fidelity)
        rows[label] = {
            "deg_per_Nmm": found.degrees_per_Nmm,
            "EI_z_Nmm2": found.chordwise_bending, "EI_y_Nmm2": found.spanwise_bending,
            "GJ_Nmm2": found.torsion, "EA_N": found.axial,
            "k_y_N_per_mm": found.against_force(90.0), "k_z_N_per_mm": found.against_force(0.0),
            "EI_y/EI_z": found.anisotropy, "of_full_bar": found.anisotropy_of_full_bar,
        }
    return pd.DataFrame.from_dict(rows, orient="index")


def tail_compliance(rib: Rib) -> np.ndarray:
    """Return C of a whole rib in the converged state in which it stands; new ribs are at rest.

    One factorisation and six solutions. Collective. The rotation vector works with moments in
    space only at theta = 0; in a bent state rows and columns 3 to 5 are of its components.

    Returns
    -------
    (6, 6) array
        The same on every rank.
    """
    rib.take_into_use([])
    factor, system = rib.linearise(), rib.system
    numbers = rib.ribs.end_numbers("tail", 0)
    first, end = system.x.getOwnershipRange()
    here = np.flatnonzero((numbers >= first) & (numbers < end))
    compliance = np.zeros((6, 6))
    force, motion = system.x.duplicate(), system.x.duplicate()
    for load in range(6):
        force.set(0.0)
        if load in here:
            force.setValue(numbers[load], 1.0)
        force.assemble()
        factor.solve(force, motion)
        compliance[here, load] = motion.getArray(readonly=True)[numbers[here] - first]
    force.destroy()
    motion.destroy()
    return system.comm.allreduce(compliance)
