"""The files that come with the package to start from."""

from __future__ import annotations

from importlib import resources

__all__ = ["built_in_problems", "built_in_scenes", "built_in_studies"]


def built_in_scenes() -> dict[str, str]:
    """Return the TOML text of the built-in scenes by name."""
    return texts("scenes")


def built_in_problems() -> dict[str, str]:
    """Return the TOML text of the built-in problems of optimisation by name."""
    return texts("optimization/problems")


def built_in_studies() -> dict[str, str]:
    """Return the TOML text of the built-in studies by name."""
    return texts("studies")


def texts(room: str) -> dict[str, str]:
    """Return the texts of all TOML files in a folder of the package, by name."""
    folder = resources.files("morphing_wing") / room
    files = sorted((f for f in folder.iterdir() if f.name.endswith(".toml")), key=lambda f: f.name)
    return {f.name.removesuffix(".toml"): f.read_text(encoding="utf-8") for f in files}
