"""Tests of materials made of known laws."""

import numpy as np

from morphing_wing.calibration import MaterialTest
from morphing_wing.calibration.laws import MooneyRivlinLaw, YeohLaw
from morphing_wing.calibration.ogden import OgdenLaw

STRETCH = np.linspace(1.05, 3.0, 40)
KNOWN = [
    (YeohLaw(1), [0.12]), (YeohLaw(2), [0.117, -0.0006865]), (YeohLaw(3), [0.1, 0.006, -0.0001]),
    (MooneyRivlinLaw(), [0.1, 0.02]), (OgdenLaw(1), [0.2, 2.7]),
    (OgdenLaw(2), [0.02, 0.25, -2.0, 1.6]),
]


def made(law, values, mode="uniaxial", stretch=STRETCH, noise=0.0, seed=0, **more):
    """Return a test that follows a law, with normal errors."""
    stress = law.stress(values, mode, stretch)
    errors = noise * np.random.default_rng(seed).standard_normal(stretch.size)
    return MaterialTest(stretch, stress + errors, mode, **more)


def squares(law, values, data):
    return float(data.weights @ (data.computed(law, values) - data.stress) ** 2)
