"""Displacement fields as VTK grids on rank 0, higher order kept, and their files for ParaView.

The grid of a function is the same whatever the number of ranks: cells in the order in which the
mesh was given, points in the order in which the cells meet them, none of them twice.
"""

from __future__ import annotations

import os
import pathlib
import re
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from dataclasses import replace
from typing import TYPE_CHECKING, Any
from xml.sax.saxutils import quoteattr

import numpy as np

from morphing_wing import compat
from morphing_wing.root import on_root, write_whole
from morphing_wing.stretch import nodal_stretches

if TYPE_CHECKING:
    import pyvista

    from morphing_wing.modes import Modes
    from morphing_wing.path import Path, State

__all__ = ["FieldGrid", "mode_grids", "save_modes", "save_path", "scene_grids", "shown"]


class FieldGrid:
    """The VTK grid of a displacement function, gathered from all ranks. Collective.

    Parameters
    ----------
    function
        DOLFINx function: a vector (its first three components are the displacement, mm) or of a
        mixed space whose first part is the displacement, on hexahedra, tetrahedra or intervals.

    Attributes
    ----------
    function
        As given.
    cell_name
        ``"hexahedron"``, ``"tetrahedron"`` or ``"interval"``.
    cells
        On rank 0: original numbers of the cells in the order of the grid, shape (n_cells,).
    """

    def __init__(self, function: Any) -> None:
        self.function = function
        self._space, self._entries = _displacement_space(function)
        mesh = self._space.mesh
        self._comm = mesh.comm
        self.cell_name = mesh.topology.cell_type.name
        owned = mesh.topology.index_map(mesh.topology.dim).size_local
        topology, types, points = compat.vtk_mesh(self._space)
        per_cell = self._space.dofmap.dof_layout.num_dofs  # also where a rank has no cell
        vtk = topology.reshape(len(types), 1 + per_cell)[:owned, 1:]
        nodes = np.array([self._space.dofmap.cell_dofs(cell) for cell in range(owned)])
        nodes = nodes.reshape(vtk.shape).astype(np.int64)
        index_map = self._space.dofmap.index_map
        self._n_owned = index_map.size_local
        numbers = index_map.local_to_global(np.arange(len(points), dtype=np.int32))
        self._global = numbers[: self._n_owned]
        parts = self._comm.gather({
            "original": compat.original_cells(mesh)[:owned], "types": types[:owned],
            "vtk": numbers[vtk], "nodes": numbers[nodes],
            "global": self._global, "points": points[: self._n_owned],
        })
        if self._comm.rank == 0:
            self._join([part for part in parts if len(part["original"])])

    def _join(self, parts: list[dict[str, np.ndarray]]) -> None:
        joined = {name: np.concatenate([part[name] for part in parts]) for name in parts[0]}
        order = np.argsort(joined["original"])
        self.cells, self._types = joined["original"][order], joined["types"][order]
        vtk, nodes = joined["vtk"][order], joined["nodes"][order]
        ids, first = np.unique(vtk, return_index=True)
        number = np.empty(len(ids), dtype=np.int64)  # position in ids -> point of the grid
        number[np.argsort(first)] = np.arange(len(ids))
        self._number = dict(ids=ids, number=number)
        self._vtk, self._nodes = self._point_of(vtk), self._point_of(nodes)
        self._points = np.empty((len(ids), 3))
        self._points[self._point_of(joined["global"])] = joined["points"]

    def _point_of(self, global_nodes: np.ndarray) -> np.ndarray:
        return self._number["number"][np.searchsorted(self._number["ids"], global_nodes)]

    def grid(self) -> pyvista.UnstructuredGrid | None:
        """Return the reference grid with what the function holds now; rank 0 only. Collective.

        Returns
        -------
        pyvista.UnstructuredGrid on rank 0, None elsewhere, with point arrays ``displacement``
        (mm, shape (n_points, 3)), of functions with six components ``rotation`` (vector, radians),
        and ``stretch`` (largest principal stretch, mean over the cells that meet in the point), and
        cell array ``cell`` (its original number).
        """
        values = np.asarray(self.function.x.array)[self._entries[: self._n_owned]]
        parts = self._comm.gather((self._global, values))  # owned values: ghosts may be stale
        if self._comm.rank != 0:
            return None
        import pyvista

        motion = np.zeros((len(self._points), self._entries.shape[1]))
        for nodes, local in parts:
            if len(nodes):
                motion[self._point_of(nodes)] = local
        displacement = motion[:, :3]
        stretches = nodal_stretches(self.cell_name, self._nodes, self._points, displacement)
        topology = np.insert(self._vtk, 0, self._vtk.shape[1], axis=1)
        grid = pyvista.UnstructuredGrid(topology.ravel(), self._types, self._points)
        grid.point_data["displacement"] = displacement
        if motion.shape[1] == 6:
            grid.point_data["rotation"] = motion[:, 3:]
        grid.point_data["stretch"], grid.point_data["second_stretch"] = stretches.T
        grid.cell_data["cell"] = self.cells
        return grid


def _displacement_space(function: Any) -> tuple[Any, np.ndarray]:
    """Return the displacement's own space and, node by node, its entries in the function's array.

    The second has shape (n_local_nodes, 3), with rotations (n_local_nodes, 6).
    """
    space = function.function_space
    parts = space.num_sub_spaces
    if parts and space.dofmap.bs == 1:
        space, entries = space.sub(0).collapse()
        entries = np.asarray(entries)
    else:
        entries = None
    index_map = space.dofmap.index_map
    n_nodes, size = index_map.size_local + index_map.num_ghosts, space.dofmap.bs
    if entries is None:
        entries = np.arange(n_nodes * size)
    return space, entries.reshape(n_nodes, size)[:, : 6 if size == 6 else 3]


@contextmanager
def shown(scene: Any, state: State) -> Iterator[None]:
    """Put a scene into one of its states, and afterwards back to where it was. Collective.

    So a scene may be led on from its last state after any other was drawn.
    """
    present = scene.unknowns()
    scene.show(state)
    try:
        yield
    finally:
        scene.set_unknowns(present)


def scene_grids(scene: Any, state: State) -> dict[str, pyvista.UnstructuredGrid | None]:
    """Return the grid of each of a scene's functions in a state (None off rank 0). Collective.

    The gathering is prepared once for each function and kept with the scene.
    """
    kept = scene.__dict__.setdefault("_field_grids", {})
    with shown(scene, state):
        for name, function in scene.functions.items():
            if name not in kept or kept[name].function is not function:
                kept[name] = FieldGrid(function)
        return {name: kept[name].grid() for name in scene.functions}


def mode_grids(modes: Modes, i: int) -> dict[str, pyvista.UnstructuredGrid | None]:
    """Return the grids of the state of some modes, with mode ``i`` as point array. Collective."""
    mode = replace(modes.state, fields=modes[i].fields)
    grids, moved = (scene_grids(modes.scene, state) for state in (modes.state, mode))
    for name, grid in grids.items():
        if grid is not None:
            grid.point_data["mode"] = moved[name].point_data["displacement"]
            if "rotation" in grid.point_data:
                grid.point_data["mode_rotation"] = moved[name].point_data["rotation"]
    return grids


def save_modes(modes: Modes, directory: str | os.PathLike) -> pathlib.Path:
    """Write modes for ParaView: ``modes.pvd``, a time step a mode. Collective; rank 0 writes."""
    directory, entries = pathlib.Path(directory), []
    for i, mode in enumerate(modes):
        figures = modes.state.load | {"frequency_Hz": mode.frequency_Hz}
        for part, (name, grid) in enumerate(mode_grids(modes, i).items()):
            file = directory / f"{name}_{i + 1:04d}.vtu"
            on_root(modes.scene.comm, lambda g=grid, n=figures, f=file: _write_grid(g, n, f))
            entries.append((i + 1, part, name, file.name))
    on_root(modes.scene.comm, lambda: _write_series(entries, directory / "modes.pvd"))
    return directory / "modes.pvd"


def save_path(path: Path, directory: str | os.PathLike) -> pathlib.Path:
    """Write a path's fields for ParaView: ``path.pvd`` and one ``.vtu`` a state and function.

    Time in ParaView is the number of the step; loads and measures stand in each file as field
    data. Of states without fields an earlier run's files stay, where they are of the same state.
    Collective; rank 0 writes. Files of an earlier, longer path are removed.
    """
    directory = pathlib.Path(directory)
    entries = []
    for step, state in enumerate(path):
        if not state.fields:  # from before a restart
            entries += on_root(path.scene.comm, lambda i=step, s=state: _written_before(
                list(path.scene.functions), i, s, directory)) or []
            continue
        grids = scene_grids(path.scene, state)
        for part, (name, grid) in enumerate(grids.items()):
            file = directory / f"{name}_{step:04d}.vtu"
            figures = state.load | state.measures
            on_root(path.scene.comm, lambda g=grid, n=figures, f=file: _write_grid(g, n, f))
            entries.append((step, part, name, file.name))
    on_root(path.scene.comm, lambda: _write_series(entries, directory / "path.pvd"))
    return directory / "path.pvd"


def _written_before(
    names: list[str], step: int, state: State, directory: pathlib.Path
) -> list[tuple[int, int, str, str]]:
    """Return the entries of a state that an earlier run wrote, none if its figures differ."""
    import pyvista

    entries = []
    for part, name in enumerate(names):
        file = directory / f"{name}_{step:04d}.vtu"
        if not file.is_file():
            return []
        there = pyvista.read(file).field_data
        for figure, value in (state.load | state.measures).items():
            if figure not in there or not np.array_equal(there[figure], [value], equal_nan=True):
                return []
        entries.append((step, part, name, file.name))
    return entries


def _write_grid(
    grid: pyvista.UnstructuredGrid, figures: Mapping[str, float], file: pathlib.Path
) -> None:
    for name, value in figures.items():
        grid.field_data[name] = np.array([float(value)])
    write_whole(file, lambda name: grid.save(name, binary=True))


def _write_series(entries: list[tuple[int, int, str, str]], file: pathlib.Path) -> None:
    lines = [
        f'    <DataSet timestep="{step}" part="{part}" '
        f"name={quoteattr(name)} file={quoteattr(file)}/>"
        for step, part, name, file in entries
    ]
    text = "\n".join([
        '<?xml version="1.0"?>',
        '<VTKFile type="Collection" version="0.1" byte_order="LittleEndian">',
        "  <Collection>", *lines, "  </Collection>", "</VTKFile>", ""])
    write_whole(file, lambda name: name.write_text(text))
    written = {name for *_, name in entries}
    for old in file.parent.glob("*.vtu"):
        if old.name not in written and re.fullmatch(r".+_\d{4,}\.vtu", old.name):
            old.unlink()
