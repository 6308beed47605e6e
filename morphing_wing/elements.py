"""Finite elements for nearly incompressible hexahedra: what each one is made of."""

from __future__ import annotations

from dataclasses import dataclass

from .errors import InputError


@dataclass(frozen=True)
class Element:
    """A displacement element with or without a pressure or strains of its own.

    Attributes
    ----------
    name
        As the user writes it.
    degree
        Degree of the displacement.
    pressure
        Family and degree of the pressure, None for the displacement form.
    quadrature, volumetric_quadrature
        Polynomial degrees that the Gauss rules of the isochoric and the volumetric part integrate.
        Never left to an estimate: for ``J^(-2/3)`` that is 39.
    enhanced
        Whether cells of thin regions have strains of their own, see
        `morphing_wing.forms.enhanced`; their volumetric part has the isochoric one's quadrature.
    """

    name: str
    degree: int
    pressure: tuple[str, int] | None
    quadrature: int
    volumetric_quadrature: int
    enhanced: bool = False


_ELEMENTS = (
    Element("Q2/P1disc", 2, ("DPC", 1), 5, 5),
    Element("Q2/Q1", 2, ("Lagrange", 1), 5, 5),
    Element("Q1/P0", 1, ("DG", 0), 3, 3),
    Element("Q2 reduced", 2, None, 5, 3),
    Element("Q1 reduced", 1, None, 3, 1),
    Element("Q1 enhanced", 1, None, 3, 1, enhanced=True),
)
ELEMENTS = {element.name: element for element in _ELEMENTS}


def element(name: str) -> Element:
    """Return an element by name.

    Raises
    ------
    InputError
        If there is none of this name.
    """
    if name not in ELEMENTS:
        raise InputError(f"element = {name!r}: must be one of {', '.join(ELEMENTS)}")
    return ELEMENTS[name]
