"""What each fidelity costs and how far it is off, measured now: the trade of speed for accuracy."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import Any

from mpi4py import MPI

from . import rib, spar, wing

__all__ = ["SCENES"]

SCENES: dict[str, Callable[[MPI.Comm, bool], Iterator[dict[str, Any]]]] = {
    "spar": spar.rows, "rib": rib.rows, "wing": wing.rows,
}
"""Of each scene a generator of rows, see `morphing_wing.tradeoff.trial.row`; its second argument
says whether all cases are measured, from which "auto" picks, or the first one only."""
