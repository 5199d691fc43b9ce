"""Finding and reading scene files."""

from __future__ import annotations

import os
import tomllib
from importlib import resources
from typing import Any

from hystrip.errors import InputError
from hystrip.scene.errors import SceneError, nearest
from hystrip.scene.model import Scene

_LARGEST = 1 << 20  # bytes; a scene has a few hundred, and /dev/zero has no end


def _builtin_names() -> tuple[str, ...]:
    folder = resources.files("hystrip") / "scenes"
    return tuple(sorted(each.name[: -len(".toml")] for each in folder.iterdir() if each.name.endswith(".toml")))


BUILTIN = _builtin_names()
"""Names of the scenes that come with hystrip."""


def load_scene(source: str | os.PathLike[str]) -> Scene:
    """Read a scene.

    Parameters
    ----------
    source : path of a TOML file, or the name of a built-in scene (see :data:`BUILTIN`)

    Raises
    ------
    SceneError : the file cannot be read, or its content not be used; names key, value and what is allowed
    MissingExtra : msgspec, or Pint where a unit is written, is not installed
    """
    path = os.fspath(source)
    if path in BUILTIN:
        text = (resources.files("hystrip") / "scenes" / f"{path}.toml").read_text(encoding="utf-8")
        return parse_scene(text, name=path, source=path)
    name = os.path.splitext(os.path.basename(path))[0]
    return parse_scene(_read(path), name=name or "scene", source=path)


def parse_scene(text: str, name: str = "scene", source: str = "") -> Scene:
    """Build a scene from TOML text; `source` is named in errors. Raises as :func:`load_scene`."""
    from hystrip.scene.validate import validated

    try:
        raw = tomllib.loads(text)
    except tomllib.TOMLDecodeError as error:
        raise SceneError("", None, "", f"not valid TOML: {error}", source) from None
    except RecursionError:
        raise SceneError("", None, "", "not valid TOML: nested too deeply", source) from None
    try:
        return _assembled(validated(raw), text, name, source)
    except InputError as error:
        problem = getattr(error, "problem", "")
        raise SceneError(error.field, error.value, error.allowed, problem, source) from None


def _read(path: str) -> str:
    try:
        with open(path, "rb") as file:
            data = file.read(_LARGEST + 1)
    except FileNotFoundError:
        near = nearest(path, BUILTIN)
        hint = f" (did you mean {near!r}?)" if near else ""
        allowed = f"the path of a TOML file, or a built-in scene: {', '.join(BUILTIN)}"
        raise SceneError("", path, allowed, f"no such file{hint}", path) from None
    except IsADirectoryError:
        raise SceneError("", path, "the path of a TOML file", "this is a folder", path) from None
    except (OSError, ValueError) as error:
        raise SceneError("", path, "a file that can be read", f"cannot be read ({error})", path) from None
    if len(data) > _LARGEST:
        raise SceneError("", path, "a TOML file of at most 1 MiB", "too large for a scene", path)
    try:
        return data.decode("utf-8-sig")
    except UnicodeDecodeError as error:
        problem = f"not UTF-8 text (byte {error.start})"
        raise SceneError("", path, "a TOML file, which is UTF-8 text", problem, path) from None


def _assembled(values: dict[str, Any], text: str, name: str, source: str) -> Scene:
    """The library's own objects check signs, orders and bounds; their errors get the place in the file added."""

    _one_of(values, "", "pressure", "penetration")
    material = dict(values.pop("material"))
    model = material.pop("model")
    adhesion = values.pop("adhesion") or {"gamma": 0.0, "p_0": None, "delta_0": None}
    levels = values.pop("levels")
    if adhesion["delta_0"] is not None:
        _one_of(adhesion, "adhesion", "gamma", "p_0")
    return Scene(
        name=name,
        text=text,
        source=source,
        material=_made(_MODELS[model], material, "material"),
        adhesion=_made("Dugdale", {key: each for key, each in adhesion.items() if each is not None}, "adhesion"),
        levels=tuple(_made("Level", level, f"levels[{index}]") for index, level in enumerate(levels)),
        **values,
    )


_MODELS = {"standard_linear_solid": "StandardLinearSolid"}


def _made(kind: str, arguments: dict[str, Any], path: str) -> Any:
    import hystrip

    try:
        return getattr(hystrip, kind)(**arguments)
    except InputError as error:
        # The library says "level.h", the file "levels[1].h".
        field = path + error.field[len(error.field.partition(".")[0]) :]
        raise SceneError(field, error.value, error.allowed) from None


def _one_of(values: dict[str, Any], path: str, first: str, second: str) -> None:
    given = [name for name in (first, second) if values[name] is not None]
    if len(given) != 1:
        place = f"[{path}]" if path else "the scene"
        problem = f"both {first} and {second} are given" if given else f"neither {first} nor {second} is given"
        value = {name: values[name] for name in given}
        raise SceneError(path, value, f"exactly one of {first} and {second} in {place}", problem)
