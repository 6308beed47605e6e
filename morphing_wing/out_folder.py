"""The folder that ``--out`` names, checked before anything is computed."""

from __future__ import annotations

import os
import pathlib

from morphing_wing.errors import InputError

__all__ = ["check_folder"]


def check_folder(folder: pathlib.Path) -> None:
    """Refuse a folder that cannot be written, without making it."""
    exists = next(part for part in (folder.absolute(), *folder.absolute().parents) if part.exists())
    if not exists.is_dir():
        raise InputError(f"--out {folder}: must be a folder, {exists} is a file")
    if not os.access(exists, os.W_OK | os.X_OK):
        raise InputError(f"--out {folder}: must be a folder that can be written")
