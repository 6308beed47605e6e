"""What rank 0 does alone: files written whole, and failures that reach every rank."""

from __future__ import annotations

import contextlib
import fcntl
import glob
import os
import tempfile
from collections.abc import Callable
from pathlib import Path
from typing import Any, TypeVar

__all__ = ["on_root", "write_whole"]

Result = TypeVar("Result")


def on_root(comm: Any, action: Callable[[], Result]) -> Result | None:
    """Run ``action`` on rank 0; where it fails there, raise on every rank.

    Without this a full disk would stop rank 0 alone and leave the others waiting for it for ever
    in the next collective call.

    Parameters
    ----------
    comm
        mpi4py communicator; every rank calls.
    action
        Called without arguments on rank 0 only.

    Returns
    -------
    What ``action`` returned on rank 0, None on the others.

    Raises
    ------
    Exception
        On rank 0 what ``action`` raised; on the others the same type where it can be built from a
        message, else RuntimeError.
    """
    result, failure = None, None
    if comm.rank == 0:
        try:
            result = action()
        except Exception as error:
            failure = error
    told = comm.bcast(None if failure is None else (type(failure), str(failure)), root=0)
    if failure is not None:
        raise failure
    if told is not None:
        raise _rebuilt(*told)
    return result


def _rebuilt(kind: type[Exception], message: str) -> Exception:
    try:
        return kind(message)
    except TypeError:
        return RuntimeError(f"{kind.__name__}: {message}")


def write_whole(file: str | os.PathLike, write: Callable[[Path], Any]) -> Path:
    """Write a file so that it is there whole or not at all.

    ``write`` gets the name of a temporary file in the same folder, with the same suffix; the
    finished file then takes its name in one step, so a reader, or a killed run, never meets half
    of it. Folders are made as required. What a killed run has left of its temporary file for the
    same name is removed.

    Parameters
    ----------
    file
        Final name.
    write
        Writes the file of the name that it is given.

    Returns
    -------
    The final name.
    """
    file = Path(file)
    file.parent.mkdir(parents=True, exist_ok=True)
    prefix = f".{file.stem}-"
    for left in file.parent.glob(glob.escape(prefix) + "????????" + glob.escape(file.suffix)):
        _remove_unless_locked(left)
    handle, name = tempfile.mkstemp(prefix=prefix, suffix=file.suffix, dir=file.parent)
    temporary = Path(name)
    try:
        with contextlib.suppress(OSError):  # not every file system has locks
            fcntl.flock(handle, fcntl.LOCK_EX | fcntl.LOCK_NB)
        write(temporary)
        temporary.chmod(0o666 & ~_umask())
        os.replace(temporary, file)
    finally:
        temporary.unlink(missing_ok=True)
        os.close(handle)
    return file


def _remove_unless_locked(file: Path) -> None:
    # The lock of a writer ends with it, however it ends.
    with contextlib.suppress(OSError), file.open("rb") as there:
        fcntl.flock(there, fcntl.LOCK_EX | fcntl.LOCK_NB)
        file.unlink()


def _umask() -> int:
    mask = os.umask(0)
    os.umask(mask)
    return mask
