"""A case: a scene file with some of its keys changed, and what comes out of it.

`Case` is a description without DOLFINx: it can be checked, compared and sent to other processes.
`run_case` computes it; whatever goes wrong there is told in the result and not raised.
"""

from __future__ import annotations

import copy
import gc
import os
import pathlib
import time
import warnings
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from functools import cached_property
from typing import Any

from mpi4py import MPI

from morphing_wing.built_in import built_in_scenes
from morphing_wing.errors import InputError, one_line, plain
from morphing_wing.scene_dimensions import as_value, kind_of
from morphing_wing.scene_file import SceneFile, check_scene, located, parse_table, read_table
from morphing_wing.scene_keys import SCENES
from morphing_wing.together import DONE, PATIENCE, UNEXPECTED, agree

from .case_outputs import check_outputs, found_outputs, needs_limits

__all__ = ["ALWAYS", "Case", "run_case"]

ALWAYS = ("dofs", "newton_iterations", "seconds", "refused", "stopped", "warned")
"""What every result of `run_case` has beside the outputs asked for."""


@dataclass(frozen=True)
class Case:
    """A scene file's table and changes to it. It can be pickled.

    Parameters
    ----------
    table
        What the TOML of a scene file holds, unchecked.
    changes
        Of keys as in scene files, with dots, their values: numbers in the package's units (mm, N,
        MPa, N mm, degrees, kg/m^3), or what the file would hold, such as ``"1.2 mm"``. A number for
        a load takes the place of all its steps. An entry of a list is named by its place:
        ``elastomer.coefficients.0``.
    name
        Stands for the scene's file in error messages.

    Examples
    --------
    >>> case = Case.of("spar-n4", {"geometry.top_thickness": 1.2, "fidelity": "instant"})
    >>> case.file.geometry.top_thickness
    1.2
    >>> case.value("geometry.wall_length")
    2.2
    """

    table: Mapping[str, Any]
    changes: Mapping[str, Any] = field(default_factory=dict)
    name: str = "scene"

    @classmethod
    def of(
        cls, scene: str | os.PathLike | Mapping[str, Any],
        changes: Mapping[str, Any] | None = None, folder: str | os.PathLike = ".",
    ) -> Case:
        """Return a case of a built-in scene's name, a scene file, or such a file's table.

        Parameters
        ----------
        scene
            Which of these.
        changes
            See `Case`.
        folder
            Where the scene file is looked for.

        Raises
        ------
        InputError
            If there is no such scene, or the file is no TOML.
        """
        changes = dict(changes or {})
        if isinstance(scene, Mapping):
            return cls(scene, changes)
        if not isinstance(scene, (str, os.PathLike)):
            raise InputError(f"scene = {plain(scene)}: must be a scene file, a built-in scene's "
                             "name, or a scene file's table")
        built_in = built_in_scenes()
        if str(scene) in built_in:
            return cls(parse_table(built_in[str(scene)], str(scene)), changes, str(scene))
        if pathlib.Path(scene).suffix != ".toml":
            raise InputError(f"scene = {str(scene)!r}: must be a scene file, NAME.toml, or one of "
                             f"{', '.join(built_in)}")
        file = pathlib.Path(folder) / scene
        return cls(read_table(file), changes, str(file))

    def changed(self, changes: Mapping[str, Any]) -> Case:
        """Return the case with more changes; of a key that was changed before, the new value."""
        return Case(self.table, {**self.changes, **changes}, self.name)

    @cached_property
    def file(self) -> SceneFile:
        """The scene file, all its checks passed.

        Raises
        ------
        InputError
            ``spar-n4: geometry.top_thickness = -1 mm: must be ...``, as of a scene file.
        """
        return check_scene(self.changed_table, self.name)

    @cached_property
    def changed_table(self) -> dict[str, Any]:
        """What a scene file with the changes in it holds; `file` checks it.

        Raises
        ------
        InputError
            If a change is of no key, or of the scene's kind.
        """
        table = copy.deepcopy(dict(self.table))
        base = Case(self.table, name=self.name)
        if any(key.split(".")[-1].isdecimal() for key in self.changes):
            base.file  # noqa: B018  refuses; entries of lists take their place in what is there
        with located(self.name):
            scene = table.get("scene")
            if not (isinstance(scene, str) and scene in SCENES):
                check_scene(table, self.name)
            for key, value in self.changes.items():
                if key == "scene":
                    raise InputError(f"scene: cannot be changed, must remain {scene!r}")
                _put(base, table, key, as_value(scene, key, value))
        return table

    @property
    def scene(self) -> str:
        """What it is: "spar", "rib" or "wing"."""
        return self.file.scene

    def value(self, key: str) -> Any:
        """Return the present value of a key, in the package's unit; of a load, the last one.

        What the file leaves out is as the preset, or the package, has it.

        Raises
        ------
        InputError
            If there is no such key.
        """
        kind_of(self.scene, key)  # refuses what is no key
        head, *rest = key.split(".")
        if head == "loads":
            steps = self.file.loads.get(rest[0], (0.0,))
            return steps[int(rest[1])] if len(rest) > 1 else steps[-1]
        if head in ("elastomer", "resin"):
            owner = self.file.materials.get(head, self.file.materials.get("material"))
        elif head in ("adhesive", "contact", "rib_model"):
            owner = self.file.materials.get(head)
        else:
            owner = getattr(self.file, head)
        for part in rest:
            if part.isdecimal() and int(part) >= len(owner):
                raise InputError(f"{key}: must be one of {len(owner)} entries, 0 to "
                                 f"{len(owner) - 1}")
            owner = owner[int(part)] if part.isdecimal() else getattr(owner, part, None)
        return owner


def run_case(
    case: Case, outputs: Sequence[str] = (), comm: MPI.Comm | None = None
) -> dict[str, Any]:
    """Compute a case and return what was asked of its last state. Collective.

    Parameters
    ----------
    case
        What to compute.
    outputs
        Names, each one of `case_outputs.OUTPUTS` that the scene has: any column of
        ``path.table()``, of its last row (``span_angle_deg``, ``chord_angle_deg``,
        ``energy_Nmm``, ...); what tells of limits, measured only if it is asked for
        (``largest_stretch``, ``material_stability``, ``rib_stress_MPa``, ``shaft_gap_mm``,
        ``ballooning_margin``); ``mass_g``.
    comm
        Communicator of the case; None: this process alone.

    Returns
    -------
    dict
        The outputs, not a number where the last load was not reached; ``dofs``; the path's
        ``newton_iterations`` and ``seconds``; and three texts, empty if all went well: ``refused``
        says why the case cannot be computed, ``stopped`` why its path ended before the last load
        or what went wrong, ``warned`` what the package warned of. What goes wrong on one rank alone
        is told on all; where the others wait for that rank, it ends them.
    """
    comm = MPI.COMM_SELF if comm is None else comm
    ends = comm.Dup() if comm.size > 1 else None  # apart from the messages of the scene
    found: dict[str, Any] = dict.fromkeys(outputs, float("nan"))
    found |= dict.fromkeys(ALWAYS, "") | {"dofs": 0, "newton_iterations": 0}
    nothing, failure = dict(found), None
    begin = time.perf_counter()
    with warnings.catch_warnings(record=True) as said:
        warnings.simplefilter("always", UserWarning)
        try:
            found |= _solved(case, outputs, comm)
        except InputError as problem:
            found["refused"] = failure = one_line(problem)
        except Exception as problem:  # one bad case must not end a thousand others
            failure = f"unexpected {type(problem).__name__}: {one_line(problem)}"
            found["stopped"] = failure
    if ends is not None:
        _, speaker = agree(ends, UNEXPECTED if failure else DONE, failure, PATIENCE)
        if speaker < ends.size:
            found = nothing | ends.bcast(
                {name: found[name] for name in ("refused", "stopped")}, root=speaker)
        ends.Free()
    if found["dofs"]:
        gc.collect()  # a scene's matrices and factors go together
    ours = (w for w in said if issubclass(w.category, UserWarning))
    found["warned"] = "; ".join(dict.fromkeys(one_line(w.message) for w in ours))
    return found | {"seconds": time.perf_counter() - begin}


def _put(base: Case, table: dict[str, Any], key: str, value: Any) -> None:
    """Put a value into a scene file's table; an entry of a list into what ``base`` has there."""
    *way, last = key.split(".")
    place = None
    if last.isdecimal():
        base.value(key)  # refuses a place that the list has not
        whole = ".".join(way)
        place, (*way, last) = int(last), way
    for part in way:
        table = table.setdefault(part, {})
        if not isinstance(table, dict):
            raise InputError(f"{key}: must be left out where {part} is {table!r}")
    if place is not None:
        entries = table.get(last)
        if not isinstance(entries, list):
            entries = as_value(base.scene, whole, list(base.value(whole)))
        value = [*entries[:place], value, *entries[place + 1 :]]
    table[last] = value


def _solved(case: Case, outputs: Sequence[str], comm: MPI.Comm) -> dict[str, Any]:
    file = case.file
    with located(case.name):
        check_outputs(file, outputs)
    with located(case.name):
        scene = file.build(comm, limits=needs_limits(file, outputs))
        path = file.run(scene)
        counted = {"dofs": int(scene.dofs),
                   "newton_iterations": sum(int(state.newton_iterations) for state in path)}
        if not path.converged:
            return counted | {"stopped": path.reason}
        return found_outputs(file, scene, path, outputs) | counted


