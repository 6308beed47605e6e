"""A wing made up by formulas: aerofoil with chambers, open pocket behind, three ribs, cables."""

from __future__ import annotations

import dolfinx
import numpy as np
from fake_scenes import FakeScene, bent, line, turned
from mpi4py import MPI

from morphing_wing import compat
from morphing_wing.drawing import Cut, Drawing, default_drawing
from morphing_wing.geometry.hexmesh import swept_blocks
from morphing_wing.path import Path, State

CHORD, SPAN = 150.0, 128.0


def half_thickness(x):
    """Return half the thickness of NACA 0012 with a chord of 150 mm, blunt at both ends."""
    t = np.clip(x / CHORD, 0.004, 0.99)
    return 0.6 * CHORD * (
        0.2969 * np.sqrt(t) - 0.126 * t - 0.3516 * t**2 + 0.2843 * t**3 - 0.1036 * t**4)


def wing_mesh():
    x = np.array([0.0, 2.5, 5, 15, 30, 50, 68, 72, 75, 90, 105, 120, 135, 144, 150])
    y = np.array([-1.0, -0.75, -0.12, 0.12, 0.75, 1.0])
    z = np.concatenate([[0.0], *[2 + 7 * i + np.array([0, 2.5, 5.0]) for i in range(18)], [128.0]])
    kind = np.ones((len(x) - 1, len(y) - 1, len(z) - 1), dtype=int)
    cavity_z = np.array([k for k in range(len(z) - 1) if z[k + 1] - z[k] > 2.2])
    for k in cavity_z:
        kind[2:7, 1, k] = kind[2:7, 3, k] = 0
    kind[8:13, 1:4, 1:] = 0

    def mapping(p):
        return np.stack([p[:, 0], p[:, 1] * half_thickness(p[:, 0]), p[:, 2]], axis=1)

    return swept_blocks((x, y, z), kind, {0: "outside", 1: "elastomer"}, mapping)


def motion(x, p):
    span = bent(x, 25.0 * p, SPAN)
    back = np.clip(x[0] - 75.0, 0.0, None)
    turn = 30.0 * p * back / 75.0
    chord = np.stack([-back * turn**2 / 6, -back * turn / 2, 0 * back])
    return span + chord


def ribs(comm=MPI.COMM_WORLD, n=17):
    points, cells = [], []
    for z0 in (21.3, 64.0, 106.7):
        for layer, sign in ((-6.0, 1), (0.0, -1), (6.0, 1)):
            for up in (1, -1):
                start = len(points)
                xs = 76.0 + 64.0 * np.arange(n + 1) / n
                ys = sign * up * 1.15 * (-1.0) ** np.arange(n + 1)
                points += [(a, b, z0 + layer) for a, b in zip(xs, ys, strict=True)]
                cells += [(start + i, start + i + 1) for i in range(n)]
    return line(comm, np.array(points), np.array(cells), rotations=True)


def wing_path(loads=(0.0, 0.0125, 0.025), comm=MPI.COMM_WORLD, degree=2):
    mesh = wing_mesh()
    domain = compat.create_mesh(comm, "hexahedron", mesh.cells, mesh.points)
    u = dolfinx.fem.Function(compat.vector_space(domain, degree))
    r = ribs(comm)
    scene = FakeScene("wing", {"elastomer": u, "ribs": r}, {"elastomer": motion, "ribs": motion})

    def drawing(state):
        tails = np.array([[140.0, 0.0, z] for z in (21.3, 64.0, 106.7)])
        moved = tails + motion(tails.T, state.load["upper_MPa"]).T
        cables = [np.array([a, a - [0, 40.0, 0]]) for a in moved]
        return Drawing(eye=default_drawing(scene).eye, cuts=(Cut("x", 40.0), Cut("z", 75.0)),
                       radius={"ribs": 0.7}, cables=cables)

    scene.drawing = drawing

    def fields(p):
        u.interpolate(lambda x: motion(x, p))
        r.interpolate(turned(lambda x: motion(x, p)))
        return {"elastomer": u.x.array.copy(), "ribs": r.x.array.copy()}

    states = [
        State({"upper_MPa": p, "lower_MPa": 0.0, "cable_N": 10 * p},
              {"span_angle_deg": float(np.degrees(25 * p)), "span_line_deg": 2.0,
               "chord_angle_deg": float(np.degrees(30 * p)), "chord_line_deg": 1.0,
               "contact": float(p > 0.02)}, 7, 100 * p, 110 * p, 0, 9.0, True, fields(p))
        for p in loads]
    return Path(states, scene, True, "reached the last load", 30.0)
