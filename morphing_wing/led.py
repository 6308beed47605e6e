r"""A load that is an unknown: the displacement on which it works is given instead.

Past a limit point the load falls while its displacement grows; to give the displacement (a
chamber's volume, say) leads through it. The load is then the multiplier of

.. math:: \Pi = E(u) - \lambda \, (q(u) - q^*) ,

one more unknown of the same matrix, whose one more negative pivot is no loss of stability.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from .shared_numbers import SharedNumbers
from .system import EquilibriumSystem


class LedLoad:
    """A load as an unknown, seen by cells of a body.

    Parameters
    ----------
    mesh, cells, name
        See `SharedNumbers`: the local cells are those at which the load acts.
    unit
        What the load is one of if the unknown is one: brings its equation to the size of others.

    Attributes
    ----------
    blocks
        Of the unknown, see `SharedNumbers`.
    seen
        The load in UFL, on the body's mesh.
    given
        Constant: the displacement on which the load works, beyond ``at_rest``.
    """

    def __init__(
        self, mesh: Any, cells: np.ndarray, name: str = "load", unit: float = 1.0
    ) -> None:
        self._number, self._unit = SharedNumbers(mesh, [cells], name), unit
        self.blocks = self._number.blocks
        self.given = self._number.constant(0.0)
        self.seen = unit * self._number.seen

    def number(self, system: EquilibriumSystem) -> None:
        """Let the body's cells see the unknown, once a system has given it its number."""
        self._number.number(system)

    def potential(self, at_rest: float = 0.0, part: float = 1.0) -> Any:
        """Return the load times ``part`` of the given displacement and what is there at rest."""
        displacement = part * self.given + self._number.constant(at_rest)
        return self._unit * self._number.own * displacement * self._number.measure

    def none(self) -> Any:
        """Return the potential of a load that is zero; its pivot is negative as well."""
        return -0.5 * self._number.own**2 * self._number.measure

    @property
    def value(self) -> float:
        """The load. Collective."""
        return self._unit * float(self._number.values[0, 0])
