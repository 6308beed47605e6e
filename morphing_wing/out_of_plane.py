r"""How far a rib under loads in its plane leaves this plane: the distortion of two layers.

Three layers are their own mirror image in z = 0 and cannot leave it. Two are not; their tail moves
sideways, twists and yaws.

**What the moment is then.** `Rib.bend` has the potential :math:`M \theta_z` with the third
component of the rotation vector. There is no other meaning of "a moment M" at large rotations that
all would share: one about a fixed axis has no potential. With the spin :math:`\delta\omega = T
\delta\theta` of `morphing_wing.forms.beam.tangent_map`, this one is the moment in space

.. math:: m = -M \, T(\theta)^{-T} e_z,

which is -M about z as long as the tail turns about z alone. ``moment_tilt_deg`` is the angle
between m and z: where it is a fraction of a degree, the choice does not matter.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
import pandas as pd

from .fields import shown

if TYPE_CHECKING:
    from .path import Path

__all__ = ["moment_in_space", "out_of_plane"]


def out_of_plane(path: Path) -> pd.DataFrame:
    """Return one row a state of a frame rib's path. Collective.

    Returns
    -------
    DataFrame with ``torque_Nmm``, ``cable_N``, ``chord_angle_deg`` and of the tail ``sideways_mm``
    (u_z), ``twist_deg`` and ``yaw_deg`` (theta_x, theta_y of the rotation vector);
    ``largest_mm``, how far any point of the rib moved along z; ``moment_tilt_deg``, see above, not
    a number where there is no moment.
    """
    rows = []
    for state in path:
        with shown(path.scene, state):
            tail = path.scene.ribs.end_values("tail", 0)
            moved = path.scene.ribs.function
            size = moved.function_space.dofmap.index_map_bs
            sideways = np.abs(moved.x.array.reshape(-1, size)[:, 2]).max(initial=0.0)
        rows.append(state.load | {
            "chord_angle_deg": state.measures["chord_angle_deg"], "sideways_mm": tail[2],
            "twist_deg": np.degrees(tail[3]), "yaw_deg": np.degrees(tail[4]),
            "largest_mm": max(path.scene.comm.allgather(sideways)),
            "moment_tilt_deg": _tilt(tail[3:]) if state.load["torque_Nmm"] else np.nan,
        })
    return pd.DataFrame(rows)


def moment_in_space(theta: np.ndarray) -> np.ndarray:
    """Return T^-T e_z, the moment in N mm of 1 N mm that works on the component theta_z.

    Parameters
    ----------
    theta : (3,) array
        Rotation vector of where it acts.
    """
    t = float(np.linalg.norm(theta))
    S = np.cross(np.eye(3), theta)  # S a = theta x a
    b = 0.5 * np.sinc(t / (2.0 * np.pi)) ** 2
    c = (1.0 - np.sinc(t / np.pi)) / t**2 if t > 1e-4 else 1.0 / 6.0  # of 0/0 rounding
    return np.linalg.solve((np.eye(3) + b * S + c * S @ S).T, [0.0, 0.0, 1.0])


def _tilt(theta: np.ndarray) -> float:
    x, y, z = moment_in_space(theta)
    return float(np.degrees(np.arctan2(np.hypot(x, y), z)))
