"""All ranks of a command end together, with one status and one sentence, and none waits for ever.

A rank that fails alone would leave the others waiting for it in their next collective call. It
therefore waits a little for the others to arrive at the end as well, and if they do not, ends them.
"""

from __future__ import annotations

import contextlib
import os
import sys
import time
from collections.abc import Callable
from typing import Any

import numpy as np
from mpi4py import MPI

__all__ = [
    "BAD_INPUT", "DONE", "INTERRUPTED", "NOT_VERIFIED", "PATIENCE", "STOPPED", "UNEXPECTED",
    "agree", "run_together",
]

DONE, UNEXPECTED, BAD_INPUT, STOPPED, NOT_VERIFIED, INTERRUPTED = 0, 1, 2, 3, 4, 130

PATIENCE = 10.0
"""Seconds that a rank which failed waits for the others before it ends them."""


def run_together(
    comm: MPI.Comm,
    command: Callable[[], int],
    explain: Callable[[BaseException], tuple[int, str]],
    patience: float = PATIENCE,
) -> int:
    """Run a command on every rank and return the same exit status on all.

    Parameters
    ----------
    comm
        mpi4py communicator; every rank calls.
    command
        Returns the exit status; prints as it likes, but only rank 0 is heard on stdout.
    explain
        Turns what ``command`` raised into exit status and sentence.
    patience
        Seconds that a failed rank waits for the others; afterwards it aborts the job.

    Returns
    -------
    int
        The largest status of all ranks; where it comes from an exception, the lowest rank that
        raised has written its sentence on stderr.
    """
    ends = comm.Dup()  # messages about the end must never meet those of the command
    sentence = None
    try:
        with nothing_said() if comm.rank > 0 else contextlib.nullcontext():
            status = command()
    except BaseException as problem:
        status, sentence = explain(problem)
    status, speaker = agree(ends, status, sentence, patience)
    if sentence is not None and comm.rank == speaker:
        say(sentence)
    ends.Free()
    return status


def agree(ends: MPI.Comm, status: int, sentence: str | None, patience: float) -> tuple[int, int]:
    """Return the largest status of all ranks, and the lowest rank that has a sentence to say."""
    speaks = ends.rank if sentence is not None else ends.size
    mine, all_ranks = np.array([status, -speaks]), np.zeros(2, dtype=int)
    request = ends.Iallreduce(mine, all_ranks, op=MPI.MAX)
    deadline = time.monotonic() + patience
    while not request.Test():
        if sentence is not None and time.monotonic() > deadline:
            say(sentence)
            ends.Abort(status)
        time.sleep(0.01)
    return int(all_ranks[0]), int(-all_ranks[1])


def say(sentence: str) -> None:
    """Write one line on stderr."""
    print(sentence, file=sys.stderr, flush=True)


@contextlib.contextmanager
def nothing_said() -> Any:
    """Send what is printed on stdout nowhere."""
    with open(os.devnull, "w") as nowhere, contextlib.redirect_stdout(nowhere):
        yield
