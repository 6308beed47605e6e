"""Restart files: what a path needs to go on from its last converged step, on any number of ranks.

A function is stored cell by cell in the order in which the mesh was given, each cell with its
unknowns in its own order: that is the same however the mesh is distributed.
"""

from __future__ import annotations

import dataclasses
import json
import os
import pathlib
import zipfile
from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from . import compat
from .errors import InputError
from .path import State
from .root import on_root, write_whole
from .stepping import Load, Standing
from .summary import plain

if TYPE_CHECKING:
    from .scene import Scene

__all__ = ["Restart", "read", "restart_file", "write"]

_FORMAT = 4
_ROW = [f.name for f in dataclasses.fields(State) if f.name not in ("fields", "scene")]


@dataclasses.dataclass(frozen=True)
class Restart:
    """What a restart file holds.

    Attributes
    ----------
    states
        All states so far; the last one alone has fields.
    standing
        Where the stepping stood after the last of them.
    memory
        What the scene remembered, see `Scene.memory`.
    seconds
        Wall time of the path so far, s.
    """

    states: list[State]
    standing: Standing
    memory: dict[str, Any]
    seconds: float

    def check(self, targets: Sequence[Load]) -> None:
        """Refuse wanted loads that do not begin with those already reached."""
        done = [state.load for state in self.states if state.requested]
        if len(targets) < len(done):
            raise InputError(
                f"number of loads = {len(targets)}: must be {len(done)} or more, "
                "as many as the run to resume has reached")
        for i, (old, new) in enumerate(zip(done, targets, strict=False)):
            for name in old:
                if not np.isclose(old[name], new[name], rtol=1e-12, atol=0.0):
                    raise InputError(f"{name} = {new[name]:.6g} in load {i + 1}: must be "
                                     f"{old[name]:.6g} as in the run to resume")


def restart_file(place: str | os.PathLike) -> pathlib.Path:
    """Return the file meant: ``place`` itself if it ends in .npz, else restart.npz in it."""
    place = pathlib.Path(place)
    return place if place.suffix == ".npz" else place / "restart.npz"


def write(
    place: str | os.PathLike,
    scene: Scene,
    states: Sequence[State],
    standing: Standing,
    seconds: float,
) -> None:
    """Write a scene's present converged state; the file is there whole or not at all. Collective.

    Parameters
    ----------
    place
        File or folder, see `restart_file`.
    scene
        Its functions hold the last of ``states``.
    states, standing, seconds
        See `Restart`.
    """
    head = {
        "format": _FORMAT,
        "fingerprint": _fingerprint(scene),
        "states": [{name: getattr(state, name) for name in _ROW} for state in states],
        "memory": scene.memory(),
        "standing": dataclasses.asdict(standing),
        "seconds": seconds,
    }
    functions = [block.function for block in scene.kept_blocks]
    arrays = {f.name: _gathered(f, f.x.array) for f in functions}

    def save(file: pathlib.Path) -> None:
        np.savez(file, head=np.array(json.dumps(head, default=plain)), **arrays)

    on_root(scene.comm, lambda: write_whole(restart_file(place), save))


def read(place: str | os.PathLike, scene: Scene) -> Restart:
    """Read what `write` wrote, as this rank's part of ``scene``; sets nothing in it. Collective.

    Raises
    ------
    InputError
        If there is no such file, or it is of another scene.
    """
    file = restart_file(place)
    head, arrays = scene.comm.bcast(on_root(scene.comm, lambda: _content(file)), root=0)
    differs = _first_difference(head["fingerprint"], _fingerprint(scene))
    if differs:
        raise InputError(f"{file}: must be of the scene to resume, but {differs}")
    functions = [block.function for block in scene.kept_blocks]
    standing = Standing(**head["standing"])
    states = [State(**row) for row in head["states"]]
    states[-1].fields = {f.name: _scattered(f, arrays[f.name]) for f in functions}
    return Restart(states, standing, head["memory"], head["seconds"])


def _content(file: pathlib.Path) -> tuple[dict[str, Any], dict[str, np.ndarray]]:
    """Return the head and the functions' values."""
    if not file.is_file():
        raise InputError(f"{file}: no such file, there is nothing to resume")
    try:
        with np.load(file, allow_pickle=False) as stored:
            arrays = dict(stored)
        head = json.loads(str(arrays.pop("head")))
        readable = head["format"] == _FORMAT
    except (OSError, ValueError, KeyError, TypeError, EOFError, zipfile.BadZipFile):
        readable = False
    if not readable:
        raise InputError(f"{file}: must be a restart file of this version")
    return head, arrays


# -- whose file it is -------------------------------------------------------------------------


def _fingerprint(scene: Scene) -> dict[str, Any]:
    """Return what must agree, as it reads after a way through JSON."""
    found = {"scene": scene.name, "fidelity": scene.fidelity, **scene.description()}
    for block in scene.kept_blocks:
        mesh = block.function.function_space.mesh
        n_cells = mesh.topology.index_map(mesh.topology.dim).size_global
        found[f"cells of {block.function.name}"] = n_cells
    return json.loads(json.dumps(plain(found | {"unknowns": scene.dofs})))


def _first_difference(there: Any, here: Any, where: str = "") -> str:
    """Return in words the first entry in which two fingerprints differ, empty if in none."""
    if isinstance(there, Mapping) and isinstance(here, Mapping):
        for name in [*there, *(name for name in here if name not in there)]:
            found = _first_difference(
                there.get(name), here.get(name), f"{where}.{name}" if where else name)
            if found:
                return found
        return ""
    return "" if there == here else f"{where} is {there} in it and {here} here"


# -- functions, cell by cell ------------------------------------------------------------------


def _cell_unknowns(function: Any) -> np.ndarray:
    """Return the local entries of each local cell's unknowns, shape (n_local_cells, n)."""
    space = function.function_space
    size, n_nodes = space.dofmap.index_map_bs, space.dofmap.dof_layout.num_dofs
    n_cells = len(compat.original_cells(space.mesh))
    nodes = np.array([space.dofmap.cell_dofs(cell) for cell in range(n_cells)], dtype=np.int64)
    entries = nodes.reshape(n_cells, -1, 1) * size + np.arange(size) if n_cells else (
        np.empty((0, n_nodes, size), dtype=np.int64))
    return entries.reshape(n_cells, entries.shape[1] * size)


def _gathered(function: Any, values: np.ndarray) -> np.ndarray | None:
    """Return values cell by cell in the order of the input on rank 0, None elsewhere."""
    mesh = function.function_space.mesh
    owned = mesh.topology.index_map(mesh.topology.dim).size_local
    cells = compat.original_cells(mesh)[:owned]
    parts = mesh.comm.gather((cells, values[_cell_unknowns(function)[:owned]]))
    if parts is None:
        return None
    cells, rows = (np.concatenate(part) for part in zip(*parts, strict=True))
    table = np.empty_like(rows)
    table[cells] = rows
    return table


def _scattered(function: Any, table: np.ndarray) -> np.ndarray:
    """Return this rank's values from those of all cells; every local unknown is of some cell."""
    values = np.zeros_like(function.x.array)
    values[_cell_unknowns(function)] = table[compat.original_cells(function.function_space.mesh)]
    return values
