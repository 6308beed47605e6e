"""How a scene answers to its loads, by its own tangent: no second equilibrium is solved."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np
from petsc4py import PETSc

if TYPE_CHECKING:
    from .inertia import InertiaCholesky
    from .scene import Scene

__all__ = ["compliance", "sensitivities"]

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
        Of each load, of each measure that is an angle (``..._deg``), degrees per MPa, N, N mm or
        mm^3. Not a number where the tangent cannot be factorised.
    """
    unused = [name for name in loads if name not in scene.loads]
    if unused:
        scene.take_into_use(unused)
    factor = scene.linearise()
    x = scene.system.x.duplicate()
    scene.system.push(x)
    forces = _unit_forces(scene, x, loads)
    rates = _rates(factor, forces)
    found = {name: _along(scene, x, rate, sound=factor.error >= 0)
             for name, rate in zip(loads, rates, strict=True)}
    scene.system.pull(x)
    for vector in (x, *forces, *rates):
        vector.destroy()
    return found


def compliance(scene: Scene, factor: InertiaCholesky, loads: Sequence[str]) -> np.ndarray:
    r"""Return the derivative of each load's displacement by each load.

    The potential holds a load as :math:`-\lambda q(u)`, so that
    :math:`\partial q/\partial u = -\partial F/\partial\lambda` and

    .. math:: \frac{\partial q_i}{\partial\lambda_j}
        = \frac{\partial F}{\partial\lambda_i} \cdot K^{-1} \frac{\partial F}{\partial\lambda_j}.

    One solution a load. Collective.

    Parameters
    ----------
    scene
        Stands in a converged state.
    factor
        Of its tangent there.
    loads
        Names of n loads in use.

    Returns
    -------
    (n, n) array
        Of the modelled part; not a number where the tangent could not be factorised.
    """
    if factor.error < 0:
        return np.full((len(loads), len(loads)), np.nan)
    x = scene.system.x.duplicate()
    scene.system.push(x)
    forces = _unit_forces(scene, x, loads)
    rates = _rates(factor, forces)
    found = np.array([[force.dot(rate) for rate in rates] for force in forces])
    for vector in (x, *forces, *rates):
        vector.destroy()
    return found.reshape(len(loads), len(loads))


def _unit_forces(scene: Scene, x: PETSc.Vec, loads: Sequence[str]) -> list[PETSc.Vec]:
    """Return of each load the forces of its unit, minus the derivative of the residual by it."""
    without = x.duplicate()
    scene.system.residual(x, without)
    forces = []
    for name in loads:
        force = without.copy()
        with_more = x.duplicate()
        present = [float(constant.value) for constant in scene.loads[name]]
        for constant, value in zip(scene.loads[name], present, strict=True):
            constant.value = value + 1.0
        scene.system.residual(x, with_more)
        for constant, value in zip(scene.loads[name], present, strict=True):
            constant.value = value
        force.axpy(-1.0, with_more)
        with_more.destroy()
        forces.append(force)
    without.destroy()
    return forces


def _rates(factor: InertiaCholesky, forces: Sequence[PETSc.Vec]) -> list[PETSc.Vec]:
    rates = [force.duplicate() for force in forces]
    for force, rate in zip(forces, rates, strict=True):
        factor.solve(force, rate)
    return rates


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
