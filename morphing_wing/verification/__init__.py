"""Problems with known answers, solved by what the package's scenes are made of.

``morphing-wing verify`` solves them now and prints value, reference, error and verdict; so do the
project's tests. Each problem yields `Check` objects::

    from mpi4py import MPI
    from morphing_wing.verification import PROBLEMS

    for check in PROBLEMS["cook"].run(MPI.COMM_WORLD):
        print(check.name, check.value, check.reference, check.holds)
"""

from __future__ import annotations

from .balance import balance, rotation
from .check import Check, Problem
from .cook import cook
from .elastica import elastica
from .equilibrium import NoEquilibriumError
from .homogeneous import homogeneous, patch
from .land import land
from .manufactured import convergence
from .membranes import membranes
from .thick_walls import walls

__all__ = ["PROBLEMS", "Check", "NoEquilibriumError", "Problem"]

_ALL = (
    Problem("patch", "patch test of every element", "homogeneous deformation", patch, quick=True),
    Problem("homogeneous", "rubber and resin in tension, compression and shear", "closed form",
            homogeneous, quick=True),
    Problem("elastica", "cantilever under a dead force", "Bisshopp and Drucker 1945", elastica,
            quick=True),
    Problem("balance", "work against energy, reaction against load", "balance of energy and force",
            balance, quick=True),
    Problem("land", "beam of cardiac muscle under follower pressure", "Land et al. 2015, problem 1",
            land, quick=True),
    Problem("rotation", "a whole spar and resin, turned as they are", "frame invariance", rotation),
    Problem("convergence", "order of convergence to a manufactured solution", "theory",
            convergence),
    Problem("walls", "thick sphere and cylinder under pressure, limit point", "closed form", walls),
    Problem("membranes", "balloon and clamped circle past their limit points", "membrane theory",
            membranes),
    Problem("cook", "Cook's membrane at finite strain", "another code, Q2-Q1", cook),
)
PROBLEMS = {problem.name: problem for problem in _ALL}
"""All problems by name, the quick ones first."""
