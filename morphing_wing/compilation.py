"""Compiling kernels: one process at a time in the cache, without a log on the screen."""

from __future__ import annotations

import fcntl
import logging
import os
from collections.abc import Iterator
from contextlib import ExitStack, contextmanager, nullcontext, suppress
from pathlib import Path

from mpi4py import MPI


@contextmanager
def compiling(comm: MPI.Comm) -> Iterator[None]:
    """Compile what the block asks for, all ranks together: quietly, and alone in the cache."""
    # All are to be here before rank 0 locks the cache: who still builds alone needs it too.
    comm.Barrier()
    with _quiet_compiler(), _alone_in_cache() if comm.rank == 0 else nullcontext():
        yield


@contextmanager
def _alone_in_cache() -> Iterator[None]:
    """Let one process at a time compile, and forget what a compiler that was killed has left.

    Otherwise others give up after ten seconds' wait, and an unfinished kernel fails for ever.
    """
    folder = Path(os.environ.get("XDG_CACHE_HOME", Path.home() / ".cache")) / "fenics"
    with ExitStack() as held:
        with suppress(OSError):  # where files cannot be locked, compile without
            folder.mkdir(parents=True, exist_ok=True)
            lock = held.enter_context(open(folder / "morphing-wing.lock", "w"))
            fcntl.flock(lock, fcntl.LOCK_EX)
            if _cleared.get(folder) != _changed(folder):
                _clear(folder)
        yield
        with suppress(OSError):
            _cleared[folder] = _changed(folder)


_cleared: dict[Path, int] = {}
"""When each cache last changed that had nothing unfinished in it."""


def _changed(folder: Path) -> int:
    return folder.stat().st_mtime_ns


def _clear(folder: Path) -> None:
    """Remove what was not finished; the cache may hold thousands of files."""
    names = set(os.listdir(folder))
    for name in names:
        if name.endswith(".c") and f"{name}.cached" not in names:
            (folder / name).unlink()


@contextmanager
def _quiet_compiler() -> Iterator[None]:
    """Keep the build tool's log of compiler calls off the screen."""
    before = logging.root.manager.disable
    logging.disable(logging.INFO)
    try:
        yield
    finally:
        logging.disable(before)
