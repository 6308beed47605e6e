"""Where the skin wrinkles: the slowest modes along the pressure, and what lies beyond.

The prototype of the paper's Section 5.1, with skin and ribs, without contact forces (nothing
touches up to here), is inflated twice: with Newton's method regularised where the tangent has
negative pivots, as everybody's wing is, and by a plain one. At each point the table gives the
frequencies of the slowest modes, the negative pivots, and the difference of the two wings' angles.
The modes of the softest point (product of their eigenvalues) are drawn. Eight minutes at draft on
two ranks:

    mpirun -n 2 python bench/wrinkling.py --out wrinkling
"""

import argparse
from pathlib import Path

import numpy as np
import pandas as pd
from rich.console import Console
from rich.table import Table

from morphing_wing import Wing
from morphing_wing.geometry import WingGeometry
from morphing_wing.modes import modes

COLUMNS = {"kPa": "{:g}", "mode_1_Hz": "{:.2f}", "mode_2_Hz": "{:.2f}", "mode_3_Hz": "{:.2f}",
           "negative_pivots": "{:.0f}", "span_angle_deg": "{:.4f}", "iterations": "{:.0f}",
           "plain_deg": "{:.4f}", "plain_iterations": "{:.0f}", "difference": "{:.1e}"}


class Plain(Wing):
    """A wing whose Newton's method is not regularised."""

    def _regularisation(self):
        return None


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--fidelity", default="draft", choices=["draft", "standard"])
    parser.add_argument("--kpa", type=float, nargs="+", metavar="P",
                        default=[5, 8, 10, 10.5, 11, 11.5, 12, 12.5, 15, 20])
    parser.add_argument("--cells", type=int, default=18, metavar="N", help="chambers in a row")
    parser.add_argument("--out", type=Path, default=Path("wrinkling"), metavar="DIR")
    arguments = parser.parse_args()
    wing, plain = (
        kind(WingGeometry.prototype(n_cells=arguments.cells), fidelity=arguments.fidelity,
             contact=False) for kind in (Wing, Plain))
    rows, softest, least = [], None, np.inf
    for kpa in arguments.kpa:
        pressure = kpa / 1000.0
        path = wing.actuate(upper=pressure)
        if not path.converged:
            break
        found = modes(wing, 3)
        other = plain.actuate(upper=pressure)
        rows.append(row(path, found, other) | {"kPa": kpa})
        if (product := np.prod([mode.eigenvalue for mode in found])) < least:
            softest, least = found, product
    softest.save(arguments.out)
    if wing.comm.rank == 0:
        pd.DataFrame(rows).to_csv(arguments.out / "wrinkling.csv", index=False)
        Console(width=150).print(as_table(rows))


def row(path, found, other):
    """Return the figures of one pressure."""
    angle = path[-1].measures["span_angle_deg"]
    figures = {f"mode_{i + 1}_Hz": mode.frequency_Hz for i, mode in enumerate(found)}
    figures |= {"negative_pivots": path[-1].negative_pivots, "span_angle_deg": angle,
                "iterations": sum(state.newton_iterations for state in path)}
    if other.converged:
        plain = other[-1].measures["span_angle_deg"]
        figures |= {"plain_deg": plain, "difference": abs(plain / angle - 1.0),
                    "plain_iterations": sum(state.newton_iterations for state in other)}
    return figures


def as_table(rows):
    """Return the figures to print."""
    table = Table(title="Wing of Section 5.1 under pressure")
    for name in COLUMNS:
        table.add_column(name.replace("_deg", ", deg").replace("_", " "), justify="right")
    for each in rows:
        table.add_row(*(COLUMNS[name].format(each[name]) if name in each else "did not converge"
                        for name in COLUMNS))
    return table


if __name__ == "__main__":
    main()
