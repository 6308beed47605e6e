"""Named faces of a distributed mesh: where its facets are on this rank, and integrals over them."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
import ufl
from dolfinx import fem

from . import compat


class Faces:
    """Faces given as pairs (cell of the input mesh, facet of the cell); they may overlap.

    Parameters
    ----------
    mesh
        The distributed mesh.
    pairs
        Of each face by name, (k, 2); the same on every rank.
    """

    def __init__(self, mesh: Any, pairs: Mapping[str, np.ndarray]) -> None:
        self._mesh, self._pairs = mesh, pairs
        names: dict[tuple[int, int], list[str]] = {}
        for name, found in pairs.items():
            for cell, facet in found:
                names.setdefault((int(cell), int(facet)), []).append(name)
        sets = sorted({tuple(found) for found in names.values()})
        number = {found: i + 1 for i, found in enumerate(sets)}
        self._numbers = {name: [number[found] for found in sets if name in found] for name in pairs}
        every = np.array(list(names), dtype=np.int64).reshape(-1, 2)
        values = np.array([number[tuple(found)] for found in names.values()], dtype=np.int32)
        here, _ = self.local(every)
        self._tags = compat.facet_tags(mesh, self._local_facets(every), values[here])

    def on(self, face: str, integrand: Any, degree: int) -> Any:
        """Return the integral of an integrand over a face by a quadrature, a UFL functional."""
        ds = ufl.Measure("ds", self._mesh, subdomain_data=self._tags,
                         metadata={"quadrature_degree": degree})
        return sum(integrand * ds(number) for number in self._numbers[face])

    def measure_on(self, pairs: np.ndarray, degree: int) -> Any:
        """Return the measure over facets (k, 2); whichever they are, forms are compiled once."""
        facets = self._local_facets(pairs)
        tags = compat.facet_tags(self._mesh, facets, np.ones(len(facets), dtype=np.int32))
        ds = ufl.Measure("ds", self._mesh, subdomain_data=tags,
                         metadata={"quadrature_degree": degree})
        return ds(1)

    def facets(self, face: str) -> np.ndarray:
        """Return the local facets of a face."""
        return self._tags.indices[np.isin(self._tags.values, self._numbers[face])]

    def cells(self, face: str) -> np.ndarray:
        """Return the local cells at a face."""
        return self.cells_at(self._pairs[face])

    def cells_at(self, pairs: np.ndarray) -> np.ndarray:
        """Return the local cells of pairs (cell of the input mesh, facet of the cell)."""
        return np.flatnonzero(np.isin(compat.original_cells(self._mesh), pairs[:, 0]))

    def held(self, space: Any, held: Sequence[tuple[str, int]]) -> np.ndarray:
        """Return the dofs of some components of a space of vectors on some faces.

        Parameters
        ----------
        space
            Of a function, or the part of a mixed one's that is a vector.
        held
            Pairs of a face and an axis.
        """
        found = [np.empty(0, dtype=np.int32)]
        for face, axis in held:
            part = space.sub(axis)
            dofs = fem.locate_dofs_topological(
                (part, part.collapse()[0]), self._mesh.topology.dim - 1, self.facets(face))
            found.append(dofs[0])
        return np.unique(np.concatenate(found))

    def local(self, pairs: np.ndarray, owned: bool = False) -> tuple[np.ndarray, np.ndarray]:
        """Return which pairs this rank has, as indices, and the local cell of each of them.

        ``owned`` leaves out those of ghost cells: every pair is then one rank's alone.
        """
        original = compat.original_cells(self._mesh)
        if owned:
            original = original[: self._mesh.topology.index_map(self._mesh.topology.dim).size_local]
        order = np.argsort(original)
        here = np.flatnonzero(np.isin(pairs[:, 0], original))
        return here, order[np.searchsorted(original, pairs[here, 0], sorter=order)]

    def _local_facets(self, pairs: np.ndarray) -> np.ndarray:
        """Return this rank's number of each pair's facet that it has."""
        here, cells = self.local(pairs)
        return compat.cell_facets(self._mesh)[cells, pairs[here, 1]].astype(np.int32)
