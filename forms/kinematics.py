"""Finite-strain kinematics of a body with displacement ``u`` in mm."""

from __future__ import annotations

from typing import Any

import ufl


def deformation_gradient(u: Any) -> Any:
    """Return ``F = I + grad(u)``."""
    return ufl.Identity(len(u)) + ufl.grad(u)


def cofactor(F: Any) -> Any:
    """Return ``cof F``, polynomial in F, so that it is regular at det F = 0."""
    a, b, c = (ufl.as_vector([F[i, j] for i in range(3)]) for j in range(3))
    columns = (ufl.cross(b, c), ufl.cross(c, a), ufl.cross(a, b))
    return ufl.as_tensor([[columns[j][i] for j in range(3)] for i in range(3)])


def isochoric_first_invariant(F: Any) -> Any:
    """Return ``I1bar = J^(-2/3) tr(F^T F)``; not a number where J <= 0, which a solver must see."""
    return ufl.det(F) ** (-2.0 / 3.0) * ufl.inner(F, F)
