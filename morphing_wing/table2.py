"""The paper's Table 2 as a study: phi_1 of nine spars at 20 kPa; nothing is fitted."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace

from mpi4py import MPI

from .errors import require
from .geometry.spar import SparGeometry
from .ladder import LADDERS
from .path import Path
from .printed_tables import TABLE_2
from .spar import Spar
from .table_study import Series, TableStudy, Told, solved

__all__ = ["PRESSURE", "table2"]

PRESSURE = 0.020  # MPa, Section 4


def table2(
    fidelities: Sequence[str] = ("instant", "cell"),
    comm: MPI.Comm | None = None,
    told: Told | None = None,
    done: Callable[[TableStudy], None] | None = None,
) -> TableStudy:
    """Compute Table 2's rows, and the combination of its best levels, which it has not tested.

    Dimensions that are no factor are those of Section 3.3.

    Parameters
    ----------
    fidelities
        Rungs of the spar's ladder, see `Spar`.
    comm
        Communicator; all ranks of MPI by default.
    told
        Called with each row as soon as it is known.
    done
        Called after each fidelity with the study so far.
    """
    rungs = LADDERS["spar"]
    for name in fidelities:
        require(name in rungs, "fidelity", name, "", f"one of {', '.join(rungs)}")
    study = TableStudy(TABLE_2, comm or MPI.COMM_WORLD,
                       {"pressure_MPa": PRESSURE, "other_dimensions": "Section 3.3"}, _remarks)
    for fidelity in dict.fromkeys(fidelities):
        def run(levels: Mapping[str, str], fidelity: str = fidelity) -> Path:
            return Spar(spar_of(levels), fidelity=fidelity, comm=study.comm).inflate(upper=PRESSURE)

        part = solved(TABLE_2, Series(fidelity), run, told)
        part.insert(part.columns.get_loc(TABLE_2.angle), "pressure_MPa", PRESSURE)
        study.parts[Series(fidelity)] = part
        if done is not None:
            done(study)
    return study


def spar_of(levels: Mapping[str, str]) -> SparGeometry:
    """Return the spar of a row of Table 2."""
    return replace(SparGeometry.validation(), wall_length=float(levels["l_s1"]),
                   cavity_length=float(levels["l_c"]), top_thickness=float(levels["h_t"]))


def _remarks(study: TableStudy) -> list[str]:
    levels = study.levels()
    ranges = levels.groupby(["fidelity", "factor"], sort=False)[["range_deg", "share"]].first()
    told = "; ".join(
        f"{name}: R = {ranges.loc[name, 'l_s1'].range_deg:.2f} deg and "
        f"{100 * ranges.loc[name, 'l_s1'].share:.0f} % of the squares, "
        f"h_t: {ranges.loc[name, 'h_t'].range_deg:.2f} deg and "
        f"{100 * ranges.loc[name, 'h_t'].share:.0f} %"
        for name in ranges.index.unique("fidelity"))
    found = [f"The paper's Section 4 says that l_s1 \"nearly\" has \"little effect\"; {told}."]
    for series, part in study.parts.items():
        extra, best = part.iloc[-1], part.iloc[:-1][TABLE_2.angle].max()
        if extra[TABLE_2.angle] > 0.0:
            found.append(f"By {series} the untested combination bends by {extra[TABLE_2.angle]:.2f}"
                         f" deg, the best of the tested ones by {best:.2f}.")
    return found
