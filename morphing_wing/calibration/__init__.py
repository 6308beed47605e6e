"""Constants of rubber from tests: read, fitted, judged, drawn. Loads no DOLFINx.

Examples
--------
>>> from morphing_wing.calibration import calibrate
>>> found = calibrate("dragon_skin_30", max_stretch=4)
>>> found.material.coefficients  # doctest: +ELLIPSIS
(0.1193..., 0.003057...)
"""

from .curve_file import BUILT_IN, read_test
from .material_test import MaterialTest
from .result import Calibration
from .study import calibrate

__all__ = ["BUILT_IN", "Calibration", "MaterialTest", "calibrate", "read_test"]
