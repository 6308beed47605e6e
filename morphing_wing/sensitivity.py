"""How a scene's angles answer to its loads, by its own tangent: no second equilibrium is solved."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np
from petsc4py import PETSc

if TYPE_CHECKING:
    from .scene import Scene

__all__ = ["sensitivities"]

# Largest change in mm by which angles are differenced: squared it is far below a millionth of the
# lengths of a wing, and far above the rounding of its integrals.
_MOVE = 1e-3


def sensitivities(scene: Scene, loads: Sequence[str]) -> dict[str, dict[str, float]]:
    r"""Return the derivatives of all angles by some loads at the present converged state.

    With the residual :math:`F(u, \lambda) = 0` and the tangent :math:`K = \partial F/\partial u`,

    .. math:: K \, u' = -\partial F/\partial\lambda,
        \qquad \theta' = \frac{\theta(u + \epsilon u') - \theta(u - \epsilon u')}{2\epsilon}.

    The residual is linear in each load, so that its derivative is a difference without error. One
    factorisation, and one solution a load. Collective.

    Parameters
    ----------
    scene
        Stands in a converged state, which it keeps; loads among ``loads`` that it has not used so
        far come into use, at zero.
    loads
        Names, each once, e.g. ``upper_MPa``.

    Returns
    -------
    dict
        Of each load, of each measure that is an angle (``..._deg``), degrees per MPa, N or N mm.
        Not a number where the tangent cannot be factorised.
    """
    unused = [name for name in loads if name not in scene.loads]
    if unused:
        scene.take_into_use(unused)
    system = scene.system
    factor = scene.linearise()
    x, rate, force = (system.x.duplicate() for _ in range(3))
    system.push(x)
    found = {}
    for name in loads:
        _derivative_of_residual(scene, name, x, force)
        force.scale(-1.0)
        factor.solve(force, rate)
        found[name] = _along(scene, x, rate, sound=factor.error >= 0)
    system.pull(x)
    for vector in (x, rate, force):
        vector.destroy()
    return found


def _derivative_of_residual(scene: Scene, name: str, x: PETSc.Vec, out: PETSc.Vec) -> None:
    present = [float(constant.value) for constant in scene.loads[name]]
    without = out.duplicate()
    scene.system.residual(x, without)
    for constant, value in zip(scene.loads[name], present, strict=True):
        constant.value = value + 1.0
    scene.system.residual(x, out)
    for constant, value in zip(scene.loads[name], present, strict=True):
        constant.value = value
    out.axpy(-1.0, without)
    without.destroy()


def _along(scene: Scene, x: PETSc.Vec, rate: PETSc.Vec, sound: bool) -> dict[str, float]:
    """Return the derivative of each angle along ``rate``; the functions are left displaced."""
    fastest = rate.norm(PETSc.NormType.NORM_INFINITY)
    step = _MOVE / fastest if fastest > 0.0 else 1.0
    sound = sound and bool(np.isfinite(fastest))
    sides = []
    for sign in (1.0, -1.0):
        displaced = x.copy()
        if sound:
            displaced.axpy(sign * step, rate)
        scene.system.pull(displaced)
        sides.append(scene.angles())
        displaced.destroy()
    ahead, behind = sides
    return {name: (ahead[name] - behind[name]) / (2.0 * step) if sound else np.nan
            for name in ahead}
