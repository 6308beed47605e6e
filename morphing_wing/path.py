"""The path of equilibria that a scene went through, and what is kept of it.

A scene returns a `Path`: one `State` for every converged step, whether the user asked for its load
or the stepping put it in between. Rank 0 alone writes; whatever touches fields is collective.
"""

from __future__ import annotations

import json
import os
import pathlib
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any, overload

import numpy as np

from morphing_wing.errors import InputError
from morphing_wing.renderer import or_warned
from morphing_wing.root import on_root, write_whole
from morphing_wing.summary import summary
from morphing_wing.targets import load_words

if TYPE_CHECKING:
    import pandas as pd

__all__ = ["Path", "State", "load_table"]


@dataclass
class State:
    """One converged equilibrium.

    Parameters
    ----------
    load
        The scene's loads: ``upper_MPa``, ``lower_MPa`` (chamber pressures, MPa), ``cable_N``
        (tension in each cable, N), ``torque_Nmm`` (end moment of a rib, N mm), ``gravity_g``
        (multiples of standard gravity along -y).
    measures
        What the scene measures, e.g. ``span_angle_deg`` (phi_1, rotation of the tip face, degrees),
        ``span_line_deg`` (its deflection line), ``chord_angle_deg`` (phi_2), ``chord_line_deg``,
        ``gap_mm``, ``touching`` (1 where something presses on something), ``contact_force_N``,
        ``penetration_mm``; without contact forces ``contact`` (1 where the skin passes through
        itself or a rib, else 0).
    newton_iterations
        Iterations that the step took.
    energy_Nmm
        Stored energy, N mm.
    external_work_Nmm
        Work that pressure, cables, moments and weight did along the path so far, N mm.
    negative_pivots
        Negative pivots of the tangent beyond those of the pressure unknowns; 0: stable.
    step_seconds
        Wall time of the step, s.
    requested
        Whether the user asked for this load (False: a step in between).
    fields
        Rank-local values of every finite-element function, name -> array of shape (n_local,).
    scene
        The scene that ``fields`` belong to; a `Path` sets it.
    """

    load: dict[str, float]
    measures: dict[str, float]
    newton_iterations: int
    energy_Nmm: float
    external_work_Nmm: float
    negative_pivots: int
    step_seconds: float
    requested: bool
    fields: dict[str, np.ndarray] = field(default_factory=dict, repr=False, compare=False)
    scene: Any = field(default=None, repr=False, compare=False)

    @property
    def contact(self) -> bool:
        """Whether the skin passes through itself or a rib: without contact forces, fiction."""
        return bool(self.measures.get("contact", 0.0))

    def render(self, file: str | os.PathLike) -> pathlib.Path:
        """Draw this state as a PNG picture: whole, and cut along the span. Collective."""
        from morphing_wing.pictures import render

        if not self.fields:
            raise InputError(f"state at {load_words(self.load)}: has no fields to draw, of the "
                             "states before a restart only the last one's are kept, and a formula "
                             "has none")
        return render(self.scene, self, file)


class Path(Sequence[State]):
    """The converged states of one actuation, first to last.

    Parameters
    ----------
    states
        `State` objects in the order in which they converged.
    scene
        Offers ``name``, ``fidelity``, ``dofs``, ``comm``, ``primary_load``, ``description()``,
        ``functions`` and ``show(state)``.
    converged
        Whether the last load asked for was reached.
    reason
        One sentence: why the path ended.
    seconds
        Wall time of all of it, failed steps included, s.

    Examples
    --------
    >>> path = spar.inflate(upper=[0.01, 0.02])                     # doctest: +SKIP
    >>> path.table()[["pressure_MPa", "span_angle_deg"]]            # doctest: +SKIP
    >>> path.plot("angle.png"); path[-1].render("spar.png"); path.save("run")   # doctest: +SKIP
    """

    def __init__(
        self, states: Iterable[State], scene: Any, converged: bool, reason: str, seconds: float
    ) -> None:
        self._states = list(states)
        self.scene = scene
        self.converged = bool(converged)
        self.reason = reason
        self.seconds = float(seconds)
        for state in self._states:
            state.scene = scene

    def __len__(self) -> int:
        """Return the number of converged steps."""
        return len(self._states)

    @overload
    def __getitem__(self, index: int) -> State: ...

    @overload
    def __getitem__(self, index: slice) -> Path: ...

    def __getitem__(self, index: int | slice) -> State | Path:
        """Return one state, or for a slice a path of some states."""
        if isinstance(index, slice):
            part = self._states[index]
            return Path(part, self.scene, self.converged, self.reason, self.seconds)
        return self._states[index]

    def __repr__(self) -> str:
        """Return scene, number of states and how the path ended."""
        end = "converged" if self.converged else f"stopped: {self.reason}"
        return f"<Path of a {self.scene.name}: {len(self)} states, {end}>"

    def table(self) -> pd.DataFrame:
        """Return one row a converged step.

        The columns are the loads (``pressure_MPa`` first where the scene has chambers: the upper
        ones' pressure, or the lower ones' where the upper stay empty), the measures,
        ``newton_iterations``, ``energy_Nmm``, ``external_work_Nmm``, ``negative_pivots``,
        ``step_seconds``, ``requested``, and ``contact`` (True: fiction from here, see `State`).
        """
        import pandas as pd  # a third of a second, not needed to solve

        rows = [self._row(state) for state in self._states]
        frame = pd.DataFrame(rows, index=pd.RangeIndex(len(rows), name="step"))
        if "contact" in frame:
            frame["contact"] = frame["contact"].fillna(0.0).astype(bool)
        return frame

    def _row(self, state: State) -> dict[str, Any]:
        measures = {k: v for k, v in state.measures.items() if k != "contact"}
        row = {
            **self._pressure(state), **state.load, **measures,
            "newton_iterations": int(state.newton_iterations),
            "energy_Nmm": float(state.energy_Nmm),
            "external_work_Nmm": float(state.external_work_Nmm),
            "negative_pivots": int(state.negative_pivots),
            "step_seconds": float(state.step_seconds),
            "requested": bool(state.requested),
        }
        return row | ({"contact": float(state.contact)} if "contact" in state.measures else {})

    def _pressure(self, state: State) -> dict[str, float]:
        found = state.measures | state.load  # filled chambers' pressures are measured
        rows = [row for row in ("upper_MPa", "lower_MPa") if row in found]
        if not rows:
            return {}
        inflated = [row for row in rows if any(
            (s.measures | s.load).get(row, 0.0) != 0.0 for s in self._states)]
        return {"pressure_MPa": found[(inflated or rows)[0]]}

    def summary(self) -> dict[str, Any]:
        """Return the content of ``summary.json``, see `morphing_wing.summary.summary`."""
        return summary(self)

    def plot(self, file: str | os.PathLike) -> pathlib.Path:
        """Draw angle against load, with energy and Newton iterations below. Collective."""
        from morphing_wing.curves import plot_path

        return pathlib.Path(
            on_root(self.scene.comm, lambda: plot_path(self, file)) or file)

    def render(self, file: str | os.PathLike, i: int = -1) -> pathlib.Path:
        """Draw state ``i`` as a PNG picture: whole, and cut along the span. Collective."""
        return self[i].render(file)

    def save(self, directory: str | os.PathLike) -> pathlib.Path:
        """Write figures, table, pictures and fields into a folder. Collective.

        ``summary.json`` and ``table.csv`` come first, then ``fields/path.pvd`` with one ``.vtu`` a
        state and function (ParaView), then ``angles.png``, ``shape.png`` (last state) and
        ``path.png`` (a strip of states). States before a restart have no fields to write. Each file
        appears whole or not at all. Where this machine cannot draw in 3D, a warning says what is
        missing and the rest is written.
        """
        directory = pathlib.Path(directory)
        on_root(self.scene.comm, lambda: self._save_figures(directory))
        if not self._states or not self._states[-1].fields:
            return directory
        from morphing_wing import fields, pictures

        fields.save_path(self, directory / "fields")
        with or_warned(self.scene.comm):
            pictures.render(self.scene, self[-1], directory / "shape.png")
            if sum(bool(state.fields) for state in self) > 2:
                pictures.render_strip(self, directory / "path.png")
        return directory

    def _save_figures(self, directory: pathlib.Path) -> None:
        if directory.exists() and not directory.is_dir():
            raise InputError(f"directory = {str(directory)!r}: must be a folder, not a file")
        text = json.dumps(self.summary(), indent=2, allow_nan=False) + "\n"
        write_whole(directory / "summary.json", lambda file: file.write_text(text))
        write_whole(directory / "table.csv", self.table().to_csv)
        if self._states:
            from morphing_wing.curves import plot_path

            plot_path(self, directory / "angles.png")


def load_table(directory: str | os.PathLike) -> pd.DataFrame:
    """Read back the table that `Path.save` wrote into a folder (or the ``.csv`` file itself)."""
    import pandas as pd

    file = pathlib.Path(directory)
    file = file / "table.csv" if file.is_dir() else file
    if not file.is_file():
        raise InputError(f"directory = {str(directory)!r}: must hold a saved path's table.csv")
    return pd.read_csv(file, index_col="step", float_precision="round_trip")
