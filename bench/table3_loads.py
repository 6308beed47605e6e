"""What makes the crossing angle count in Table 3: an end moment, an end force, ribs of one length.

The nine rows by the frame, "flush", scaled by least squares to the printed angles as `paper table3`
does; level means of each factor in degrees, and the rows' misfit. Seconds.
"""

import numpy as np
from rich.console import Console
from rich.table import Table

from morphing_wing.geometry import RibGeometry
from morphing_wing.printed_tables import TABLE_3
from morphing_wing.range_analysis import range_analysis
from morphing_wing.rib import Rib
from morphing_wing.table3 import N_CELLS, rib_of

LENGTH = 28.0  # mm, about that of Section 3.3
FAR = (0.0, -1e6, 0.0)  # a guide so far down that the cable is a dead force
LOADS = {"moment": lambda rib: rib.bend(torque=1e-3), "force": lambda rib: rib.pull(1e-3, FAR)}


def main():
    cases = TABLE_3.cases[TABLE_3.cases["printed_deg"].notna()]
    printed = cases["printed_deg"].to_numpy(float)
    factors = list(TABLE_3.factors)
    table = Table(title="Table 3 by the frame, flush")
    for column in ("ribs", "load", "rms", *factors):
        table.add_column(column, justify="right")
    table.add_row("printed", "", "", *means(cases, printed, factors))
    for ribs, cells in (("of 6 cells", lambda rib: N_CELLS),
                        (f"of {LENGTH:g} mm", lambda rib: max(2, round(LENGTH / rib.pitch)))):
        for load, lead in LOADS.items():
            angles = []
            for row in cases.to_dict("records"):
                rib = rib_of(row, "flush")
                rib = RibGeometry(rib.shaft_length, rib.shaft_thickness, rib.pivot_diameter,
                                  rib.pivot_length, rib.crossing_angle, cells(rib))
                angles.append(lead(Rib(rib))[-1].measures["chord_angle_deg"])
            angles = np.array(angles)
            angles *= (angles @ printed) / (angles @ angles)
            rms = np.sqrt(np.mean((angles / printed - 1.0) ** 2))
            table.add_row(ribs, load, f"{rms:.1%}", *means(cases, angles, factors))
    Console(width=110).print(table)


def means(cases, angles, factors):
    """Return the level means of each factor in words."""
    levels = range_analysis(cases.assign(angle=angles), factors, "angle")
    return [", ".join(f"{mean:.1f}" for mean in levels[levels["factor"] == factor]["mean"])
            for factor in factors]


if __name__ == "__main__":
    main()
