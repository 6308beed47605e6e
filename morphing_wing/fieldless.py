"""What scenes share that hold no field of displacements: nothing to draw, to vibrate, to resume."""

from __future__ import annotations

import os
from collections.abc import Mapping
from typing import Any, NoReturn

from .errors import InputError


class Fieldless:
    """The other scenes' attributes, which refuse to be used.

    Attributes
    ----------
    kind
        What the scene is, in words.
    """

    functions: Mapping[str, Any] = {}
    kind = "a formula"
    fidelity: str

    def linearise(self) -> NoReturn:
        """Refuse: there is no tangent of a mesh."""
        return self.system

    @property
    def system(self) -> NoReturn:
        """There is none."""
        raise InputError(f"fidelity = {self.fidelity!r}: must be another one here, {self.kind} "
                         "without a field of displacements")

    @property
    def _where(self) -> str:
        return f'where fidelity is "{self.fidelity}"'

    def _check_resume(self, resume: str | os.PathLike | None) -> None:
        if resume is not None:
            raise InputError(f"resume = {os.fspath(resume)!r}: must be left out {self._where}; it "
                             "leaves nothing to resume")
