"""Figure 7's table made up by straight lines."""

import numpy as np
import pandas as pd

# Degrees per MPa and per N of the angle that a load is for, and of the other one.
SLOPES = {"pressure": (600.0, 12.0), "cables": (100.0, -10.0)}
LOADS = {"pressure": (0.0, 0.01, 0.03), "cables": (0.0, 0.1, 0.2, 0.4)}


def curve(panel, factor=1.0, skin=True, direction="down", fidelity="draft", loads=None, **columns):
    """Return one curve, its angles ``factor`` times those of the slopes."""
    load = np.array(LOADS[panel] if loads is None else loads)
    sign = 1.0 if direction == "down" else -1.0
    main, other = (sign * factor * slope * load for slope in SLOPES[panel])
    span, chord = (main, other) if panel == "pressure" else (other, main)
    none = np.zeros(len(load))
    table = {
        "panel": panel, "skin": skin, "direction": direction, "fidelity": fidelity, "load": load,
        "pressure_MPa": load if panel == "pressure" else none,
        "cable_N": load if panel == "cables" else none,
        "span_angle_deg": span, "span_line_deg": span / 2,
        "chord_angle_deg": chord, "chord_line_deg": chord / 2,
        "negative_pivots": 0, "contact": False, "requested": True,
    }
    return pd.DataFrame(table | columns)


def study(*curves):
    """Return the long table of some curves."""
    return pd.concat(curves, ignore_index=True)
