"""The rungs of the spar's ladder: meshes and elements, and which one its options allow."""

from __future__ import annotations

import warnings
from dataclasses import dataclass
from typing import Any

from .errors import InputError
from .geometry.spar import SparGeometry, SparMeshing
from .ladder import AUTO, Pick, pick


@dataclass(frozen=True)
class SparFidelity:
    """One rung of the spar's ladder: a mesh and an element.

    Attributes
    ----------
    meshing, element
        The mesh and the element.
    slender
        Length of a chamber over the thinner of its ceiling and floor up to which the rung's error
        was measured; beyond it the mesh is refined along the chamber.
    """

    meshing: SparMeshing
    element: str
    slender: float


CELL = SparFidelity(SparMeshing.cornered(), "Q2/P1disc", slender=10.0)
FIDELITIES = {
    "draft": SparFidelity(SparMeshing.graded(1), "Q1/P0", slender=4.0),
    "standard": SparFidelity(SparMeshing.graded(1), "Q2/P1disc", slender=10.0),
    "reference": SparFidelity(SparMeshing.cornered(), "Q2/P1disc", slender=10.0),
}
"""Of whole spars; the ladder has the formula and the cell beside them."""

SLENDER_INTERVAL = 1.5
"""Longest interval along a chamber, in thicknesses of its thinnest wall, where it is slender."""


def pick_of(
    geometry: SparGeometry,
    fidelity: str,
    tolerance: float | None = None,
    half: bool = True,
    contact: bool = False,
    filled: str | None = None,
    meshing: SparMeshing | None = None,
    element: str | None = None,
) -> Pick:
    """Return the rung for a spar's options, see `morphing_wing.ladder.pick`.

    "auto" takes whole spars only where cells are not alike, or more is modelled than they have. The
    error is None where the mesh or the element is not the rung's own.

    Raises
    ------
    InputError
        If there is no such rung, or it does not go with the other options.
    """
    own = meshing is None and element is None
    if fidelity == AUTO and not own:
        name = "element" if meshing is None else "meshing"
        raise InputError(f"{name}: must be left out where fidelity is {AUTO!r}")
    alike = geometry.wall_lengths is None
    whole = contact or filled is not None or not half or not alike
    allowed = tuple(FIDELITIES) if whole else None
    found = pick("spar", fidelity, tolerance, geometry.n_cells, allowed)
    known = own and slenderness(geometry) <= FIDELITIES.get(found.fidelity, CELL).slender
    if not known:
        found = Pick(found.fidelity, None)
    if found.fidelity in FIDELITIES:
        return found
    for name, value, usual in (("half", half, True), ("contact", contact, False),
                               ("filled", filled, None)):
        if value != usual:
            raise InputError(f"{name} = {value!r}: must be {usual} where fidelity is "
                             f"{found.fidelity!r}")
    if not alike:
        raise InputError(f"wall_lengths = {geometry.wall_lengths} mm: must be left out where "
                         f"fidelity is {found.fidelity!r}, whose cells are all alike")
    return found


def slenderness(geometry: SparGeometry) -> float:
    """Return the length of a chamber over the thinner of its ceiling and floor."""
    return geometry.cavity_length / min(geometry.top_thickness, geometry.middle_thickness)


def fitted(geometry: SparGeometry, rung: SparFidelity, fidelity: str, comm: Any) -> SparMeshing:
    """Return a rung's meshing for a geometry, and warn where its error is not known."""
    ratio = slenderness(geometry)
    if ratio <= rung.slender:
        return rung.meshing
    if comm.rank == 0:
        warnings.warn(
            f"cavity_length = {geometry.cavity_length:g} mm: is {ratio:.3g} times the thinnest "
            f"wall above or below a chamber; {fidelity}'s error is known up to "
            f"{rung.slender:g} times, and its mesh is refined beyond: compare finer meshings",
            stacklevel=4)
    return rung.meshing.shortened(SLENDER_INTERVAL / ratio)
