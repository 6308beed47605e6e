"""The pantographic rib as a solid."""

from __future__ import annotations

from dataclasses import asdict
from typing import Any

import numpy as np
from dolfinx import fem

from .drawing import Drawing, default_drawing
from .forms.gravity import mass_density
from .geometry.rib_solid import rib_solid
from .iterate import Iterate
from .path import State
from .resin_body import ResinBody
from .rib import Rib
from .rigid_end import RigidEnd
from .root import on_root
from .system import EquilibriumSystem

AROUND = {"standard": 12, "reference": 18}
"""Elements around a cylinder of each rung's mesh."""

_OUT_OF_PLANE = (2, 3, 4)  # of the tail's six motions, those that a half rib does not have


class SolidRib(Rib):
    """One half of the rib, by symmetry at its middle layer, in second-order tetrahedra.

    ``Rib(..., fidelity="standard")`` and "reference" make one. Its root section is clamped, its
    tail section moves as a rigid plate.
    """

    multiplicity = 2

    def _build(self) -> None:
        rib = self.geometry
        grid = self.comm.bcast(on_root(self.comm, lambda: rib_solid(rib, AROUND[self.fidelity])))
        self.body = ResinBody(self.comm, grid, self.material, clamped=("root",),
                              symmetry={"symmetry": 2})
        self.tail = RigidEnd(self.body, "tail", self._tail_place, held=_OUT_OF_PLANE)
        own, seen = self.tail.blocks
        self.system = EquilibriumSystem(self.comm, [self.body.block, own, seen])
        self.tail.join(self.system)

    @property
    def functions(self) -> dict[str, fem.Function]:
        """Displacement in mm by name."""
        return {"ribs": self.body.function}

    def drawing(self, state: State) -> Drawing:
        """Return how to draw the present state."""
        return default_drawing(self)

    def description(self) -> dict[str, Any]:
        """Return all parameters, for `summary.json`."""
        return {
            "geometry": asdict(self.geometry),
            "material": asdict(self.material),
            "element": "P2, curved tetrahedra",
            "guide_mm": [float(x) for x in self._guide.value - self._tail_place],
        }

    def _iterates(self) -> list[Iterate]:
        return [self.body.iterate, self.tail.iterate]

    def _corrections(self) -> dict[int, Any]:
        return {0: self.body.tangent_correction, 2: self.tail.tangent_correction}

    def _stored(self) -> list[Any]:
        return [self.body.energy, self.tail.energy]

    def masses(self) -> list[np.ndarray]:
        """Return the lumped mass in kg on each owned unknown."""
        body = mass_density(self.material.density) * self.body.lumped_volume()
        return [body, np.zeros(self.tail.blocks[0].n_owned)]
