"""The three homogeneous tests of an incompressible rubber, each led by one stretch."""

from __future__ import annotations

from typing import Any

import numpy as np

__all__ = ["MODES", "accelerations", "principal", "rates"]

MODES = ("uniaxial", "planar", "equibiaxial")
"""Tension of a strip, of a wide short sheet (pure shear), of a sheet in both its directions."""

# Exponents of the stretch in the three principal stretches; the third direction is always free.
_EXPONENTS = {
    "uniaxial": (1.0, -0.5, -0.5), "planar": (1.0, 0.0, -1.0), "equibiaxial": (1.0, 1.0, -2.0),
}


def principal(mode: str, stretch: Any) -> np.ndarray:
    """Return the principal stretches, of shape (..., 3); the third one's face is free of stress."""
    return np.asarray(stretch, dtype=float)[..., None] ** np.array(_EXPONENTS[mode])


def rates(mode: str, stretch: Any) -> np.ndarray:
    """Return the principal stretches' derivatives by the stretch, of shape (..., 3)."""
    powers = np.array(_EXPONENTS[mode])
    return powers * np.asarray(stretch, dtype=float)[..., None] ** (powers - 1.0)


def accelerations(mode: str, stretch: Any) -> np.ndarray:
    """Return the principal stretches' second derivatives by the stretch, of shape (..., 3)."""
    powers = np.array(_EXPONENTS[mode])
    return powers * (powers - 1.0) * np.asarray(stretch, dtype=float)[..., None] ** (powers - 2.0)
