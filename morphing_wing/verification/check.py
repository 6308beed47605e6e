"""A number with a known answer, and a problem that yields some of them."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass

from mpi4py import MPI

__all__ = ["Check", "Problem"]


@dataclass(frozen=True)
class Check:
    """One number that was computed now, against what it must be.

    Attributes
    ----------
    name
        What it is, of which element, where.
    value, reference
        Computed and known.
    unit
        Of both.
    tolerance
        Largest error: relative, or absolute where the reference is zero.
    """

    name: str
    value: float
    reference: float
    unit: str
    tolerance: float

    @property
    def error(self) -> float:
        """Error of the value, relative unless the reference is zero."""
        difference = self.value - self.reference
        return difference / abs(self.reference) if self.reference else difference

    @property
    def holds(self) -> bool:
        """Whether the error is within the tolerance; false where it is not a number."""
        return abs(self.error) <= self.tolerance


@dataclass(frozen=True)
class Problem:
    """A problem with known answers.

    Attributes
    ----------
    name, title
        Short name for the command line, and what it is in words.
    source
        Where the answers come from.
    run
        Called with a communicator; yields checks as they are found. Collective.
    quick
        Whether it takes seconds.
    """

    name: str
    title: str
    source: str
    run: Callable[[MPI.Comm], Iterator[Check]]
    quick: bool = False
