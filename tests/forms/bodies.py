"""Small bodies for the tests of forms: a distorted box with a chamber, in a random deformation."""

import numpy as np
from mpi4py import MPI

from morphing_wing.elastomer import Elastomer
from morphing_wing.elements import ELEMENTS
from morphing_wing.geometry.hexmesh import swept_blocks, uniform
from morphing_wing.materials import Yeoh
from morphing_wing.system import EquilibriumSystem

MATERIAL = Yeoh((0.117, -0.0006865, 0.001), bulk=20.0)


def distorted(x):
    """A smooth map that leaves no cell of the unit cube a parallelepiped."""
    return x + 0.06 * np.stack([
        np.sin(3.0 * x[:, 1]) * x[:, 2],
        np.cos(2.0 * x[:, 0]) * x[:, 2],
        np.sin(2.5 * x[:, 0] * x[:, 1]),
    ], axis=1)


def hollow_box(mapping=distorted, n=3):
    """The unit cube with a hollow middle: face ``chamber``."""
    kind = np.ones((n, n, n), dtype=int)
    kind[1:-1, 1:-1, 1:-1] = -1
    return swept_blocks((uniform(n),) * 3, kind, {1: "body", -1: "chamber"}, mapping)


def deformed_body(element, material=MATERIAL, seed=1):
    """A hollow box in a random finite deformation (displacements of a tenth of its size)."""
    body = Elastomer(MPI.COMM_SELF, hollow_box(), material, ELEMENTS[element], thin=("body",))
    random = np.random.default_rng(seed)
    H = 0.15 * random.standard_normal((3, 3))
    moved = body.displacement_part(body.function)
    moved.interpolate(lambda x: H @ x + 0.1 * np.sin(2.0 * x[[1, 2, 0]]))
    noise = 0.01 * random.standard_normal(len(body.function.x.array))
    body.function.x.array[:] += noise
    return body, EquilibriumSystem(body.comm, [body.block])


def direction(system, seed=2):
    """A random direction in the space of all unknowns."""
    d = system.x.duplicate()
    d.array[:] = np.random.default_rng(seed).standard_normal(len(d.array))
    return d
