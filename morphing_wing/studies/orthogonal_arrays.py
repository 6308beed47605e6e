"""Orthogonal arrays by name, and which of their columns take which factors.

The arrays are pyDOE3's, from the tables of the University of York and of N. J. A. Sloane. A column
of six levels is also one of two and one of three (L18).
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from morphing_wing.errors import InputError

__all__ = ["array_names", "orthogonal_array"]

_NOT_ORTHOGONAL = ("L64(2^31)",)
"""Arrays of pyDOE3 1.6 with wrong entries: two of its columns have 31 ones in 64 rows."""


def array_names() -> list[str]:
    """Return the arrays' names, shortest array first: L4, L8, L9, ..., L16(2^15), L16(4^5), ...

    Where a length has one array only, its length alone is the name.
    """
    from pyDOE3 import list_orthogonal_arrays

    full = [_unabridged(name) for name in list_orthogonal_arrays() if name not in _NOT_ORTHOGONAL]
    short = [name.split("(")[0] for name in full]
    return [s if short.count(s) == 1 else f for s, f in zip(short, full, strict=True)]


def orthogonal_array(levels: Sequence[int], name: str | None = None) -> np.ndarray:
    """Return an orthogonal array for factors of so many levels each.

    Parameters
    ----------
    levels
        Number of levels of each factor.
    name
        One of `array_names`, or a length that several arrays share, ``"L16"``; None: the shortest
        that has the columns.

    Returns
    -------
    (tests, factors) array of int
        Level of each factor in each test, from 0.

    Raises
    ------
    InputError
        If there is no such array, or none has a column for each factor.

    Examples
    --------
    >>> orthogonal_array([3, 3, 3], "L9").shape
    (9, 3)
    """
    from pyDOE3 import get_orthogonal_array, list_orthogonal_arrays

    known = {_unabridged(full): full for full in list_orthogonal_arrays()
             if full not in _NOT_ORTHOGONAL}
    asked = [n for n in known if name in (None, n, n.split("(")[0])]
    if not asked:
        raise InputError(f"array = {name!r}: must be one of {', '.join(array_names())}")
    for each in asked:
        columns = _columns(np.asarray(get_orthogonal_array(known[each])), levels)
        if columns is not None:
            return columns
    wanted = ", ".join(f"{levels.count(n)} of {n} levels" for n in sorted(set(levels)))
    where = "no array has" if name is None else f"array = {name!r} has not"
    raise InputError(f"{where} a column for each factor ({wanted}): must be other numbers of "
                     f"levels, fewer factors, or one of {', '.join(array_names())}")


def _unabridged(name: str) -> str:
    """Return the name with all that the array has: pyDOE3's leaves out some columns."""
    return {"L18(6^1 3^6)": "L18(2^1 3^7)", "L27(2^1 3^12)": "L27(3^13)",
            "L36(3^23)": "L36(2^11 3^12)"}.get(name, name)


def _columns(array: np.ndarray, levels: Sequence[int]) -> np.ndarray | None:
    free = [array[:, j] - array[:, j].min() for j in range(array.shape[1])]
    if max(levels) < 6:
        sixes = [column for column in free if column.max() == 5]
        free = [part for six in sixes for part in (six % 2, six // 2)] + [
            column for column in free if column.max() != 5]
    taken = []
    for count in levels:
        place = next((i for i, column in enumerate(free) if column.max() + 1 == count), None)
        if place is None:
            return None
        taken.append(free.pop(place))
    return np.stack(taken, axis=1).astype(int)
