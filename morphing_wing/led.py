r"""A load that is an unknown: the displacement on which it works is given instead.

Past a limit point the load falls while its displacement grows; to give the displacement (a
chamber's volume, say) leads through it. The load is then the multiplier of

.. math:: \Pi = E(u) - \lambda \, (q(u) - q^*) ,

one more unknown of the same matrix, whose one more negative pivot is no loss of stability.
"""

from __future__ import annotations

from typing import Any

import numpy as np
import ufl
from dolfinx import fem
from mpi4py import MPI

from . import compat
from .blocks import Block
from .system import EquilibriumSystem


class LedLoad:
    """A load as an unknown, seen by cells of a body.

    Parameters
    ----------
    mesh
        The body's mesh.
    cells
        Local cells at which the load acts.
    name
        Of the unknown's function.
    unit
        What the load is one of if the unknown is one: brings its equation to the size of others.

    Attributes
    ----------
    blocks
        The unknown, and what stands for it on the body's cells: the first to come before the local
        blocks of a system, the second among them.
    seen
        The load in UFL, on the body's mesh.
    given
        Constant: the displacement on which the load works, beyond ``at_rest``.
    """

    def __init__(
        self, mesh: Any, cells: np.ndarray, name: str = "load", unit: float = 1.0
    ) -> None:
        self._comm, self._unit = mesh.comm, unit
        ends = np.array([[0.0, 0.0, 0.0], [1.0, 0.0, 0.0]])
        self._mesh = compat.create_mesh(mesh.comm, "interval", np.array([[0, 1]]), ends)
        self._value = fem.Function(compat.discontinuous_space(self._mesh, 0), name=name)
        self._seen = fem.Function(compat.discontinuous_space(mesh, 0), name=f"{name}_seen")
        self.given = compat.constant(self._mesh, 0.0)
        self._cells = cells
        self.seen = unit * self._seen
        self.blocks = (Block(self._value), Block(self._seen, local=True))

    def number(self, system: EquilibriumSystem) -> None:
        """Let the body's cells see the unknown, once a system has given it its number."""
        own, seen = self.blocks
        mine = own.numbers[own.owned]
        number = self._comm.allreduce(int(mine[0]) if len(mine) else -1, op=MPI.MAX)
        numbers = np.full(len(self._seen.x.array), -1, dtype=np.int64)
        for cell in self._cells:
            numbers[self._seen.function_space.dofmap.cell_dofs(cell)] = number
        system.renumber(seen, numbers)

    def potential(self, at_rest: float = 0.0, part: float = 1.0) -> Any:
        """Return the load times ``part`` of the given displacement and what is there at rest."""
        load = self._unit * self._value
        return load * (part * self.given + compat.constant(self._mesh, at_rest)) * self._measure

    def none(self) -> Any:
        """Return the potential of a load that is zero; its pivot is negative as well."""
        return -0.5 * self._value**2 * self._measure

    @property
    def value(self) -> float:
        """The load."""
        own = self.blocks[0]
        mine = self._value.x.array[own.owned]
        return self._unit * self._comm.allreduce(float(mine.sum()) if len(mine) else 0.0)

    @property
    def _measure(self) -> Any:
        return ufl.dx(domain=self._mesh, metadata={"quadrature_degree": 0})
