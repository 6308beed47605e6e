"""Natural frequencies and modes about a loaded state, and with them how near it is to buckling."""

from __future__ import annotations

import os
import pathlib
from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
import pandas as pd
from mpi4py import MPI
from petsc4py import PETSc
from slepc4py import SLEPc

from .errors import InputError, is_count, require
from .path import State
from .renderer import or_warned
from .root import on_root, write_whole

if TYPE_CHECKING:
    from .inertia import InertiaCholesky
    from .scene import Scene
    from .system import EquilibriumSystem

__all__ = ["Mode", "Modes", "modes"]

_PER_SECOND_SQUARED = 1000.0  # one N/mm per kg


@dataclass(frozen=True)
class Mode:
    """One mode of vibration about a state.

    Attributes
    ----------
    eigenvalue
        Square of the circular frequency in 1/s^2; negative: the state is unstable, and the mode is
        the way in which it leaves.
    fields
        Rank-local values of each kept function by name; of all components of displacements the
        largest is 1 mm.
    """

    eigenvalue: float
    fields: dict[str, np.ndarray]

    @property
    def frequency_Hz(self) -> float:
        """Natural frequency in Hz; minus the rate of growth over 2 pi where it is unstable."""
        return float(np.sign(self.eigenvalue) * np.sqrt(abs(self.eigenvalue)) / (2.0 * np.pi))

    def words(self) -> str:
        """Return the frequency as one reads it."""
        if self.eigenvalue >= 0.0:
            return f"{self.frequency_Hz:.3g} Hz"
        return f"unstable, growing e-fold in {1e3 / np.sqrt(-self.eigenvalue):.3g} ms"


class Modes(Sequence):
    """The modes of a scene about one of its states, those nearest to zero frequency first.

    Attributes
    ----------
    scene, state
        Of what, and about which state.
    """

    def __init__(self, scene: Scene, state: State, found: Sequence[Mode]) -> None:
        self.scene, self.state, self._found = scene, state, tuple(found)

    def __len__(self) -> int:
        """Return the number of modes."""
        return len(self._found)

    def __getitem__(self, i: int) -> Mode:
        """Return mode ``i``."""
        return self._found[i]

    def table(self) -> pd.DataFrame:
        """Return ``eigenvalue`` (1/s^2) and ``frequency_Hz`` of each mode."""
        rows = [{"eigenvalue": mode.eigenvalue, "frequency_Hz": mode.frequency_Hz}
                for mode in self]
        index = pd.RangeIndex(1, len(rows) + 1, name="mode")
        return pd.DataFrame(rows, index=index, columns=["eigenvalue", "frequency_Hz"])

    def render(self, file: str | os.PathLike, i: int = 0) -> pathlib.Path:
        """Draw mode ``i`` on the deformed structure as a PNG picture. Collective."""
        from .pictures import render_mode

        return render_mode(self, i, file)

    def save(self, directory: str | os.PathLike) -> pathlib.Path:
        """Write ``table.csv``, ``mode_1.png`` ... and the modes for ParaView. Collective.

        ``fields/modes.pvd`` has a time step a mode, with the state's ``displacement`` and the
        vector ``mode`` (largest component 1).
        """
        from .fields import save_modes

        directory = pathlib.Path(directory)
        on_root(self.scene.comm, lambda: self._save_table(directory))
        save_modes(self, directory / "fields")
        with or_warned(self.scene.comm):
            for i in range(len(self)):
                self.render(directory / f"mode_{i + 1}.png", i)
        return directory

    def _save_table(self, directory: pathlib.Path) -> None:
        for old in directory.glob("mode_*.png"):  # of an earlier run, which may have had more
            old.unlink()
        write_whole(directory / "table.csv", self.table().to_csv)


def modes(scene: Scene, n: int = 3) -> Modes:
    r"""Return the modes of vibration about the present converged state. Collective.

    .. math:: K \, x = \omega^2 M \, x

    with the tangent :math:`K` of the loaded state and the lumped mass :math:`M` of elastomer and
    bars; air has none. By SLEPc, shifted to zero and inverted with one factor of K: the modes
    nearest to zero. Of a half model those that are symmetric. Where glue has just been damaged
    further, each of its points softens or unloads, by its last bit. SLEPc's options are open under
    the scene's prefix and ``modes_``.

    Parameters
    ----------
    scene
        Stands in a converged state, which it keeps.
    n
        How many at most.

    Raises
    ------
    InputError
        If ``n`` is not a whole number of at least 1, the scene has not been led to a load, or its
        tangent cannot be factorised.
    """
    require(is_count(n), "n", n, "", "a whole number of at least 1")
    factor = scene.linearise()
    if factor.error < 0:
        raise InputError(f"{scene.name}: its tangent must be regular; MUMPS error {factor.error}")
    return Modes(scene, scene.present(), _solved(scene, factor, n))


class _Inverse:
    """A PETSc preconditioner that solves with a factor that is there."""

    def __init__(self, factor: InertiaCholesky) -> None:
        self._factor = factor

    def apply(self, pc: PETSc.PC, b: PETSc.Vec, y: PETSc.Vec) -> None:
        self._factor.solve(b, y)


def _solved(scene: Scene, factor: InertiaCholesky, n: int) -> list[Mode]:
    system = scene.system
    mass = np.where(system.free, np.concatenate(scene.masses()), 0.0)
    masses = _diagonal(system, mass)
    solver = SLEPc.EPS().create(scene.comm)
    solver.setOptionsPrefix(scene.newton.prefix + "modes_")
    solver.setOperators(system.matrix, masses)
    solver.setProblemType(SLEPc.EPS.ProblemType.GHEP)
    solver.setWhichEigenpairs(SLEPc.EPS.Which.TARGET_MAGNITUDE)
    solver.setTarget(0.0)
    solver.setDimensions(n)
    transformation = solver.getST()
    transformation.setType("sinvert")
    inner = transformation.getKSP()
    inner.setType("preonly")
    inner.getPC().setType("python")
    inner.getPC().setPythonContext(_Inverse(factor))
    solver.setFromOptions()
    solver.solve()
    del transformation, inner  # destroyed with the solver, on all ranks at once
    before = scene.unknowns()
    for block in system.blocks:
        block.function.x.array[:] = 0.0  # what is held stays at rest
    vector, found = system.x.duplicate(), []
    for i in range(min(n, solver.getConverged())):
        value = solver.getEigenpair(i, vector).real
        sizes = np.abs(vector.getArray(readonly=True)[mass > 0.0])
        vector.scale(1.0 / scene.comm.allreduce(sizes.max(initial=0.0), op=MPI.MAX))
        system.pull(vector)
        fields = {b.function.name: b.function.x.array.copy() for b in scene.kept_blocks}
        found.append(Mode(_PER_SECOND_SQUARED * value, fields))
    scene.set_unknowns(before)
    for part in (vector, masses, solver):
        part.destroy()
    return sorted(found, key=lambda mode: abs(mode.eigenvalue))


def _diagonal(system: EquilibriumSystem, values: np.ndarray) -> PETSc.Mat:
    diagonal = system.x.duplicate()
    diagonal.setArray(values)
    matrix = PETSc.Mat().createAIJ(system.matrix.getSizes(), nnz=1, comm=system.comm)
    matrix.setUp()
    matrix.setDiagonal(diagonal)
    matrix.assemble()
    diagonal.destroy()
    return matrix
