r"""Derivatives by the complex step: exact to rounding, without a difference of near numbers.

.. math:: \frac{\partial f}{\partial q} = \frac{1}{\epsilon} \,
    \mathrm{Im}\, f(q + \mathrm{i} \epsilon), \qquad \epsilon = 10^{-30}

(Squire and Trapp 1998), for functions written with arithmetic and analytic functions alone.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping

import numpy as np

__all__ = ["complex_step"]

STEP = 1e-30


def complex_step(
    function: Callable[[Mapping[str, np.ndarray]], np.ndarray],
    values: Mapping[str, np.ndarray],
    name: str,
) -> np.ndarray:
    """Return the derivative of a function of named values with respect to one of them.

    Parameters
    ----------
    function
        Takes the values, one of them complex, and works on each element by itself.
    values
        Arrays of shapes that broadcast.
    name
        Key of the value to derive by.

    Examples
    --------
    >>> complex_step(lambda v: v["a"] ** 2 * v["b"], {"a": np.array([1.0, 3.0]), "b": 2.0}, "a")
    array([ 4., 12.])
    """
    return np.imag(function({**values, name: values[name] + 1j * STEP})) / STEP
