"""Scenes without mechanics: meshes, displacement functions and states made up by formulas."""

from __future__ import annotations

import dolfinx
import numpy as np
from mpi4py import MPI

from morphing_wing import compat
from morphing_wing.geometry.spar import SparGeometry, SparMeshing
from morphing_wing.path import Path, State


class FakeScene:
    """What a `Path` needs of a scene; ``motions`` maps name -> motion(x, load factor)."""

    def __init__(self, name, functions, motions, primary_load="pressure_MPa", **extra):
        self.name, self.functions, self.motions = name, functions, motions
        self.fidelity, self.dofs, self.primary_load = "draft", 1234, primary_load
        self.comm = next(iter(functions.values())).function_space.mesh.comm
        self.__dict__.update(extra)

    def description(self):
        return {"cavity_length": 2.8, "n_cells": np.int64(4), "limits": (1.0, float("inf"))}

    def show(self, state):
        for name, function in self.functions.items():
            function.x.array[:] = state.fields[name]

    def unknowns(self):
        return [function.x.array.copy() for function in self.functions.values()]

    def set_unknowns(self, values):
        for function, array in zip(self.functions.values(), values, strict=True):
            function.x.array[:] = array

    def fields(self, factor):
        for name, function in self.functions.items():
            function.interpolate(lambda x, m=self.motions[name]: m(x, factor))
        return {name: f.x.array.copy() for name, f in self.functions.items()}


def box(comm=MPI.COMM_WORLD, degree=2, cells=(2, 3, 4), size=(1.0, 2.0, 3.0)):
    """Return a displacement function on a box of hexahedra."""
    lines = [np.linspace(0.0, s, n + 1) for s, n in zip(size, cells, strict=True)]
    nx, ny, nz = (n + 1 for n in cells)
    grid = np.stack(np.meshgrid(*lines, indexing="ij"), axis=-1).reshape(-1, 3)
    i, j, k = (a.ravel() for a in np.meshgrid(*map(np.arange, cells), indexing="ij"))
    corners = [(a, b, c) for c in (0, 1) for b in (0, 1) for a in (0, 1)]
    hexes = np.stack(
        [((i + a) * ny + j + b) * nz + k + c for a, b, c in corners], axis=1)
    assert hexes.max() < nx * ny * nz
    mesh = compat.create_mesh(comm, "hexahedron", hexes, grid)
    return dolfinx.fem.Function(compat.vector_space(mesh, degree))


def line(comm=MPI.COMM_WORLD, points=None, cells=None, rotations=False):
    """Return a quadratic displacement on intervals, or one with a rotation vector behind it."""
    if points is None:
        t = np.linspace(0.0, 1.0, 5)
        points = np.stack([10 * t, 0 * t, 0 * t], axis=1)
        cells = np.stack([np.arange(4), np.arange(1, 5)], axis=1)
    mesh = compat.create_mesh(comm, "interval", cells, points)
    return dolfinx.fem.Function(compat.vector_space(mesh, 2, 6 if rotations else 3))


def turned(motion):
    """Return a displacement and rotations of a million radians, which no drawing must show."""
    return lambda x: np.concatenate([motion(x), 1e6 + 0 * x])


def bent(x, angle, length):
    """Displace by bending about x to a circle; ``angle`` in rad at z = ``length``, tip down."""
    if angle == 0.0:
        return np.zeros_like(x)
    radius = length / angle
    turn = x[2] / radius
    return np.stack([
        0.0 * x[0],
        -radius + (radius + x[1]) * np.cos(turn) - x[1],
        (radius + x[1]) * np.sin(turn) - x[2]])


def spar_path(n_cells=6, loads=(0.0, 0.01, 0.02, 0.03), comm=MPI.COMM_WORLD):
    """Return a path of the validation spar's half model, bent by formula."""
    geometry = SparGeometry.validation(n_cells)
    mesh = geometry.mesh(SparMeshing.plain())
    function = dolfinx.fem.Function(
        compat.vector_space(compat.create_mesh(comm, "hexahedron", mesh.cells, mesh.points), 2))
    scene = FakeScene(
        "spar", {"elastomer": function},
        {"elastomer": lambda x, p: bent(x, 25.0 * p, geometry.length)}, multiplicity=2)
    states = [
        State({"upper_MPa": p, "lower_MPa": 0.0},
              {"span_angle_deg": float(np.degrees(25.0 * p)),
               "span_line_deg": float(np.degrees(12.5 * p))},
              5 + i, 900 * p**2, 1000 * p**2, 0, 1.5, i % 2 == 1 or i == 0, scene.fields(p))
        for i, p in enumerate(loads)]
    return Path(states, scene, True, "reached the last load", 6.0)
