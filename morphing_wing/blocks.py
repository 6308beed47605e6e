"""Which unknowns a function's dofs stand for: its own, or ones that it shares with others."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from functools import cached_property
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
    absent
        Local dofs (flattened, ghosts too) that are no unknowns: nothing depends on them.
    local
        Whether its dofs stand for others' unknowns, by numbers that may change.
    refresh
        Called after new values came into the function.
    numbers
        Global number of each local dof, set by `EquilibriumSystem`; -1 for one that stands for
        nothing.
    """

    function: Any
    constrained: np.ndarray = field(default_factory=lambda: np.empty(0, dtype=np.int32))
    absent: np.ndarray = field(default_factory=lambda: np.empty(0, dtype=np.int32))
    local: bool = False
    refresh: Callable[[], None] | None = None
    numbers: np.ndarray = field(default_factory=lambda: np.empty(0, dtype=np.int64), init=False)

    @property
    def block_size(self) -> int:
        """Number of components at a dof point."""
        return self.function.function_space.dofmap.index_map_bs

    @cached_property
    def owned(self) -> np.ndarray:
        """Local dofs owned by this rank that are unknowns, in the order of their numbers."""
        n = self.function.function_space.dofmap.index_map.size_local * self.block_size
        return np.setdiff1d(np.arange(n), self.absent)

    @property
    def n_owned(self) -> int:
        """Number of unknowns owned by this rank."""
        return len(self.owned)

