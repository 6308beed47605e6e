"""Geometry: parameters to points, cells and named regions; numpy and scipy only, no DOLFINx."""

from .aerofoil import Aerofoil
from .rib import RibGeometry
from .spar import SparGeometry, SparMeshing
from .wing import WingGeometry
from .wing_mesh import WingMeshing

__all__ = [
    "Aerofoil", "RibGeometry", "SparGeometry", "SparMeshing", "WingGeometry", "WingMeshing",
]  # fmt: skip
