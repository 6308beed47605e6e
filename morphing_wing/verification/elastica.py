"""The elastica: a slender beam clamped at one end under a dead force across it at the other."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
from mpi4py import MPI
from scipy.optimize import brentq
from scipy.special import ellipeinc, ellipkinc

from morphing_wing.geometry.section import Rectangle
from morphing_wing.materials import RESIN

from .cantilever import Cantilever
from .check import Check

__all__ = ["elastica", "exact_tip"]

LENGTH = 10.0
SLENDER = Rectangle(0.05, 0.05)
"""A two-hundredth of the length: shear and stretch are the beam's, but not Euler's."""


def exact_tip(load: float) -> tuple[float, float]:
    """Return how far the tip has gone down and back, over the length.

    With the elliptic integrals F, E of modulus k from arcsin(1/(k sqrt 2)) to a quarter turn,
    sqrt(load) = F, down = 1 - 2 E/F and back = 1 - sqrt(2 (2 k^2 - 1))/F (Bisshopp and Drucker,
    Quarterly of Applied Mathematics 3 (1945) 272-275).

    Parameters
    ----------
    load
        P L^2/(E I).
    """
    def integrals(k: float) -> tuple[float, float]:
        start = np.arcsin(1.0 / (k * np.sqrt(2.0)))
        return tuple(f(np.pi / 2, k**2) - f(start, k**2) for f in (ellipkinc, ellipeinc))

    k = brentq(lambda k: integrals(k)[0] - np.sqrt(load), np.sqrt(0.5) + 1e-12, 1.0 - 1e-12)
    F, E = integrals(k)
    return 1.0 - 2.0 * E / F, 1.0 - np.sqrt(2.0 * (2.0 * k**2 - 1.0)) / F


def elastica(comm: MPI.Comm) -> Iterator[Check]:
    """Yield the tip's way down and back."""
    bending = SLENDER.stiffness(RESIN.E, RESIN.nu)[5]
    bar = Cantilever(comm, 16, LENGTH, section=SLENDER)
    for load in (1.0, 2.0, 5.0, 10.0):
        tip = bar.tip_after([0.0, -load * bending / LENGTH**2, 0.0, 0.0, 0.0, 0.0])
        for name, value, known in zip(("down", "back"), (-tip[1], -tip[0]), exact_tip(load),
                                      strict=True):
            yield Check(f"P L^2/(E I) = {load:g}: tip {name} over L", value / LENGTH, known, "",
                        1e-3)
