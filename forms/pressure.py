"""Work of a uniform pressure in chambers, by their enclosed deformed volume."""

from __future__ import annotations

from typing import Any

import ufl

from .kinematics import cofactor, deformation_gradient


def enclosed_volume(u: Any, X: Any, N: Any) -> Any:
    """Return the integrand over a chamber's reference faces of its deformed volume in mm^3.

    By the divergence theorem ``V = -1/3 int x . cof(F) N dA`` with ``x = X + u`` and N the normal
    out of the solid, into the chamber. Faces in a symmetry plane through the origin add nothing,
    so a half chamber gives half its volume.
    """
    return -ufl.inner(X + u, cofactor(deformation_gradient(u)) * N) / 3.0


def pressure_work(pressure: Any, u: Any, X: Any, N: Any) -> Any:
    """Return the integrand of ``P V``, the potential of a pressure (MPa) that follows the faces.

    Its first variation is the follower load, its second one symmetric for closed chambers
    (Schweizerhof, Ramm, Computers and Structures 18 (1984) 1099-1114).
    """
    return pressure * enclosed_volume(u, X, N)
