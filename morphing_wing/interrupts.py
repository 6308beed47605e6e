"""Ctrl-C that reaches its caller, though compiled code in which it is raised may swallow it."""

from __future__ import annotations

import contextlib
import signal
import threading
from collections.abc import Iterator
from types import FrameType

__all__ = ["interrupts_noticed"]


@contextlib.contextmanager
def interrupts_noticed() -> Iterator[None]:
    """Raise KeyboardInterrupt at the end of the block if Ctrl-C came in it, whatever became of it.

    At once as well, as ever; in threads, and where Ctrl-C has another meaning, only so.
    """
    usual = signal.getsignal(signal.SIGINT)
    if (usual is not signal.default_int_handler
            or threading.current_thread() is not threading.main_thread()):
        yield
        return
    came = False

    def handler(number: int, frame: FrameType | None) -> None:
        nonlocal came
        came = True
        signal.default_int_handler(number, frame)

    signal.signal(signal.SIGINT, handler)
    try:
        yield
    finally:
        signal.signal(signal.SIGINT, usual)
    if came:
        raise KeyboardInterrupt
