"""Cases computed one by one, each as soon as something is free for it: here, in processes, by MPI.

Results come in the order in which cases end. Each case is computed by one process on its own, so
that what comes out does not depend on how many there are.
"""

from __future__ import annotations

import concurrent.futures
from collections import deque
from collections.abc import Callable, Iterable, Iterator
from typing import Any

import threadpoolctl
from mpi4py import MPI

from .worker_processes import ended, worker_pool, world_of_their_own

__all__ = ["GONE", "by_mpi", "here", "in_processes", "petsc_alone"]

Task = tuple[int, Any]
Compute = Callable[[Any], dict[str, Any]]

GONE = ("the process that computed it was gone in the middle, killed from outside or for want of "
        "memory")
_AHEAD = 2  # cases that wait for each worker, so that none waits for a case


def here(compute: Compute, tasks: Iterable[Task]) -> Iterator[tuple[int, dict[str, Any]]]:
    """Compute all tasks in this process, on one thread as others do."""
    with threadpoolctl.threadpool_limits(1):  # once: to look for all libraries takes milliseconds
        for number, task in tasks:
            yield number, compute(task)


def in_processes(
    compute: Compute, tasks: Iterable[Task], workers: int
) -> Iterator[tuple[int, dict[str, Any]]]:
    """Compute tasks in so many processes on this machine.

    Where a process is gone, the cases that were given out are tried once more, one by one; one
    whose process is gone again is said to be ``stopped`` so. Leaving the iteration before its end
    ends the processes.

    Parameters
    ----------
    compute
        Can be pickled, as tasks and results can.
    tasks
        Number and what to compute.
    workers
        Number of processes.
    """
    waiting = deque(tasks)
    while waiting:
        suspects = deque((yield from _until_broken(compute, waiting, workers, _AHEAD * workers)))
        while suspects:  # one by one, so that it is known which one is at work
            for number, _ in (yield from _until_broken(compute, suspects, 1, 1)):
                yield number, {"stopped": GONE}


def _until_broken(
    compute: Compute, waiting: deque[Task], workers: int, most: int
) -> Iterator[tuple[int, dict[str, Any]]]:
    """Yield results; return the tasks, at most ``most``, that were out when a process was gone."""
    pool, running = worker_pool(workers), {}
    at_once = True
    try:
        while waiting or running:
            with world_of_their_own():
                while waiting and len(running) < most:
                    running[pool.submit(compute, waiting[0][1])] = waiting[0]
                    waiting.popleft()
            done, _ = concurrent.futures.wait(
                running, return_when=concurrent.futures.FIRST_COMPLETED)
            for future in done:
                result = future.result()
                yield running.pop(future)[0], result
        at_once = False
    except concurrent.futures.BrokenExecutor:
        # What was to come next is innocent, but nothing tells it from the one that broke it.
        return sorted(running.values(), key=lambda task: task[0])
    finally:
        ended(pool, at_once)
    return []


def by_mpi(
    compute: Compute, tasks: Iterable[Task], pool: Any, workers: int
) -> Iterator[tuple[int, dict[str, Any]]]:
    """Compute tasks by an executor of mpi4py.futures; one that fails raises.

    Call `petsc_alone` on the root before.

    Parameters
    ----------
    compute, tasks
        See `in_processes`.
    pool
        ``MPIPoolExecutor``, or what ``MPICommExecutor`` gives the root.
    workers
        How many processes it has.
    """
    waiting, running = deque(tasks), {}
    while waiting or running:
        while waiting and len(running) < _AHEAD * workers:
            number, task = waiting.popleft()
            running[pool.submit(_alone, compute, task)] = number
        done, _ = concurrent.futures.wait(
            running, return_when=concurrent.futures.FIRST_COMPLETED)
        for future in done:
            yield running.pop(future), future.result()


def petsc_alone() -> None:
    """Begin PETSc for this process alone, unless it has begun.

    Otherwise its beginning and its end wait for all ranks, and those deal with cases.
    """
    import petsc4py

    petsc4py.init(comm=MPI.COMM_SELF)


def _alone(compute: Compute, task: Any) -> dict[str, Any]:
    petsc_alone()
    return compute(task)
