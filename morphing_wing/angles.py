"""The paper's two angles from integrals over faces; degrees, positive when the wing goes down."""

from __future__ import annotations

import numpy as np


def rotation_about_x(area_vector: np.ndarray) -> float:
    """Return phi_1: rotation of a face that looked along +z, positive when it looks down (-y)."""
    return float(np.degrees(np.arctan2(-area_vector[1], area_vector[2])))


def rotation_about_z(direction: np.ndarray) -> float:
    """Return the rotation of a direction that was +x, positive when it points down (-y)."""
    return float(np.degrees(np.arctan2(-direction[1], direction[0])))


def deflection_line(displacement: np.ndarray, lever: np.ndarray) -> float:
    """Return the angle whose tangent is deflection over length, as a protractor may read it.

    Parameters
    ----------
    displacement, lever
        Displacement of the tip, and undeformed vector to it from the root, both (3,) in mm.
    """
    return float(np.degrees(np.arctan2(-displacement[1], np.linalg.norm(lever))))


def turned_x(theta: np.ndarray) -> np.ndarray:
    """Return where the rotation vector ``theta`` turns the direction x, shape (3,)."""
    return turned(theta, np.array([1.0, 0.0, 0.0]))


def turned(theta: np.ndarray, v: np.ndarray) -> np.ndarray:
    """Return where rotation vectors turn vectors, both (..., 3)."""
    angle = np.linalg.norm(theta, axis=-1, keepdims=True)
    a, b = np.sinc(angle / np.pi), 0.5 * np.sinc(angle / (2.0 * np.pi)) ** 2
    return v + a * np.cross(theta, v) + b * np.cross(theta, np.cross(theta, v))
