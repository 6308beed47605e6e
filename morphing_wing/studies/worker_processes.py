"""Processes that compute cases: each alone in its own MPI, on one thread, ended with its parent."""

from __future__ import annotations

import concurrent.futures
import ctypes
import multiprocessing
import os
import signal
import threading
from collections.abc import Iterator
from contextlib import contextmanager

__all__ = ["ended", "worker_pool", "world_of_their_own"]

_OF_MPI = ("OMPI_", "PMIX_", "PMI_", "ORTE_", "PRTE_", "HYDRA_", "MPI_LOCALRANKID")
_LAUNCHED = ("OMPI_COMM_WORLD_SIZE", "PMIX_RANK", "PMI_RANK")
_SETTINGS = "OMPI_ALLOW_"
_ONE_THREAD = {"OMP_NUM_THREADS": "1", "OPENBLAS_NUM_THREADS": "1"}


def worker_pool(workers: int) -> concurrent.futures.ProcessPoolExecutor:
    """Return a pool of processes that are started anew, not forked.

    A fork would share the MPI of this process, and its locks. They leave Ctrl-C to this process,
    and end where it is killed. Submit within `world_of_their_own`: that is when they start.
    """
    return concurrent.futures.ProcessPoolExecutor(
        workers, mp_context=multiprocessing.get_context("spawn"), initializer=_begin)


def ended(pool: concurrent.futures.ProcessPoolExecutor, at_once: bool) -> None:
    """End a pool: after its cases, or at once, in the middle of them."""
    # There is no public way to end processes that are at work before Python 3.14.
    processes = list((getattr(pool, "_processes", None) or {}).values())
    if at_once:
        for process in processes:
            process.terminate()
    pool.shutdown(wait=True, cancel_futures=True)


@contextmanager
def world_of_their_own() -> Iterator[None]:
    """Start processes inside without what MPI left in the environment, each on one thread.

    MPI sets variables past Python's ``os.environ``; a process that inherits them takes itself for
    this one's double. What the user set remains, but under mpirun the two cannot be told apart.
    """
    before = _environment()
    launched = any(name in os.environ for name in _LAUNCHED)
    hidden = [name for name in before if name.startswith(_OF_MPI)
              and (launched or name not in os.environ) and not name.startswith(_SETTINGS)]
    for name in hidden:
        os.unsetenv(name)
    for name, value in _ONE_THREAD.items():
        os.putenv(name, value)
    try:
        yield
    finally:
        for name in _ONE_THREAD:
            if name not in before:
                os.unsetenv(name)
        for name in (*hidden, *(name for name in _ONE_THREAD if name in before)):
            os.putenv(name, before[name])


def _environment() -> dict[str, str]:
    """Return the C library's environment."""
    table = ctypes.POINTER(ctypes.c_char_p).in_dll(ctypes.CDLL(None), "environ")
    found, place = {}, 0
    while table[place]:
        name, _, value = os.fsdecode(table[place]).partition("=")
        found[name] = value
        place += 1
    return found


def _begin() -> None:
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    threading.Thread(target=_end_with_parent, daemon=True).start()


def _end_with_parent() -> None:
    parent = multiprocessing.parent_process()
    if parent is not None:
        parent.join()
        os._exit(1)  # nobody reads the result any more
