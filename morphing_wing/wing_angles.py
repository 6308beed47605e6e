"""The angles of a wing: along its span, along its chord, and of each rib."""

from __future__ import annotations

import numpy as np

from .angles import deflection_line, rotation_about_x, rotation_about_z, turned_x
from .bar_mesh import BarMesh
from .elastomer import Elastomer
from .geometry.wing import WingGeometry
from .solid_ribs import SolidRibs

__all__ = ["wing_angles"]


def wing_angles(
    wing: WingGeometry, body: Elastomer, ribs: BarMesh | SolidRibs | None
) -> dict[str, float]:
    """Return all angles in degrees, positive downwards, of the present state. Collective.

    ``span_angle_deg`` (phi_1) is the tip face's rotation, ``chord_angle_deg`` (phi_2) that of the
    trailing edge, or of the ribs' tails in a wing without skin, against the spar's rear wall; the
    latter's is ``spar_twist_deg``, and the sum of the two, the rotation in space,
    ``trailing_edge_deg``. ``..._line_deg`` are the rotations of the lines from root to end.
    """
    span = np.array([0.0, 0.0, wing.span])
    found = {
        "span_angle_deg": rotation_about_x(body.mean_normal("tip")),
        "span_line_deg": deflection_line(body.mean_displacement("tip"), span),
    }
    each = _ribs(wing, ribs) if ribs is not None else {}
    if wing.skin_thickness is not None:
        edge, line = _trailing_edge(wing, body)
    elif each:
        edge, line = (float(np.mean([each[name] for name in each if kind in name]))
                      for kind in ("rotation", "line"))
    else:
        return found
    spar = rotation_about_z(body.mean_normal("rear_wall"))
    return found | {
        "chord_angle_deg": edge - spar, "chord_line_deg": line - spar,
        "spar_twist_deg": spar, "trailing_edge_deg": edge,
    } | each


def _trailing_edge(wing: WingGeometry, body: Elastomer) -> tuple[float, float]:
    """Return the rotation of the skin's trailing edge and of the line to it from the spar."""
    rear, edge = (body.mean_displacement(face) for face in ("rear_wall", "trailing_edge"))
    chord = np.array([wing.chord - wing.spar_end, 0.0, 0.0])
    return (rotation_about_z(body.mean_normal("trailing_edge")),
            rotation_about_z(chord + edge - rear))


def _ribs(wing: WingGeometry, ribs: BarMesh | SolidRibs) -> dict[str, float]:
    """Return of each rib its tail's rotation and the rotation of the line from root to tail."""
    found = {}
    length = np.array([wing.rib.length, 0.0, 0.0])
    for i in range(len(wing.rib_positions)):
        root, tail = (ribs.end_values(kind, i) for kind in ("root", "tail"))
        found[f"rib_{i + 1}_rotation_deg"] = rotation_about_z(turned_x(tail[3:]))
        found[f"rib_{i + 1}_line_deg"] = rotation_about_z(length + tail[:3] - root[:3])
    return found
