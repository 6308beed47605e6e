r"""A piece of a rib, by the displacements of its cut sections alone.

In small displacements :math:`u = P q` on the sections and :math:`u = -K_{ii}^{-1} K_{ib} P q`
elsewhere store :math:`\tfrac12 q \cdot \bar K q` with

.. math:: \bar K = P^T (K_{bb} - K_{bi} K_{ii}^{-1} K_{ib}) P .
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from mpi4py import MPI
from petsc4py import PETSc

from . import blas
from .cholesky import Cholesky
from .cut_fields import COLUMNS, HELD, MIRRORED, fields
from .geometry.rib import RibGeometry
from .geometry.rib_cell import PIECES, Cut, cuts, one_cell, rib_piece
from .materials import Elastic
from .resin_body import ResinBody
from .root import on_root
from .system import EquilibriumSystem


@dataclass(frozen=True)
class Condensed:
    """The pieces of a rib.

    Attributes
    ----------
    stiffness
        Of each piece, by name: symmetric matrix over the coefficients of its cuts
        (`morphing_wing.cut_fields`), of a resin of 1 MPa, in mm. Root and tail sections are held.
    dofs
        Unknowns of all pieces' meshes.
    """

    stiffness: Mapping[str, np.ndarray]
    dofs: int


def condensed(
    comm: MPI.Comm, rib: RibGeometry, nu: float, around: int, prefix: str, parity: int = MIRRORED
) -> Condensed:
    """Return the condensed pieces of a rib; kept for ribs that differ in cells alone. Collective.

    Parameters
    ----------
    comm
        Communicator.
    rib
        Dimensions.
    nu
        The resin's Poisson ratio.
    around
        Elements around a cylinder, see `morphing_wing.geometry.rib_solid`.
    prefix
        Of the factorisation's PETSc options.
    parity
        Of the fields, see `morphing_wing.cut_fields`.
    """
    key = (one_cell(rib), nu, around, parity, comm.size)
    # Ranks may have been together with others when they condensed.
    if not all(comm.allgather(key in _kept)):
        found = {piece: _piece(comm, rib, piece, nu, around, prefix, parity) for piece in PIECES}
        _kept[key] = Condensed({name: matrix for name, (matrix, _) in found.items()},
                               sum(dofs for _, dofs in found.values()))
    return _kept[key]


_kept: dict[tuple, Condensed] = {}


def _piece(
    comm: MPI.Comm, rib: RibGeometry, piece: str, nu: float, around: int, prefix: str, parity: int
) -> tuple[np.ndarray, int]:
    """Return a piece's stiffness and its number of unknowns."""
    grid = comm.bcast(on_root(comm, lambda: rib_piece(rib, piece, around)))
    held = [(name, axis) for name in ("root", "tail") if name in grid.facets for axis in range(3)]
    held += [("symmetry", axis) for axis in HELD[parity]]
    body = ResinBody(comm, grid, Elastic(1.0, nu), held)
    system = EquilibriumSystem(comm, [body.block])
    system.set_energies([body.energy], [None])
    rows, moved = _prescribed(body, cuts(rib, piece), parity)
    return comm.bcast(_schur(system.tangent(), rows, moved, prefix)), system.size


def _prescribed(
    body: ResinBody, sections: Mapping[str, Cut], parity: int
) -> tuple[np.ndarray, np.ndarray]:
    """Return this rank's unknowns in the sections, and what the coefficients move of each."""
    space = body.function.function_space
    places = space.tabulate_dof_coordinates()
    ends = sorted({name.split("_")[0] for name in sections})
    size = len(COLUMNS[parity])
    table = np.full((len(body.block.numbers), len(ends) * size), np.nan)
    for name, section in sections.items():
        dofs = body.faces.held(space, [(name, axis) for axis in range(3)])
        first = size * ends.index(name.split("_")[0])
        table[dofs] = 0.0
        table[dofs, first : first + size] = fields(section, places[dofs // 3], parity)[
            np.arange(len(dofs)), dofs % 3]
    free = np.setdiff1d(body.block.owned, body.block.constrained)
    free = free[np.isfinite(table[free, 0])]
    return body.block.numbers[free], table[free]


def _schur(K: PETSc.Mat, rows: np.ndarray, moved: np.ndarray, prefix: str) -> np.ndarray:
    """Return the condensed matrix, on every rank."""
    blas.check()
    comm = K.comm.tompi4py()
    inner = np.setdiff1d(np.arange(*K.getOwnershipRange()), rows)
    b, i = (PETSc.IS().createGeneral(part.astype(PETSc.IntType), comm=comm)
            for part in (rows, inner))
    K_bb, K_ib, K_ii = (K.createSubMatrix(*pair) for pair in ((b, b), (i, b), (i, i)))
    K_ii.setOption(PETSc.Mat.Option.SYMMETRIC, True)
    P = PETSc.Mat().createDense(
        ((len(rows), None), (None, moved.shape[1])), array=np.asfortranarray(moved), comm=comm)
    F = K_ib.matMult(P)
    factor = Cholesky(prefix, space=200)  # of small matrices MUMPS guesses it too small
    factor.factorise(K_ii)
    if factor.error < 0:
        raise RuntimeError(
            f"a piece of the rib could not be factorised (MUMPS error {factor.error})")
    X = F.duplicate()
    factor.matrix.matSolve(F, X)
    direct = K_bb.matMult(P)
    # With its error e, minus the solution stores e . K e more: none of first order.
    inside = K_ii.matMult(X)
    parts = [(P, direct, 1.0), (F, X, -1.0), (X, F, -1.0), (X, inside, 1.0)]
    found = comm.allreduce(sum(
        sign * left.getDenseArray().T @ right.getDenseArray() for left, right, sign in parts))
    for thing in (factor, P, F, X, direct, inside, K_bb, K_ib, K_ii, K, b, i):
        thing.destroy()
    return 0.5 * (found + found.T)
