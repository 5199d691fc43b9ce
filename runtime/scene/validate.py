"""From the raw content of a TOML file to typed values in SI; every error names the key."""

import functools
import re
import types
import typing
from typing import Any

import numpy as np

from ..errors import InputError
from ..inputs.checks import LARGEST
from . import schema
from .errors import SceneError, nearest
from .quantity import to_si

msgspec = schema.msgspec
_PATH = re.compile(r"^(?P<problem>.*?)(?: - at `\$(?P<path>[^`]*)`)?$", re.DOTALL)
_MISSING = re.compile(r"missing required field `([^`]+)`")


def validated(raw: dict[str, Any]) -> dict[str, Any]:
    """Check a parsed scene file and convert its quantities to SI.

    Parameters
    ----------
    raw : content of the file

    Returns
    -------
    dict with the keys of :class:`hystrip.scene.schema.SceneFile`; a quantity is an array of shape (), a
    list or range of them one of shape (n,); moduli and times are lists of such arrays; absent optional keys are None or
    their default

    Raises
    ------
    SceneError : names key, value and what is allowed
    """
    _refuse_unknown_keys(schema.SceneFile, raw, "")
    _refuse_endless_integers(raw, "")
    try:
        scene = msgspec.convert(raw, schema.SceneFile)
    except msgspec.ValidationError as error:
        raise _explained(error, raw) from None
    _refuse_other_models(scene.material)
    try:
        values = _resolved(scene, "")
        values["material"]["model"] = _model(scene.material)
        return values
    except InputError as error:
        raise SceneError(error.field, error.value, error.allowed) from None


def _model(material: Any) -> str:
    """Which of ``schema.MATERIAL_KEYS`` a material is."""
    return schema.HALF_SPACE if material.kind == schema.HALF_SPACE else material.model or "standard_linear_solid"


def _refuse_endless_integers(raw: Any, path: str) -> None:
    """Integers beyond every quantity; msgspec cannot say what is wrong with them."""
    for key, each in raw.items() if isinstance(raw, dict) else enumerate(raw):
        if isinstance(each, (dict, list)) or (isinstance(each, int) and each.bit_length() > 1000):
            place = _join(path, key) if isinstance(raw, dict) else f"{path}[{key}]"
            if isinstance(each, int):
                raise SceneError(place, each, _described(place))
            _refuse_endless_integers(each, place)


def _refuse_other_models(material: Any) -> None:
    """Every parameter of the material's model, and none of another's."""
    if material.kind == schema.HALF_SPACE and material.model is not None:
        raise SceneError("material.model", material.model, 'none with kind = "half-space", which has E, nu, moduli and times')
    model = _model(material)
    wanted = schema.MATERIAL_KEYS[model]
    given = {key: getattr(material, key) for key in sorted({key for keys in schema.MATERIAL_KEYS.values() for key in keys})}
    for key, value in given.items():
        if key not in wanted and value is not None:
            having = " or ".join(_named(each) for each, keys in schema.MATERIAL_KEYS.items() if key in keys)
            allowed = f"with {_named(model)} in [material]: {', '.join(wanted)}; {key} goes with {having}"
            raise SceneError(f"material.{key}", value, allowed, "a key of another model")
    for key in sorted(wanted):
        if given[key] is None:
            raise SceneError(f"material.{key}", None, _described(f"material.{key}"), "missing")
    if material.solver is not None and model not in ("prony", schema.HALF_SPACE):
        raise SceneError("material.solver", material.solver, 'with model = "prony" only; other models come with hystrip')


def _named(model: str) -> str:
    """How a scene says which model its material is."""
    return f'{"kind" if model == schema.HALF_SPACE else "model"} = "{model}"'


@functools.cache
def _fields(struct: type) -> dict[str, tuple[Any, Any]]:
    """Name -> (type, Meta) of every key of a struct."""
    hints = typing.get_type_hints(struct, include_extras=True)
    return {name: (typing.get_args(hint)[0], hint.__metadata__[0]) for name, hint in hints.items()}


@functools.cache
def _struct_in(kind: Any) -> type | None:
    """The struct among the alternatives of a type, looking into lists."""
    for part in typing.get_args(kind) or (kind,):
        if typing.get_origin(part) in (list, types.UnionType, typing.Union):
            found = _struct_in(part)
            if found is not None:
                return found
        elif isinstance(part, type) and issubclass(part, schema.Struct):
            return part
    return None


def _refuse_unknown_keys(struct: type, raw: Any, path: str) -> None:
    if isinstance(raw, list):
        for index, each in enumerate(raw):
            if isinstance(each, (dict, list)):
                _refuse_unknown_keys(struct, each, f"{path}[{index}]")
    if not isinstance(raw, dict):
        return
    fields = _fields(struct)
    for key, value in raw.items():
        if key not in fields:
            raise _unknown(key, value, path, fields)
        inner = _struct_in(fields[key][0])
        if inner is not None:
            _refuse_unknown_keys(inner, value, _join(path, key))


def _unknown(key: str, value: Any, path: str, fields: dict[str, Any]) -> SceneError:
    place = f"[{path}]" if path else "the scene"
    if path and key in _fields(schema.SceneFile):
        problem = f"a key of the scene itself, not of {place}: it has to stand above the first [table] of the file"
        return SceneError(_join(path, key), value, f"in {place}: {', '.join(fields)}", problem)
    near = nearest(key, fields)
    hint = f" (did you mean {near!r}?)" if near else ""
    return SceneError(_join(path, key), value, f"in {place}: {', '.join(fields)}", f"unknown key{hint}")


def _explained(error: Exception, raw: dict[str, Any]) -> SceneError:
    """msgspec's message says where; what is there and what may be there is added."""
    match = _PATH.match(str(error))
    path = (match["path"] or "").lstrip(".")
    missing = _MISSING.search(match["problem"])
    if missing:
        path = _join(path, missing[1])
        return SceneError(path, None, _described(path), "missing")
    return SceneError(path, _at(raw, path), _described(path), "" if path else match["problem"])


def _steps(path: str) -> list[str | int]:
    return [int(part[1:-1]) if part.startswith("[") else part for part in re.findall(r"\[\d+\]|[^.\[\]]+", path)]


def _at(raw: Any, path: str) -> Any:
    for step in _steps(path):
        raw = raw[step]
    return raw


def _described(path: str) -> str:
    """The description of the key that a path ends in: of the list for an item of one."""
    struct, text = schema.SceneFile, ""
    for step in _steps(path):
        if isinstance(step, str) and struct is not None:
            kind, meta = _fields(struct)[step]
            struct, text = _struct_in(kind), meta.description
    return text


def _join(path: str, key: str) -> str:
    return f"{path}.{key}" if path else key


def _resolved(struct: Any, path: str) -> dict[str, Any]:
    out = {}
    for name, (_, meta) in _fields(type(struct)).items():
        value, field = getattr(struct, name), _join(path, name)
        unit = (meta.extra or {}).get("unit")
        if name == "moduli" and struct.kind == schema.HALF_SPACE:
            unit = "Pa"
        if value is not None and unit is not None:
            value = _each(value, unit, field) if (meta.extra or {}).get("each") else values_in_si(value, unit, field)
        elif isinstance(value, schema.Struct):
            value = _resolved(value, field)
        elif isinstance(value, list) and value and isinstance(value[0], schema.Struct):
            value = [_resolved(each, f"{field}[{index}]") for index, each in enumerate(value)]
        out[name] = value
    return out


def _each(values: list[Any], unit: str, field: str) -> list[np.ndarray]:
    """A list whose entries are quantities of their own, each with its values."""
    if not values:
        raise InputError(field, values, "one value or more")
    return [values_in_si(value, unit, f"{field}[{index}]") for index, value in enumerate(values)]


def values_in_si(value: Any, unit: str, field: str) -> np.ndarray:
    """Shape () for a single value, (n,) for a list or a range."""
    if isinstance(value, schema.Range):
        return _spread(value, unit, field)
    if isinstance(value, list):
        if not value:
            raise InputError(field, value, "one value or more")
        if all(type(each) is float for each in value) and np.all(np.abs(value) <= LARGEST):
            return np.array(value)
        return np.array([to_si(each, unit, f"{field}[{index}]") for index, each in enumerate(value)])
    return np.array(to_si(value, unit, field))


def _spread(value: Any, unit: str, field: str) -> np.ndarray:
    start = to_si(value.start, unit, f"{field}.start")
    stop = to_si(value.stop, unit, f"{field}.stop")
    if start == stop:
        raise InputError(f"{field}.stop", value.stop, f"a value other than start ({value.start!r})")
    if value.spacing == "linear":
        return np.linspace(start, stop, value.num)
    for end, number in (("start", start), ("stop", stop)):
        if number <= 0:
            raise InputError(f"{field}.{end}", getattr(value, end), 'a value > 0 with spacing = "log"')
    return np.geomspace(start, stop, value.num)
