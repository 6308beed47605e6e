"""``morphing-wing tradeoff``: each fidelity's cost and error, measured now."""

from __future__ import annotations

import json
import os
import pathlib
from importlib import resources
from typing import Annotated, Any

import typer
from mpi4py import MPI

from morphing_wing.errors import InputError, require
from morphing_wing.ladder import LADDERS
from morphing_wing.out_folder import check_folder
from morphing_wing.root import on_root, write_whole
from morphing_wing.together import DONE

__all__ = ["tradeoff"]

FORMS = {
    "fidelity": "{}", "ranks": "{}", "dofs": "{:,}", "iterations": "{:.0f}", "assembly_s": "{:.2f}",
    "factor_s": "{:.2f}", "seconds": "{:.3g}", "peak_MB": "{:.0f}", "angle_deg": "{:.4f}",
    "error": "{:+.2%}",
}
KEPT = ["scene", "case", "n_cells", "load", *FORMS]


def tradeoff(
    scene: Annotated[str, typer.Argument(metavar="spar|rib|wing")],
    out: Annotated[
        pathlib.Path | None,
        typer.Option(metavar="DIR", help="Folder of the results; output/tradeoff-SCENE."),
    ] = None,
    keep: Annotated[
        bool, typer.Option("--keep", help="Measure all cases, and keep them for fidelity \"auto\".")
    ] = False,
) -> int:
    """Measure what each fidelity of a scene costs and how far it is off; minutes.

    Writes tradeoff.csv, summary.json and tradeoff.png: error against seconds, with the rungs that
    no other one beats in both.
    """
    require(scene in LADDERS, "scene", scene, "", f"one of {', '.join(LADDERS)}")
    folder = pathlib.Path("output") / f"tradeoff-{scene}" if out is None else out
    comm = MPI.COMM_WORLD
    on_root(comm, lambda: check_folder(folder))
    kept = pathlib.Path(str(resources.files("morphing_wing"))) / "measured" / f"{scene}.csv"
    if keep:
        on_root(comm, lambda: _check_kept(kept))

    from morphing_wing.tradeoff import SCENES

    rows: list[dict[str, Any]] = []
    for found in SCENES[scene](comm, keep):
        if comm.rank == 0:
            _tell(rows, found)
        rows.append(found)
    on_root(comm, lambda: _write(rows, scene, folder, kept if keep else None))
    typer.echo(f"results are in {folder}" + (f", and kept in {kept}" if keep else ""))
    return DONE


def _check_kept(file: pathlib.Path) -> None:
    if not os.access(file if file.exists() else file.parent, os.W_OK):
        raise InputError(f"--keep: must be left out, {file} cannot be written")


def _tell(rows: list[dict[str, Any]], found: dict[str, Any]) -> None:
    """Print a row as it comes, the first one under the names of the columns."""
    if not rows:
        typer.echo(f"{'case':30} " + " ".join(f"{name:>10}" for name in FORMS))
    cells = ("" if found[name] is None else form.format(found[name])
             for name, form in FORMS.items())
    case = "{case}, N = {n_cells}, {load}".format(**found)
    typer.echo(f"{case:30} " + " ".join(f"{cell:>10}" for cell in cells))


def _write(
    rows: list[dict[str, Any]], scene: str, folder: pathlib.Path, kept: pathlib.Path | None
) -> None:
    import pandas as pd

    from morphing_wing.summary import plain, versions
    from morphing_wing.tradeoff.front import beaten_by, draw

    table = pd.DataFrame(rows)[KEPT]
    table["beaten_by"] = beaten_by(table)
    folder.mkdir(parents=True, exist_ok=True)
    for file in (folder / "tradeoff.csv", kept):
        if file is not None:
            write_whole(file, lambda at: table.to_csv(
                at, index=False, float_format="%.6g", na_rep="nan"))
    text = json.dumps(plain({"scene": scene, "rows": table.to_dict("records"),
                             "versions": versions()}), indent=2, allow_nan=False) + "\n"
    write_whole(folder / "summary.json", lambda at: at.write_text(text))
    draw(table[table["seconds"].notna()], f"{scene}: the trade of speed for accuracy",
         folder / "tradeoff.png")
    beaten = table[table["beaten_by"] != ""]
    for row in beaten.itertuples():
        typer.echo(f"{row.case}, N = {row.n_cells}, {row.load}: {row.fidelity} is beaten by "
                   f"{row.beaten_by} in cost and error")
