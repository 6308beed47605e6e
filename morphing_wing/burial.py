"""Freeing PETSc objects under MPI.

To free one all ranks must act together, but each rank's garbage collector finds it dead at a moment
of its own. So petsc4py keeps dead vectors and matrices until it is told that all ranks are there,
and dead solvers wait here until a collective occasion, or the end of the program.
"""

from __future__ import annotations

import atexit
import itertools
import weakref
from typing import Any

from mpi4py import MPI
from petsc4py import PETSc

_numbers = itertools.count()
_waiting: dict[int, tuple[Any, ...]] = {}
_dead: set[int] = set()


def register(owner: Any, comm: MPI.Comm, *parts: Any) -> None:
    """Free ``parts`` (with a method ``destroy``), in order, some time after ``owner`` has died."""
    if comm.size == 1:
        weakref.finalize(owner, _free, parts)
        return
    number = next(_numbers)
    _waiting[number] = parts
    weakref.finalize(owner, _dead.add, number).atexit = False


def bury(comm: MPI.Comm) -> None:
    """Free what is dead on every rank. Collective."""
    if comm.size > 1:
        for number in sorted(set.intersection(*comm.allgather(_dead))):
            _dead.discard(number)
            _free(_waiting.pop(number))
        PETSc.garbage_cleanup(comm)


def _free(parts: tuple[Any, ...]) -> None:
    for part in parts:
        part.destroy()


@atexit.register
def _free_all() -> None:
    while _waiting:
        _free(_waiting.pop(min(_waiting)))
