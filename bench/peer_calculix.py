"""The spar by CalculiX (https://www.calculix.de), an independent finite-element code: C3D20R.

20-node hexahedra with reduced integration, Yeoh with D1 = 2/kappa, follower pressure by element
faces. Its other hexahedra lock on this problem or fail.
"""

import re
import subprocess
import tempfile
from pathlib import Path

import numpy as np

# Corners of a cell, tensor-product order, in CalculiX' order; ends of its edges 9 to 20; its
# number of each of the package's facets z-, y-, x-, x+, y+, z+.
CORNERS = [0, 1, 3, 2, 4, 5, 7, 6]
EDGES = np.array([(0, 1), (1, 2), (2, 3), (3, 0), (4, 5), (5, 6), (6, 7), (7, 4),
                  (0, 4), (1, 5), (2, 6), (3, 7)])
FACES = np.array([1, 3, 6, 4, 5, 2])
# The nodes of the face z+, around it: corners, then the middles between them.
TIP = [4, 5, 6, 7, 12, 13, 14, 15]


def solve(problem, steps):
    """Return the angle in degrees, iterations and unknowns."""
    points, cells = twenty_nodes(problem["points"], problem["cells"])
    with tempfile.TemporaryDirectory() as folder:
        deck = Path(folder) / "spar.inp"
        deck.write_text(deck_of(problem, points, cells, steps))
        done = subprocess.run(["ccx", "spar"], cwd=folder, capture_output=True, text=True)
        if "Job finished" not in done.stdout:
            raise RuntimeError(done.stdout[-2000:])
        blocks = deck.with_suffix(".dat").read_text().split("displacements")
        iterations = [line for line in deck.with_suffix(".cvg").read_text().splitlines()
                      if re.match(r"\s*\d", line)]
    moved = points.copy()
    for line in blocks[-1].splitlines():
        row = line.split()
        if len(row) == 4 and row[0].isdigit():
            moved[int(row[0]) - 1] += [float(value) for value in row[1:]]
    return {"angle": angle(moved[cells[problem["tip"][:, 0]][:, TIP]]),
            "iterations": len(iterations), "dofs": points.size}


def twenty_nodes(points, corners):
    """Return the points and the cells of 20-node hexahedra."""
    cells = corners[:, CORNERS]
    ends, number = np.unique(np.sort(cells[:, EDGES], axis=2).reshape(-1, 2), axis=0,
                             return_inverse=True)
    middles = number.ravel().reshape(len(cells), 12) + len(points)
    return np.vstack([points, points[ends].mean(axis=1)]), np.hstack([cells, middles])


def deck_of(problem, points, cells, steps):
    """Return CalculiX' input."""
    def rows(table):
        return "\n".join(", ".join(map(str, row)) for row in table)

    def numbered(table):
        # A line holds sixteen entries at most.
        return "\n".join(
            f"{i}, " + ", ".join(map(str, row[:10])) + ",\n" + ", ".join(map(str, row[10:]))
            for i, row in enumerate(table.tolist(), 1))

    C10, C20 = problem["yeoh"]
    nodes = [(i, *map(repr, point)) for i, point in enumerate(points.tolist(), 1)]
    root, symmetry = (np.flatnonzero(points[:, axis] < 1e-9) + 1 for axis in (2, 0))
    tip = np.unique(cells[problem["tip"][:, 0]][:, TIP]) + 1
    parts = [
        "*NODE, NSET=ALL", rows(nodes),
        "*ELEMENT, TYPE=C3D20R, ELSET=SPAR", numbered(cells + 1),
        "*NSET, NSET=TIP", rows(tip[:, None]),
        "*BOUNDARY", rows((node, 1, 3) for node in root), rows((node, 1, 1) for node in symmetry),
        "*MATERIAL, NAME=RUBBER", "*HYPERELASTIC, YEOH",
        f"{C10}, {C20}, 0., {2.0 / problem['bulk']}, 0., 0.",
        "*SOLID SECTION, ELSET=SPAR, MATERIAL=RUBBER",
    ]
    for pressure in steps:
        # A quarter of the step at first: with all of it CalculiX fails, and cuts to a quarter.
        parts += ["*STEP, NLGEOM", "*STATIC", "0.25, 1.", "*DLOAD"]
        parts += [f"{cell + 1}, P{FACES[facet]}, {pressure}"
                  for cell, facet in problem["upper_chambers"]]
        parts += ["*NODE PRINT, NSET=TIP, FREQUENCY=1000", "U", "*END STEP"]
    return "\n".join(parts) + "\n"


def angle(faces):
    """Return the rotation in degrees about x of eight-node faces' mean normal.

    The integral of cof(F) N over a face is that of the cross product of its deformed tangents.
    """
    r, s = np.array([(-1, -1), (1, -1), (1, 1), (-1, 1), (0, -1), (1, 0), (0, 1), (-1, 0)]).T
    gauss, weights = np.polynomial.legendre.leggauss(3)
    normal = np.zeros(3)
    for x, a in zip(gauss, weights, strict=True):
        for y, b in zip(gauss, weights, strict=True):
            along, across = slopes(r, s, x, y), slopes(s, r, y, x)
            tangents = (np.einsum("n,fni->fi", slope, faces) for slope in (along, across))
            normal += a * b * np.cross(*tangents).sum(axis=0)
    return float(np.degrees(np.arctan2(-normal[1], normal[2])))


def slopes(r, s, x, y):
    """Return the derivatives by x of eight-node shape functions with nodes at r, s."""
    corner = 0.25 * r * (1 + s * y) * (2 * r * x + s * y)
    return np.where(r == 0, -x * (1 + s * y), np.where(s == 0, 0.5 * r * (1 - y**2), corner))
