r"""A cheap model with corrections: what finer rungs have told, laid over what coarser ones tell.

With the formula :math:`m_0` (zero where a scene has none) and on each finer rung l the outputs
:math:`f_l` at points :math:`x_i`,

.. math:: m_l(x) = m_{l-1}(x) + d_l(x), \qquad d_l(x_i) = f_l(x_i) - m_{l-1}(x_i) ,

where :math:`d_l` interpolates by cubic radial basis functions with a linear polynomial, and before
there are points enough for that by linear ones with a constant.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from scipy.interpolate import RBFInterpolator
from scipy.linalg import LinAlgError

from morphing_wing.studies.formula_outputs import formula_outputs

from .problem import Problem

__all__ = ["LayeredModel", "unknown_direction"]

Predict = Callable[[np.ndarray], np.ndarray]


class LayeredModel:
    """Outputs of a problem over its variables.

    Points are in the unit cube between the variables' bounds, outputs in the problem's order.

    Attributes
    ----------
    known
        Of each output, whether any layer tells it.
    """

    def __init__(self, problem: Problem) -> None:
        self._problem = problem
        self._case = problem.start.changed({"fidelity": "instant"}) if (
            "instant" in problem.rungs) else None
        self._layers: list[Predict] = []
        self._told = np.isfinite(self._formula(self.inside(problem.first)[None])[0])
        self.known = self._told

    def inside(self, values: np.ndarray) -> np.ndarray:
        """Return variables' values as points of the unit cube."""
        low, high = self._problem.lowest, self._problem.highest
        return (np.asarray(values, dtype=float) - low) / (high - low)

    def values(self, points: np.ndarray) -> np.ndarray:
        """Return points of the unit cube as values that a drawing can have: of six digits."""
        low, high = self._problem.lowest, self._problem.highest
        exact = low + np.asarray(points) * (high - low)
        return np.clip([float(f"{value:.6g}") for value in exact], low, high)

    def __call__(self, points: np.ndarray) -> np.ndarray:
        """Return the outputs, shape (n, outputs), at points of shape (n, variables)."""
        found = np.where(self._told, self._formula(points), 0.0)
        for layer in self._layers:
            found = found + layer(points)
        return found

    def with_layer(self, points: np.ndarray, outputs: np.ndarray) -> LayeredModel:
        """Return the model corrected so that it has the outputs at the points, one or more."""
        model = LayeredModel.__new__(LayeredModel)
        model.__dict__ = self.__dict__ | {"known": np.ones_like(self.known)}
        model._layers = [*self._layers, _interpolated(points, outputs - self(points))]
        return model

    def _formula(self, points: np.ndarray) -> np.ndarray:
        names = self._problem.outputs
        found = np.full((len(points), len(names)), np.nan)
        if self._case is not None:
            low, high = self._problem.lowest, self._problem.highest
            values = low + points * (high - low)
            told = formula_outputs(self._case, {
                v.key: values[:, i] for i, v in enumerate(self._problem.variables)}, names)
            for i, name in enumerate(names):
                if name in told:
                    found[:, i] = told[name]
        return found


def unknown_direction(points: np.ndarray, centre: np.ndarray, radius: float) -> np.ndarray | None:
    """Return a unit vector along which no point near a centre tells of the slope; None: all do.

    Parameters
    ----------
    points : (n, d) array
        Where outputs are known.
    centre : (d,) array
        One of them.
    radius
        Points count up to twice as far in each coordinate, and span a direction if they reach a
        quarter as far along it.
    """
    d = len(centre)
    steps = (points - centre) / radius
    near = steps[(np.abs(steps).max(axis=1) <= 2.0) & (np.abs(steps).max(axis=1) > 0.0)]
    if len(near) == 0:
        return np.eye(d)[0]
    _, lengths, directions = np.linalg.svd(near, full_matrices=True)
    spanned = np.zeros(d)
    spanned[: len(lengths)] = lengths
    if spanned.min() >= 0.25:
        return None
    # Of the directions that are left the one nearest to an axis: one variable at a time.
    left = directions[spanned < 0.25]
    along = left.T @ left
    axis = int(np.argmax(np.diag(along)))
    return along[axis] / np.linalg.norm(along[axis])


def _interpolated(points: np.ndarray, values: np.ndarray) -> Predict:
    if len(points) > points.shape[1]:
        try:
            return RBFInterpolator(points, values, kernel="cubic", degree=1)
        except LinAlgError:  # all in one plane
            pass
    return RBFInterpolator(points, values, kernel="linear", degree=0)
