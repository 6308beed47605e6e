"""Which unknowns a function's dofs stand for: its own, or ones that it shares with others."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np


@dataclass
class Block:
    """A function and the global numbers of its rank-local dofs.

    Attributes
    ----------
    function
        The finite-element function (displacement, mixed, beam, ...).
    constrained
        Local dofs (flattened) that keep the value that the function holds.
    numbers
        Global number of each local dof, set by `EquilibriumSystem`; -1 for a dof of a shared block
        that stands for nothing.
    """

    function: Any
    constrained: np.ndarray = field(default_factory=lambda: np.empty(0, dtype=np.int32))
    numbers: np.ndarray = field(default_factory=lambda: np.empty(0, dtype=np.int64), init=False)

    @property
    def block_size(self) -> int:
        """Number of components at a dof point."""
        return self.function.function_space.dofmap.index_map_bs

    @property
    def n_owned(self) -> int:
        """Number of dofs owned by this rank."""
        return self.function.function_space.dofmap.index_map.size_local * self.block_size


@dataclass(frozen=True)
class SharedUnknowns:
    """How the cells of a shared block stand for dofs of an independent block.

    Attributes
    ----------
    of
        Index of the independent block.
    masters
        For each group, the local dofs of that block on the rank that owns them, else empty;
        list of (k,) arrays.
    cells
        For each group the local cells whose k dofs stand for the group's masters.
    """

    of: int
    masters: Sequence[np.ndarray]
    cells: Sequence[np.ndarray]
