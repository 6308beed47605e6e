"""What a structure weighs, lumped on its unknowns."""

from __future__ import annotations

import numpy as np
import ufl
from dolfinx import fem

from . import compat
from .elastomer import Elastomer
from .forms.beam import QUADRATURE_DEGREE
from .frame import BeamFrame

__all__ = ["bars_mass", "body_mass"]

_KG = 1e-9  # kg in a mm^3 of 1 kg/m^3


def body_mass(body: Elastomer) -> np.ndarray:
    """Return the mass in kg on each owned unknown of a body's block; none on a pressure."""
    return _KG * body.material.density * body.lumped_volume()


def bars_mass(bars: BeamFrame) -> np.ndarray:
    """Return the mass in kg on each owned unknown of a frame; none on a rotation: bars are thin."""
    line = bars.cellwise(_KG * bars.material.density * bars.frame.areas())
    space = bars.function.function_space
    v, mass = ufl.TestFunction(space), fem.Function(space)
    dx = ufl.dx(domain=bars.mesh, metadata={"quadrature_degree": QUADRATURE_DEGREE})
    compat.assemble_vector(compat.form(line * (v[0] + v[1] + v[2]) * dx), mass.x.array)
    compat.add_ghosts(mass)
    owned = 6 * space.dofmap.index_map.size_local
    return mass.x.array[:owned].copy()
