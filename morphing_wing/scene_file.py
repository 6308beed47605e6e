"""Scene files: TOML in which every dimensional value is text with its unit.

A file names a scene (spar, rib or wing) and gives its geometry, materials, loads and fidelity::

    scene = "spar"
    fidelity = "standard"

    [geometry]
    preset = "validation"
    n_cells = 4
    top_thickness = "1.2 mm"

    [loads]
    upper = { to = "20 kPa", points = 5 }

What cannot be computed with is refused in one sentence that names file, key and value, before
anything is built. This module loads no DOLFINx; `SceneFile.build` does.
"""

from __future__ import annotations

import dataclasses
import importlib
import pathlib
import tomllib
from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any

from morphing_wing.errors import InputError, one_line
from morphing_wing.geometry.rib import RibGeometry
from morphing_wing.geometry.spar import SparGeometry
from morphing_wing.geometry.wing import WingGeometry
from morphing_wing.ladder import AUTO, pick
from morphing_wing.materials import DRAGON_SKIN_30, RESIN, Adhesive, Elastic, Yeoh
from morphing_wing.scene_keys import Keys, RibKeys, check_keys, one_of
from morphing_wing.spar_rungs import pick_of

__all__ = [
    "SceneFile", "check_scene", "located", "parse_scene", "parse_table", "read_scene", "read_table",
]

DEFAULT_FIDELITY = {"spar": "standard", "rib": "draft", "wing": "draft"}

GEOMETRIES = {"spar": SparGeometry, "rib": RibGeometry, "wing": WingGeometry}


@dataclasses.dataclass(frozen=True)
class SceneFile:
    """A scene as its file describes it, checked, in the package's units.

    Parameters
    ----------
    scene
        ``"spar"``, ``"rib"`` or ``"wing"``.
    geometry
        Its geometry, mm and degrees.
    materials
        Keyword arguments of the scene: ``material``, or ``elastomer`` and ``resin``, of a wing
        ``adhesive`` and ``contact`` too.
    loads
        Keyword arguments of its load method: ``upper`` and ``lower`` in MPa, ``cable`` in N,
        ``torque`` in N mm, each a tuple of one value or of one value a load step.
    fidelity
        Rung of the ladder of fidelities, or "auto".
    tolerance
        Relative error that "auto" may have.
    """

    scene: str
    geometry: Any
    materials: dict[str, Any]
    loads: dict[str, tuple[float, ...]]
    fidelity: str
    tolerance: float | None = None

    def build(self, comm: Any = None, limits: bool = True) -> Any:
        """Build the scene on all ranks of ``comm`` (None: all).

        Its states tell of its limits, see `morphing_wing.limits.Limits`, but for ``limits=False``.
        """
        module = importlib.import_module(f"morphing_wing.{self.scene}")  # loads DOLFINx
        scene = getattr(module, self.scene.capitalize())
        built = scene(self.geometry, **self.materials, fidelity=self.fidelity, comm=comm,
                      tolerance=self.tolerance)
        if limits:
            from morphing_wing.limits import Limits

            built.watch.append(Limits(built))
        return built

    def run(self, scene: Any, **options: Any) -> Any:
        """Lead the built scene through the loads; ``options`` as its load method has."""
        method = {"spar": "inflate", "wing": "actuate"}.get(self.scene)
        method = method or ("bend" if "torque" in self.loads else "pull")
        return getattr(scene, method)(**self.loads, **options)


def read_scene(file: str | pathlib.Path, fidelity: str | None = None) -> SceneFile:
    """Read and check a scene file.

    Parameters
    ----------
    file
        TOML file.
    fidelity
        Takes the place of the file's own, where given.

    Raises
    ------
    InputError
        ``wing.toml: loads.upper = '20 mm': must be a pressure as text with its unit, such as ...``.
    """
    return check_scene(read_table(file), str(file), fidelity)


def read_table(file: str | pathlib.Path) -> dict[str, Any]:
    """Read a TOML file without checking what is in it."""
    try:
        text = pathlib.Path(file).read_text(encoding="utf-8")
    except UnicodeDecodeError:
        raise InputError(f"{file}: must be a text file in UTF-8") from None
    except (OSError, ValueError) as problem:
        why = getattr(problem, "strerror", None) or "no valid file name"
        raise InputError(f"{file}: cannot be read, {why.lower()}") from None
    return parse_table(text, str(file))


def parse_table(text: str, name: str) -> dict[str, Any]:
    """Return what TOML text holds; ``name`` stands for the file in error messages."""
    try:
        return tomllib.loads(text)
    except (tomllib.TOMLDecodeError, RecursionError) as problem:
        raise InputError(f"{name}: must be valid TOML: {one_line(problem)}") from None


def parse_scene(text: str, name: str, fidelity: str | None = None) -> SceneFile:
    """Check a scene given as TOML text; ``name`` stands for the file in error messages."""
    return check_scene(parse_table(text, name), name, fidelity)


def check_scene(table: dict[str, Any], name: str, fidelity: str | None = None) -> SceneFile:
    """Check a scene given as the table that its TOML holds; see `parse_scene`."""
    with located(name):
        keys = check_keys(table)
        tolerance = None if fidelity not in (None, AUTO) else keys.tolerance
        fidelity = fidelity or keys.fidelity or DEFAULT_FIDELITY[keys.scene]
        geometry = geometry_of(keys.scene, keys.geometry)
        if keys.scene == "spar":
            pick_of(geometry, fidelity, tolerance)
        else:
            pick(keys.scene, fidelity, tolerance, geometry.n_cells)
        materials = materials_of(keys, geometry)
        loads = loads_of(keys, geometry)
        return SceneFile(keys.scene, geometry, materials, loads, fidelity, tolerance)


def geometry_of(scene: str, keys: Keys) -> Any:
    """Return what the preset or the class's defaults give, changed as the file says."""
    shape, given = GEOMETRIES[scene], keys.given()
    preset = given.pop("preset", None)
    base = getattr(shape, preset)() if preset else None
    if isinstance(given.get("rib"), RibKeys):
        given["rib"] = rib_of_wing(given["rib"], (base or WingGeometry()).rib)
    with located("geometry", type(keys)):
        if base is not None:
            return dataclasses.replace(base, **given)
        for field in dataclasses.fields(shape):
            has_default = (field.default, field.default_factory) != (dataclasses.MISSING,) * 2
            if field.name not in given and not has_default:
                raise InputError(f"{field.name}: is missing, must be given where preset is not")
        return shape(**given)


def rib_of_wing(keys: RibKeys, base: RibGeometry) -> RibGeometry:
    """Return a wing's ribs: those of their own preset, else of the wing's, changed."""
    given = keys.given()
    preset = given.pop("preset", None)
    base = getattr(RibGeometry, preset)() if preset else base
    with located("geometry.rib", RibKeys):
        return dataclasses.replace(base, **given)


def materials_of(keys: Any, geometry: Any) -> dict[str, Any]:
    """Return materials by the names under which the scene takes them; by default the paper's."""
    materials: dict[str, Any] = {}
    if "elastomer" in type(keys).model_fields:
        with located("elastomer", type(keys.elastomer)):
            given = {"coefficients": DRAGON_SKIN_30.coefficients} | keys.elastomer.given()
            materials["elastomer"] = Yeoh(**given)
    if "resin" in type(keys).model_fields:
        with located("resin", type(keys.resin)):
            materials["resin"] = Elastic(**({"E": RESIN.E, "nu": RESIN.nu} | keys.resin.given()))
    if keys.scene == "wing":
        materials["contact"] = keys.contact
        if keys.adhesive is not None:
            if geometry.rib is None:
                raise InputError('adhesive: must be left out where rib is "none"')
            twice = (keys.adhesive.stiffness, keys.geometry.glue_stiffness)
            if None not in twice:
                raise InputError("adhesive.stiffness and geometry.glue_stiffness are both given: "
                                 "must be one of them")
            given = {"stiffness": geometry.glue_stiffness} | keys.adhesive.given()
            with located("adhesive", type(keys.adhesive)):
                materials["adhesive"] = Adhesive(**given)
    if len(materials) == 1:
        return {"material": next(iter(materials.values()))}
    return materials


def loads_of(keys: Any, geometry: Any) -> dict[str, tuple[float, ...]]:
    """Return the scene's loads, checked against each other."""
    loads = keys.loads.given()
    with located("loads"):
        names = [name for name in type(keys.loads).model_fields if name != "guide"]
        steps = {name: len(loads[name]) for name in names if name in loads}
        if not steps:
            raise InputError(f"is empty, must have {one_of(names)}")
        if len(set(steps.values()) - {1}) > 1:
            counts = ", ".join(f"{name} has {count}" for name, count in steps.items())
            raise InputError(f"numbers of steps differ ({counts}): must be equal, or 1")
        if {"torque", "cable"} <= set(steps):
            raise InputError("torque and cable are both given: must be one of them")
        if "guide" in loads and "cable" not in steps:
            raise InputError("guide is given without cable: must stand with a cable")
        if "guide" in loads and not any(loads["guide"]):
            raise InputError("guide is the tail itself: must have a length other than 0 mm")
        if "cable" in steps and keys.scene == "wing" and geometry.rib is None:
            raise InputError("cable pulls at ribs: must be left out where rib is \"none\"")
    return loads


@contextmanager
def located(where: str, model: type[Keys] | None = None) -> Iterator[None]:
    """Prefix every refusal inside: ``where.key`` if it begins with a key, else ``where:``."""
    try:
        yield
    except InputError as problem:
        said = str(problem)
        is_key = model is not None and said.split(" ")[0].rstrip(":") in model.model_fields
        raise InputError(f"{where}{'.' if is_key else ': '}{said}") from None
