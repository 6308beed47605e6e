"""``morphing-wing calibrate``: a rubber's constants from files of tests."""

from __future__ import annotations

import pathlib
from collections.abc import Sequence
from typing import TYPE_CHECKING, Annotated, Any

import typer
from mpi4py import MPI

from morphing_wing.errors import InputError
from morphing_wing.out_folder import check_folder
from morphing_wing.root import on_root
from morphing_wing.together import DONE

if TYPE_CHECKING:
    from morphing_wing.calibration import Calibration

__all__ = ["calibrate"]


def calibrate(
    files: Annotated[
        list[str], typer.Argument(metavar="FILE.csv...", help="Tests; dragon_skin_30 is built in.")
    ],
    terms: Annotated[int, typer.Option(metavar="N", help="Terms of Yeoh's law, 1 to 3.")] = 2,
    max_stretch: Annotated[
        list[float] | None,
        typer.Option(metavar="X", help="Use the curves up to this stretch; 1 + nominal strain."),
    ] = None,
    mode: Annotated[
        list[str] | None,
        typer.Option(metavar="M", help="uniaxial, planar or equibiaxial; found by a word in name "
                     "or header if not given, else uniaxial."),
    ] = None,
    weight: Annotated[
        list[float] | None,
        typer.Option(metavar="W", help="How much a test counts, however many points it has; 1."),
    ] = None,
    strain: Annotated[
        list[str] | None,
        typer.Option(metavar="COLUMN", help="Column of strain or stretch, by name or number."),
    ] = None,
    stress: Annotated[
        list[str] | None,
        typer.Option(metavar="COLUMN", help="Column of stress, by name or number."),
    ] = None,
    strain_kind: Annotated[
        list[str] | None, typer.Option(metavar="K", help="nominal, true or stretch.")
    ] = None,
    stress_kind: Annotated[
        list[str] | None, typer.Option(metavar="K", help="nominal or true.")
    ] = None,
    strain_unit: Annotated[list[str] | None, typer.Option(metavar="U", help="% or 1.")] = None,
    stress_unit: Annotated[
        list[str] | None, typer.Option(metavar="U", help="MPa, kPa, N/mm^2, psi, ...")
    ] = None,
    stable: Annotated[
        float | None,
        typer.Option(metavar="X", help="Make all laws stable up to this stretch, in all modes."),
    ] = None,
    whole: Annotated[
        bool, typer.Option("--whole", help="Keep what follows a curve's largest stress in tension: "
                           "failure or unloading.")
    ] = False,
    out: Annotated[
        pathlib.Path | None,
        typer.Option(metavar="DIR", help="Folder of the results; output/calibrate-FILE."),
    ] = None,
) -> int:
    """Fit a rubber's constants to tests, and tell up to which stretch they are stable.

    Yeoh's law makes the material; neo-Hooke, Mooney-Rivlin and Ogden stand beside it. Options of a
    file are given once for all files, or once each in their order. For example:

    morphing-wing calibrate dragon_skin_30 --max-stretch 4

    morphing-wing calibrate pull.csv bulge.csv --mode uniaxial --mode equibiaxial --stable 5

    morphing-wing calibrate raw.txt --strain 2 --strain-unit % --stress 3 --stress-unit kPa

    Writes table.csv, stability.csv, curves.csv, summary.json, calibration.png, and elastomer.toml
    for scene files.
    """
    comm = MPI.COMM_WORLD
    stem = pathlib.Path(files[0]).stem
    folder = pathlib.Path("output") / f"calibrate-{stem}" if out is None else out
    options = {"mode": mode, "weight": weight, "strain": strain, "stress": stress,
               "strain_kind": strain_kind, "stress_kind": stress_kind,
               "strain_unit": strain_unit, "stress_unit": stress_unit}

    def run() -> Calibration:
        from morphing_wing.calibration import calibrate, read_test

        check_folder(folder)
        each = {name: of_each(name, given, len(files)) for name, given in options.items() if given}
        tests = [read_test(file, **{name: values[i] for name, values in each.items()})
                 for i, file in enumerate(files)]
        limits = of_each("max_stretch", max_stretch, len(files)) if max_stretch else None
        one = max_stretch[0] if max_stretch and len(max_stretch) == 1 else limits
        return calibrate(*tests, terms=terms, max_stretch=one, stable=stable, whole=whole)

    found = on_root(comm, run)
    # The summary tells the version of DOLFINx, and to load it starts PETSc on all ranks together.
    import dolfinx  # noqa: F401

    on_root(comm, lambda: tell(found, folder))
    return DONE


def of_each(name: str, given: Sequence[Any], n: int) -> list[Any]:
    """Return an option's value for each of n files."""
    if len(given) not in (1, n):
        raise InputError(f"--{name.replace('_', '-')}: is given {len(given)} times, must be once, "
                         f"or once for each of {n} files")
    return list(given) * (n if len(given) == 1 else 1)


def tell(found: Calibration, folder: pathlib.Path) -> None:
    """Save and print a calibration: what is written stays where the output's reader ends early."""
    from morphing_wing.calibration.report import report
    from morphing_wing.terminal_tables import show

    found.save(folder)
    show(report(found))
    typer.echo(f"\n{found.toml}\nresults are in {folder}")
