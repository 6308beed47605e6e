"""A path without its fields and its scene: what a study of many wings can keep of each."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Any

from .path import Path

__all__ = ["SceneRecord", "without_fields"]


@dataclass(frozen=True)
class SceneRecord:
    """What a path's tables and curves ask of its scene: no mesh, no matrix, no factor.

    Attributes
    ----------
    name, fidelity, dofs, primary_load, comm, parameters
        As the scene had them; ``parameters`` is what its ``description()`` returned.
    """

    name: str
    fidelity: str
    dofs: int
    primary_load: str
    comm: Any
    parameters: dict[str, Any]

    def description(self) -> dict[str, Any]:
        """Return the scene's parameters."""
        return self.parameters


def without_fields(path: Path) -> Path:
    """Return the path with its figures alone; tables and curves are the same."""
    scene = path.scene
    record = SceneRecord(scene.name, scene.fidelity, scene.dofs, scene.primary_load, scene.comm,
                         scene.description())
    states = [replace(state, fields={}) for state in path]
    return Path(states, record, path.converged, path.reason, path.seconds)
