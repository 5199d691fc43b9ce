"""Writing tables into the text of a scene: the rest of the file, its comments too, stays as it is."""

import json
import os
import re
from collections.abc import Mapping, Sequence
from typing import Any

from .errors import SceneError
from .load import parse_scene
from .toml import parse_toml

#: of what is measured more digits than these are noise
_DIGITS = 6
_IN_A_LINE = 5
_REPLACEABLE = "a table under its own header, or a key on a line of its own, to be replaced"
_HEADER = re.compile(r"\s*\[\[?\s*(?P<name>[^\]\s]+)\s*\]?\]")


def with_material(text: str, tables: Mapping[str, Mapping[str, Any]], comment: str = "") -> str:
    """The scene with another ``[material]`` and, by their names, other tables below it. Raises SceneError if what comes out is
    no scene."""
    written = [_table(f"[{name}]", table, comment if name == "material" else "") for name, table in tables.items()]
    return _checked(text, _replaced(text, "material", written), "material")


def with_levels(
    text: str, levels: Sequence[Mapping[str, Any]], comment: str = "", *, folder: Any = "", allow_solver: bool = False
) -> str:
    """The scene with other ``[[levels]]``, to stand in ``folder``. Raises SceneError if what comes out is no scene, and
    for a solver that the scene names unless it may be run."""
    tables = [_table("[[levels]]", level, comment if number == 0 else "") for number, level in enumerate(levels)]
    new = _replaced(text, "levels", tables)
    return _checked(text, new, "levels", source=os.path.join(folder, "scene"), allow_solver=allow_solver)


def with_solver_seen_from(folder: Any, text: str, source: Any) -> str:
    """The scene ``text`` of the file ``source`` with its solver's path, given from that file on, as seen from ``folder``."""
    material = parse_toml(text).get("material")
    solver = material.get("solver") if isinstance(material, dict) else None
    if not isinstance(solver, str) or os.path.isabs(solver):
        return text
    lines = text.splitlines()
    written = [number for number, line in enumerate(lines) if re.match(r"\s*solver\s*=", line)]
    if len(written) != 1:
        raise SceneError("material.solver", solver, "on a line of its own, so that its path can be replaced")
    seen = os.path.relpath(os.path.join(os.path.dirname(os.fspath(source)), solver), folder)
    lines[written[0]] = f"solver = {_value(seen)}"
    return "\n".join(lines) + "\n"


def with_settings(text: str, values: Mapping[str, Any]) -> str:
    """The scene with other values of keys that stand above its tables: text, or numbers with all their digits."""
    for key, value in values.items():
        lines = text.splitlines()
        top = next((number for number, line in enumerate(lines) if _HEADER.match(line)), len(lines))
        old = [number for number, line in enumerate(lines[:top]) if re.match(rf"\s*{key}\s*=", line)]
        new = f"{key} = {_value(value) if isinstance(value, str) else repr(value)}"
        lines = [*lines[: old[0]], new, *lines[old[0] + 1 :]] if old else [new, *lines]
        text = _same_but(text, "\n".join(lines) + "\n", key)
    return text


def _table(header: str, table: Mapping[str, Any], comment: str) -> str:
    lines = [f"# {line}" for line in _encodable(comment).splitlines()]
    return "\n".join([*lines, header, *(f"{key} = {_value(value)}" for key, value in table.items())])


def _value(value: Any) -> str:
    if isinstance(value, str):
        return json.dumps(_encodable(value), ensure_ascii=False).replace("\x7f", "\\u007f")
    if isinstance(value, (list, tuple)):
        shown = list(map(_value, value))
        if len(shown) <= _IN_A_LINE:
            return "[" + ", ".join(shown) + "]"
        lines = (", ".join(shown[i : i + _IN_A_LINE]) for i in range(0, len(shown), _IN_A_LINE))
        return "[\n" + "".join(f"  {line},\n" for line in lines) + "]"
    return f"{value:.{_DIGITS}g}"


def _encodable(text: str) -> str:
    """The text with an escape for what UTF-8 lacks: a name of a file may hold it."""
    return text.encode("utf-8", "backslashreplace").decode("utf-8")


def _replaced(text: str, name: str, tables: list[str]) -> str:
    """Cut every table called ``name`` and put ``tables`` where the first stood, or at the end."""
    kept: list[str] = []
    held: list[str] = []  # comments and blank lines in a table that is cut: they belong to the next table, if one follows
    place, cutting = None, False
    for line in text.splitlines():
        header = _HEADER.match(line)
        if header:
            cutting = header["name"] == name or header["name"].startswith(f"{name}.")
            place = len(kept) if cutting and place is None else place
            kept += [] if cutting else held
            held = []
        elif cutting and (not line.strip() or line.lstrip().startswith("#")):
            held.append(line)
        elif cutting:
            held = []
        if not cutting:
            kept.append(line)
    kept += held
    place = len(kept) if place is None else place
    before, after = "\n".join(kept[:place]).rstrip(), "\n".join(kept[place:]).strip("\n")
    return "\n\n".join(part for part in (before, *tables, after) if part) + "\n"


def _checked(old: str, new: str, name: str, **options: Any) -> str:
    """The new text, if it is a scene and differs from the old one in the table alone, of which nothing old is left."""
    if name in parse_toml(_replaced(_same_but(old, new, name), name, [])):
        raise SceneError(name, parse_toml(old).get(name), _REPLACEABLE)
    parse_scene(new, **options)
    return new


def _same_but(old: str, new: str, name: str) -> str:
    """The new text, if it is TOML and differs from the old one in one key alone."""
    was = parse_toml(old)
    try:
        now = parse_toml(new)
    except SceneError:  # written in another way, and now there twice
        now = {}
    if {key: each for key, each in was.items() if key != name} != {key: each for key, each in now.items() if key != name}:
        raise SceneError(name, was.get(name), _REPLACEABLE)
    return new
