"""The rungs of the wing's ladder, and the ribs that each of them has."""

from __future__ import annotations

from dataclasses import dataclass

from mpi4py import MPI

from .bar_mesh import BarMesh
from .errors import is_count, require
from .frame import BeamFrame
from .geometry.frame import join
from .geometry.wing import WingGeometry
from .geometry.wing_mesh import WingMeshing
from .linked_ribs import LinkedRibs
from .materials import Elastic
from .solid_ribs import SolidRibs


@dataclass(frozen=True)
class WingFidelity:
    """One rung of the wing's ladder.

    Attributes
    ----------
    meshing, element
        Of the elastomer.
    rib_model
        One of `RIB_MODELS`.
    """

    meshing: WingMeshing
    element: str
    rib_model: str = "frame"


FIDELITIES = {
    "draft": WingFidelity(WingMeshing.fine(), "Q1 enhanced"),
    "standard": WingFidelity(WingMeshing.coarse(), "Q2 reduced"),
    "reference": WingFidelity(WingMeshing.resolved(), "Q2 reduced", "cell"),
}

RIB_MODELS = {"frame": None, "cell": 18, "solid": 6}
"""How ribs are modelled, and with how many elements around a pivot."""


def checked_model(model: str, around: int | None) -> tuple[str, int | None]:
    """Return a model of the ribs and its elements around a pivot, by default the model's own.

    Raises
    ------
    InputError
        If there is no such model, or it cannot have so many.
    """
    require(model in RIB_MODELS, "rib_model", model, "", f"one of {', '.join(RIB_MODELS)}")
    if around is None:
        return model, RIB_MODELS[model]
    require(model != "frame" and is_count(around) and around >= 4, "around", around, "",
            'a whole number of at least 4, with rib_model "cell" or "solid"')
    return model, around


def made_ribs(
    comm: MPI.Comm, wing: WingGeometry, resin: Elastic, model: str, around: int | None, prefix: str
) -> BarMesh | SolidRibs:
    """Return a wing's ribs; ``prefix`` is that of the scene's PETSc options. Collective."""
    rib, roots = wing.rib, wing.rib_roots()
    if model == "solid":
        return SolidRibs(comm, rib, resin, around, roots)
    if model == "cell":
        return LinkedRibs(comm, rib, resin, around, roots, prefix=f"{prefix}ribs_")
    return BeamFrame(comm, join([rib.frame().placed(x) for x in roots]), resin)
