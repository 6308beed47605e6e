"""Glue between ribs and elastomer: each rib end is a rigid foot on a patch of the elastomer."""

from __future__ import annotations

import numpy as np

from .adhesive import GluedPatches
from .bar_mesh import BarMesh
from .elastomer import Elastomer
from .geometry.patches import joined, patch_points
from .geometry.wing import WingGeometry
from .materials import Adhesive
from .solid_ribs import SolidRibs
from .surface import Surface
from .system import EquilibriumSystem


class Glue(GluedPatches):
    """The feet on the rear wall and the tails between the pocket's sides.

    Attributes
    ----------
    patches
        Name of each patch and the mask of its points: ``rib_1_foot``, ``rib_1_bond``, ...
    """

    def __init__(
        self, body: Elastomer, ribs: BarMesh | SolidRibs, wing: WingGeometry, law: Adhesive
    ) -> None:
        roots = wing.rib_roots()
        ends = {"foot": ("root", ["rear_wall"], roots)}
        if wing.skin_thickness is not None:
            tails = roots + np.array([wing.rib.length, 0.0, 0.0])
            ends["bond"] = ("tail", ["pocket_upper", "pocket_lower"], tails)
        parts, firsts, origins, names, self._feet = [], [], [], [], []
        facets = {face: body.grid.facets[face] for _, faces, _ in ends.values() for face in faces}
        starts = dict(zip(facets, np.cumsum([0, *map(len, facets.values())]), strict=False))
        self._surface = surface = Surface(body, np.concatenate(list(facets.values())))
        for name, (kind, faces, points) in ends.items():
            for rib, box in enumerate(boxes(wing, name)):
                for face in faces:
                    rows = surface.facets[starts[face] : starts[face] + len(facets[face])]
                    found = patch_points(surface.nodes.reference, rows, box)
                    parts.append(found)
                    firsts.append(starts[face])
                    n = len(found.area)
                    origins.append(np.broadcast_to(points[rib], (n, 3)))
                    names += [f"rib_{rib + 1}_{name}"] * n
                    self._feet += [(kind, rib)] * n
        names = np.array(names)
        self.patches = {name: names == name for name in dict.fromkeys(names)}
        self._ribs = ribs
        super().__init__(body.comm, joined(parts, firsts), np.concatenate(origins), law)

    def join(self, system: EquilibriumSystem) -> None:
        """Tell the system whose unknowns the points share."""
        surface = self._surface
        faces = surface.nodes.numbers[surface.facets[self._all.facet]]
        feet = {end: self._ribs.end_numbers(*end) for end in dict.fromkeys(self._feet)}
        self.number(system, faces, np.array([feet[end] for end in self._feet]))

    def measures(self) -> dict[str, float]:
        """Return of each patch how far it is used, 1 where damage begins; and what it took."""
        if not self.law.fails:
            return {}
        used = {f"{name}_use": float(self.utilisation[mask].max())
                for name, mask in self.patches.items()}
        return used | {"glue_damage": float(self.damage().max()),
                       "glue_dissipated_Nmm": self.dissipated()}


def boxes(wing: WingGeometry, face: str) -> np.ndarray:
    """Return lower and upper corner in mm of each rib's patch, shape (n_ribs, 2, 3)."""
    height, width = wing.foot()
    roots = wing.rib_roots()
    if face == "foot":
        half = np.array([1.0, height / 2.0, width / 2.0])
        return np.stack([roots - half, roots + half], axis=1)
    end = roots + np.array([wing.rib.length, 0.0, 0.0])
    low = np.array([0.0, -wing.chord, -width / 2.0])
    high = np.array([wing.tail_bond_length, wing.chord, width / 2.0])
    return np.stack([end + low, end + high], axis=1)
