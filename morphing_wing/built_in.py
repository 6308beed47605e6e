"""The files that come with the package to start from."""

from __future__ import annotations

import pathlib
from collections.abc import Mapping
from importlib import resources

from morphing_wing.errors import InputError

__all__ = ["built_in_problems", "built_in_scenes", "built_in_studies", "or_hint", "shown"]


def built_in_scenes() -> dict[str, str]:
    """Return the TOML text of the built-in scenes by name."""
    return texts("scenes")


def built_in_problems() -> dict[str, str]:
    """Return the TOML text of the built-in problems of optimisation by name."""
    return texts("optimization/problems")


def built_in_studies() -> dict[str, str]:
    """Return the TOML text of the built-in studies by name."""
    return texts("studies")


def shown(texts: Mapping[str, str], what: str, name: str | None = None) -> str:
    """Return a line a file, its name and what its first comment says; of a name, the whole text.

    Raises
    ------
    InputError
        ``scene 'spa': must be one of rib-prototype, ...``.
    """
    if name is None:
        width = max(map(len, texts))
        return "".join(f"{each:{width}}  {text.splitlines()[0].lstrip('# ')}\n"
                       for each, text in texts.items())
    if name not in texts:
        raise InputError(f"{what} {name!r}: must be one of {', '.join(texts)}")
    return texts[name]


def or_hint(file: pathlib.Path, texts: Mapping[str, str], command: str) -> pathlib.Path:
    """Return a file's name, or say which command writes it where a built-in one is called so.

    Raises
    ------
    InputError
        If there is no such file, but a built-in one of its name.
    """
    if not file.exists() and file.stem in texts:
        raise InputError(f"{file}: no such file, 'morphing-wing {command} {file.stem} > "
                         f"{file.stem}.toml' writes one")
    return file


def texts(room: str) -> dict[str, str]:
    """Return the texts of all TOML files in a folder of the package, by name."""
    folder = resources.files("morphing_wing") / room
    files = sorted((f for f in folder.iterdir() if f.name.endswith(".toml")), key=lambda f: f.name)
    return {f.name.removesuffix(".toml"): f.read_text(encoding="utf-8") for f in files}
