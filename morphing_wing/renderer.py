"""Find out how this machine draws in 3D without a display, before a picture needs it."""

from __future__ import annotations

import os
import subprocess
import sys
import warnings
from collections.abc import Iterator
from contextlib import contextmanager
from functools import lru_cache
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from mpi4py import MPI

__all__ = ["NoRenderer", "choose_renderer", "or_warned"]

# VTK crashes the whole process where a library of OpenGL is missing or has no driver, so a child
# process tries first: hours of solving must not end in a crash at the first picture.
_TRIAL = """
import vtkmodules.vtkRenderingOpenGL2
from vtkmodules.vtkRenderingCore import vtkRenderer, vtkRenderWindow, vtkWindowToImageFilter
window = vtkRenderWindow()
window.SetOffScreenRendering(1)
window.SetSize(8, 8)
renderer = vtkRenderer()
renderer.SetBackground(0.0, 1.0, 0.0)
window.AddRenderer(renderer)
window.Render()
image = vtkWindowToImageFilter()
image.SetInput(window)
image.Update()
green = image.GetOutput().GetScalarComponentAsDouble(4, 4, 0, 1)
raise SystemExit(0 if green > 200 else 1)
"""
_VARIABLE = "VTK_DEFAULT_OPENGL_WINDOW"


class NoRenderer(RuntimeError):
    """Nothing here draws in 3D; the message says what to install."""


@contextmanager
def or_warned(comm: MPI.Comm) -> Iterator[None]:
    """Where this machine cannot draw in 3D, warn of it on rank 0 and go on."""
    try:
        yield
    except NoRenderer as missing:
        if comm.rank == 0:
            warnings.warn(f"no 3D pictures: {missing}", stacklevel=4)


@lru_cache(maxsize=1)
def choose_renderer() -> str:
    """Choose the first of EGL, OSMesa and VTK's own choice (X11, a window system) that works.

    EGL and OSMesa need neither a display nor a graphics card. The choice is made known to VTK
    through the environment, so call this before the first plotter. A choice that the user made
    there stands.

    Returns
    -------
    Name of VTK's window class, or "" for VTK's own choice.

    Raises
    ------
    NoRenderer
        Where none works.
    """
    chosen = os.environ.get(_VARIABLE)
    candidates = [chosen] if chosen else ["vtkEGLRenderWindow", "vtkOSOpenGLRenderWindow", ""]
    if sys.platform != "linux" and not chosen:
        candidates = [""]
    for candidate in candidates:
        if _works(candidate):
            if candidate:
                os.environ[_VARIABLE] = candidate
            return candidate
    raise NoRenderer(
        "VTK finds neither EGL nor OSMesa nor a display to draw with; "
        "on Debian `apt install libegl1 libgl1-mesa-dri` brings EGL with software rendering"
    )


def _works(window: str) -> bool:
    # Without the variables of mpirun: the child is no MPI process.
    environment = {
        name: value for name, value in os.environ.items()
        if not name.startswith(("OMPI_", "PMIX_", "PMI_"))
    }
    environment.pop(_VARIABLE, None)
    if window:
        environment[_VARIABLE] = window
    try:
        trial = subprocess.run(
            [sys.executable, "-c", _TRIAL], env=environment, capture_output=True, timeout=60,
            check=False)
    except (OSError, subprocess.TimeoutExpired):
        return False
    return trial.returncode == 0
