"""The mass of what a scene file describes, from its geometry and densities alone."""

from __future__ import annotations

from morphing_wing.forms.gravity import mass_density
from morphing_wing.geometry.wing_mesh import WingMeshing, wing_mesh
from morphing_wing.scene_file import SceneFile

__all__ = ["mass"]

_GRAMS = 1000.0


def mass(file: SceneFile) -> float:
    """Return the mass in g, the same at every fidelity.

    Of a spar it is exact. Of a wing it is that of the coarse mesh of its elastomer, and of its
    ribs. A rib counts its shafts and pivots (`RibGeometry.volume`), without foot plate and tail.
    """
    if file.scene != "wing":
        return _of(file.geometry.volume, file.materials["material"])
    mesh = wing_mesh(file.geometry, WingMeshing.coarse())
    found = _of(mesh.volume(), file.materials["elastomer"])
    if file.geometry.rib is not None:
        n = len(file.geometry.rib_positions)
        found += n * _of(file.geometry.rib.volume, file.materials["resin"])
    return found


def _of(volume: float, material: object) -> float:
    return _GRAMS * mass_density(material.density) * volume  # type: ignore[attr-defined]
