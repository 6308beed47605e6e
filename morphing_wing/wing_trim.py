"""A wing's inverse problem: which loads give wanted angles."""

from __future__ import annotations

import os
from collections.abc import Callable

from .chambers import ROWS
from .elastomer import Elastomer
from .errors import is_count, is_number, require
from .geometry.wing import WingGeometry
from .path import State
from .scene import Scene
from .steering import wing_steerings
from .trim import Trim, trim

__all__ = ["TrimmedWing"]


class TrimmedWing(Scene):
    """What of a wing finds its own loads.

    Attributes
    ----------
    geometry, body
        The wing's dimensions and its elastomer, set by the subclass.
    """

    geometry: WingGeometry
    body: Elastomer

    def trim(
        self,
        span: float | None = None,
        chord: float | None = None,
        tolerance: float = 1e-4,
        max_pressure: float = 0.06,
        max_cable: float = 5.0,
        max_iterations: int = 25,
        on_step: Callable[[State], None] | None = None,
        on_cut: Callable[..., None] | None = None,
        restart: str | os.PathLike | None = None,
        resume: str | os.PathLike | None = None,
    ) -> Trim:
        """Find the pressure and the tension at which the wing has wanted angles, and go there.

        Parameters
        ----------
        span, chord
            Wanted ``span_angle_deg`` (phi_1) and ``chord_angle_deg`` (phi_2) in degrees. None: not
            wanted, and the load that steers it stays as it is. ``span`` is steered by one row of
            chambers, the other one's pressure is let off: positive by the upper, negative by the
            lower, unless the cables alone overshoot it. ``chord`` is steered by the cables.
        tolerance
            Largest error of each in degrees.
        max_pressure, max_cable
            Limits in MPa of each row's pressure, and in N of the tension in each cable.
        max_iterations
            How many loads are tried.
        on_step, on_cut, restart
            See `Scene.follow`.
        resume
            Folder or file of a trim that was stopped: go on from the last step in it.

        Returns
        -------
        Trim
            Where the angles cannot be reached, ``converged`` is False, the wing stands in the
            nearest state that was found, and ``reason`` says what was in the way.

        Raises
        ------
        InputError
            If neither angle is wanted, one is no angle or on the side to which no cable pulls, or
            a limit is not positive.
        """
        pressed = resume is not None or any(self._load[row] != 0.0 for row in ROWS)
        steerings = wing_steerings(
            self.geometry, span, chord, max_pressure, max_cable, pressed)
        require(is_number(tolerance) and tolerance > 0.0, "tolerance", tolerance, "deg",
                "greater than 0 deg")
        require(is_count(max_iterations), "max_iterations", max_iterations, "",
                "a whole number of at least 1")
        built = {} if self.body.prestretch is None else {"prestretch_part": 1.0}
        return trim(self, steerings, self._load | built, tolerance, max_iterations, on_step,
                    on_cut, restart, resume)
