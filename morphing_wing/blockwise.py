"""Formulas over arrays that broadcast, evaluated in blocks that stay in the processor's cache."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

__all__ = ["in_blocks"]

BLOCK = 4096
"""Values in a block: a few dozen arrays of them fit into a core's second cache."""


def in_blocks(
    function: Callable[..., tuple[np.ndarray, ...]], *arrays: np.ndarray
) -> tuple[np.ndarray, ...]:
    """Return what an elementwise function gives, in the arrays' common shape.

    Without blocks, formulas of a hundred operations on large arrays wait for memory most of their
    time.

    Parameters
    ----------
    function
        Takes as many arrays as are given, all of shape (n,); returns a tuple of real such arrays.
    arrays
        Of shapes that broadcast.

    Examples
    --------
    >>> total, = in_blocks(lambda a, b: (a + b,), np.ones((2, 1)), np.arange(3.0))
    >>> total
    array([[1., 2., 3.],
           [1., 2., 3.]])
    """
    shape = np.broadcast_shapes(*(np.shape(array) for array in arrays))
    size = int(np.prod(shape))
    if size <= BLOCK:
        found = function(*(np.broadcast_to(array, shape).ravel() for array in arrays))
        return tuple(part.reshape(shape) for part in found)
    blocks = np.nditer(
        [np.broadcast_to(array, shape) for array in arrays], ["external_loop", "buffered"],
        [["readonly"]] * len(arrays), order="C", buffersize=BLOCK)
    out, start = None, 0
    for block in blocks:
        # nditer uses its buffers again, and hands out constant arrays with a stride of zero.
        parts = function(*(np.array(array) for array in block))
        if out is None:
            out = np.empty((len(parts), size))
        out[:, start : start + len(parts[0])] = parts
        start += len(parts[0])
    return tuple(out.reshape(-1, *shape))
