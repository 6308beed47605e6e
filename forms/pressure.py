"""Work of a uniform pressure in chambers, by their enclosed deformed volume."""

from __future__ import annotations

from typing import Any

import ufl

from .kinematics import cofactor, deformation_gradient


def enclosed_volume(u: Any, X: Any, N: Any, cut: tuple[Any, Any] | None = None) -> Any:
    """Return the integrand over a chamber's reference faces of its deformed volume in mm^3.

    By the divergence theorem ``V = -1/3 int x . cof(F) N dA`` with ``x = X + u`` and N the normal
    out of the solid, into the chamber. Faces in a symmetry plane through the origin add nothing,
    so a half chamber gives half its volume.

    Where a plane ``n . x = d`` cuts the chamber open, ``cut = (n, d)`` and
    ``V = -int (n . x - d) n . cof(F) N dA``, to which neither that plane adds anything nor planes
    that contain n; the pressure on the cut then works on n and d.
    """
    area = cofactor(deformation_gradient(u)) * N
    if cut is None:
        return -ufl.inner(X + u, area) / 3.0
    normal, distance = cut
    return -(ufl.inner(normal, X + u) - distance) * ufl.inner(normal, area)


def pressure_work(pressure: Any, u: Any, X: Any, N: Any) -> Any:
    """Return the integrand of ``P V``, the potential of a pressure (MPa) that follows the faces.

    Its first variation is the follower load, its second one symmetric for closed chambers
    (Schweizerhof, Ramm, Computers and Structures 18 (1984) 1099-1114).
    """
    return pressure * enclosed_volume(u, X, N)
