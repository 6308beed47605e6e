"""A straight bar clamped at its start, and its equilibrium under loads at its end."""

import numpy as np
import ufl
from dolfinx import fem
from mpi4py import MPI

from morphing_wing.blocks import Block
from morphing_wing.frame import BeamFrame
from morphing_wing.geometry.frame import Frame, local_axes
from morphing_wing.geometry.rib import KINDS
from morphing_wing.geometry.section import Rectangle
from morphing_wing.materials import RESIN
from morphing_wing.newton import Newton
from morphing_wing.system import EquilibriumSystem

SQUARE = Rectangle(1.0, 1.0)


def cantilever(n, length=10.0, direction=(1.0, 0.0, 0.0), material=RESIN, section=SQUARE):
    """Return a straight bar of n cells, clamped at its start, as a frame of beams."""
    x = np.linspace(0.0, length, n + 1)
    points = x[:, None] * np.asarray(direction)
    bars = np.stack([np.arange(n), np.arange(1, n + 1)], axis=1)
    kinds = np.full(n, KINDS.index("shaft"))
    kinds[-1] = KINDS.index("tail")
    frame = Frame(points, bars, kinds, KINDS, local_axes(points, bars),
                  ({"shaft": section, "tail": section},), np.zeros(n, dtype=int),
                  np.array([0]), np.array([n]))
    beams = BeamFrame(MPI.COMM_SELF, frame, material)
    w = beams.function
    at_root = np.linalg.norm(w.function_space.tabulate_dof_coordinates(), axis=1) < 1e-9
    clamped = (6 * np.flatnonzero(at_root)[:, None] + np.arange(6)).ravel()
    return beams, EquilibriumSystem(beams.comm, [Block(w, clamped)])


def tail_after(beams, system, load):
    """Solve under a dead force (N) and moment (N mm) at the tail; return u and theta there."""
    dead = fem.Constant(beams.mesh, np.asarray(load, dtype=float))
    energy = beams.energy - beams.at_ends("tail", ufl.inner(dead, beams.function))
    system.set_energies([energy], [beams.tangent_correction])
    newton = Newton(system, "test_beam_", before_tangent=beams.iterate.before_tangent)
    result = newton.solve(float(np.linalg.norm(load)))
    assert result.converged, result.reason
    return beams.end_values("tail", 0)
