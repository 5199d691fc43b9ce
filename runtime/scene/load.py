"""Finding and reading scene files."""

import os
from collections.abc import Iterator
from importlib import resources
from typing import Any

import numpy as np

from ..errors import InputError
from ..files import path_of, read_at_most
from ..inputs.checks import truth
from .errors import SceneError, located, nearest
from .model import Scene
from .toml import LARGEST, parse_toml


def _builtin_names() -> tuple[str, ...]:
    folder = resources.files("hystrip") / "scenes"
    return tuple(sorted(each.name[: -len(".toml")] for each in folder.iterdir() if each.name.endswith(".toml")))


BUILTIN = _builtin_names()
"""Names of the scenes that come with hystrip."""


def scene_text(source: str | os.PathLike[str]) -> tuple[str, str]:
    """Text and short name of a scene file or built-in scene. Raises SceneError."""
    try:
        path = str(path_of(source, "scene", "a scene file"))
    except InputError as error:
        allowed = f"the path of a TOML file, or a built-in scene: {', '.join(BUILTIN)}"
        raise SceneError("scene", error.value, allowed) from None
    if path in BUILTIN:
        return (resources.files("hystrip") / "scenes" / f"{path}.toml").read_text(encoding="utf-8"), path
    return _read(path), os.path.splitext(os.path.basename(path))[0] or "scene"


def load_scene(source: str | os.PathLike[str], *, allow_solver: bool = False) -> Scene:
    """Read a scene.

    Parameters
    ----------
    source : path of a TOML file, or the name of a built-in scene (see :data:`BUILTIN`)
    allow_solver : run the code of a solver that the scene names; without it such a scene is refused

    Raises
    ------
    SceneError : the file cannot be read, or its content not be used; names key, value and what is allowed
    MissingExtra : msgspec, or Pint where a unit is written, is not installed

    Examples
    --------
    >>> scene = load_scene("paper_fig7")
    >>> len(scene.levels), scene.velocity.shape, float(scene.pressure)
    (3, (141,), 5000000.0)
    >>> print(f"{scene.solve().mu.max():.3e}")
    2.974e-04
    """
    text, name = scene_text(source)
    return parse_scene(text, name=name, source=os.fspath(source), allow_solver=allow_solver)


def parse_scene(text: str, name: str = "scene", source: str = "", *, allow_solver: bool = False) -> Scene:
    """Build a scene from TOML text; `source` is named in errors. Raises as :func:`load_scene`."""
    from .validate import validated

    allow_solver = truth("allow_solver", allow_solver)
    with located(source):
        values = validated(parse_toml(text))
        resolve_solver(values, source, allow_solver)
        return _assembled(values, text, name, source)


def resolve_solver(values: dict[str, Any], source: str, allowed: bool) -> None:
    """Make the solver's folder in a validated scene absolute (given from the scene's on); SceneError unless it may be run."""
    folder = values["material"]["solver"]
    if folder is None:
        return
    if not allowed:
        problem = "the scene names a solver, which is code that would run"
        how = "only if the caller allows it: --allow-solver on the command line, allow_solver=True in Python"
        raise SceneError("material.solver", folder, how, problem)
    values["material"]["solver"] = os.path.abspath(os.path.join(os.path.dirname(source), folder))


def _read(path: str) -> str:
    try:
        data = read_at_most(path, LARGEST)
    except FileNotFoundError:
        near = f"{path}.toml" if os.path.isfile(f"{path}.toml") else nearest(path, BUILTIN)
        hint = f" (did you mean {near!r}?)" if near else ""
        allowed = f"the path of a TOML file, or a built-in scene: {', '.join(BUILTIN)}"
        raise SceneError("", path, allowed, f"no such file{hint}", path) from None
    except IsADirectoryError:
        raise SceneError("", path, "the path of a TOML file", "this is a folder", path) from None
    except (OSError, ValueError) as error:
        problem = f"cannot be read ({getattr(error, 'strerror', None) or error})"
        raise SceneError("", path, "a file that can be read", problem, path) from None
    if len(data) > LARGEST:
        raise SceneError("", path, f"a TOML file of at most {LARGEST >> 10} KiB", "too large for a scene", path)
    try:
        return data.decode("utf-8-sig")
    except UnicodeDecodeError as error:
        problem = f"not UTF-8 text (byte {error.start})"
        raise SceneError("", path, "a TOML file, which is UTF-8 text", problem, path) from None


def _assembled(values: dict[str, Any], text: str, name: str, source: str) -> Scene:
    """The library's own objects check signs, orders and bounds; their errors get the place in the file added."""
    refuse_ambiguous(values)
    for field, each in quantities(values):
        if each.ndim and field not in ("pressure", "penetration", "velocity"):
            allowed = "a single number or text with a unit (lists and ranges here are for `hystrip sweep`)"
            raise SceneError(field, each.tolist(), allowed)
    objects = build_objects(values)
    rest = {key: each for key, each in values.items() if key not in ("material", "adhesion", "levels", "sweep")}
    if values["temperature"] is not None:
        rest["temperature"] = float(values["temperature"])
        objects["material"].at_temperature(rest["temperature"])  # what is wrong with it is said before the work
    return Scene(name=name, text=text, source=source, **objects, **rest)


def refuse_ambiguous(values: dict[str, Any]) -> None:
    """Check that load and adhesion are each given in one way."""
    given = {key: values[key] for key in ("pressure", "penetration") if values[key] is not None}
    if len(given) != 1:
        problem = "both pressure and penetration are given" if given else "neither pressure nor penetration is given"
        raise SceneError("", given, "exactly one of pressure and penetration in the scene", problem)
    if values["adhesion"] is not None:
        given = {key: each for key, each in values["adhesion"].items() if each is not None}
        if len(given) == 3 or not {"gamma", "p_0"} & set(given):
            problem = "all three are given" if len(given) == 3 else "neither gamma nor p_0 is given"
            raise SceneError("adhesion", given, "two of the three in [adhesion]: gamma, p_0, delta_0", problem)


def quantities(values: dict[str, Any]) -> Iterator[tuple[str, np.ndarray]]:
    """Dotted key and value of every quantity of a validated scene: levels, material and its shift, adhesion, temperature; load
    and velocity, of which the solver takes arrays, come last."""
    tables = [(f"levels[{index}]", level) for index, level in enumerate(values["levels"])]
    tables += [("material", values["material"]), ("material.shift", values["material"]["shift"] or {})]
    tables += [("adhesion", values["adhesion"] or {})]
    for path, table in tables:
        for key, each in table.items():
            if isinstance(each, np.ndarray):
                yield f"{path}.{key}", each
            elif isinstance(each, list):  # moduli and times: every entry is a quantity
                yield from ((f"{path}.{key}[{index}]", entry) for index, entry in enumerate(each))
    for key in ("temperature", "pressure", "penetration", "velocity"):
        if values[key] is not None:
            yield key, values[key]


def build_objects(values: dict[str, Any]) -> dict[str, Any]:
    """Material, adhesion and levels of a validated scene whose quantities there are single values."""
    levels = tuple(build_level(values, index) for index in range(len(values["levels"])))
    return {"material": build_material(values), "adhesion": build_adhesion(values), "levels": levels}


def build_material(values: dict[str, Any]) -> Any:
    """The material of a validated scene, its quantities single values."""
    return _made(_MODELS[values["material"]["model"]], _parameters(values["material"]), "material")


def build_adhesion(values: dict[str, Any]) -> Any:
    """The adhesion of a validated scene, its quantities single values; none without a table."""
    given = values["adhesion"] or {"gamma": 0.0}
    return _made("Dugdale", {key: float(each) for key, each in given.items() if each is not None}, "adhesion")


def build_level(values: dict[str, Any], index: int) -> Any:
    """A level of a validated scene, its quantities single values."""
    return _made("Level", {key: float(each) for key, each in values["levels"][index].items()}, f"levels[{index}]")


_MODELS = {"standard_linear_solid": "StandardLinearSolid", "kelvin_voigt": "KelvinVoigt", "prony": "Prony",
           "half-space": "HalfSpace"}  # fmt: skip


def _parameters(material: dict[str, Any]) -> dict[str, Any]:
    """Arguments of the material's class."""
    arguments: dict[str, Any] = {}
    for key, each in material.items():
        if isinstance(each, np.ndarray):
            arguments[key] = float(each)
        elif isinstance(each, list):
            arguments[key] = [float(entry) for entry in each]
    if material["shift"] is not None:
        arguments["shift"] = _shift(material["shift"])
    if material["fit"] is not None:
        if material["model"] not in ("prony", "half-space"):
            allowed = 'a series: model = "prony" or kind = "half-space"'
            raise SceneError("material.fit", material["fit"], allowed, "of a material that is no series")
        arguments["fit"] = _made("FittedBand", material["fit"], "material.fit")
    if material["solver"] is not None:
        from ..loading import load_solver

        try:
            arguments["solver"] = load_solver(material["solver"])
        except InputError as error:
            raise SceneError("material.solver", error.value, error.allowed) from None
    return arguments


def _shift(table: dict[str, Any]) -> Any:
    """The shift of a validated [material.shift]: every parameter of its model, and none of the other's."""
    wanted = {"WLF": ("C_1", "C_2"), "Arrhenius": ("E_a",)}
    arguments = {"T_ref": float(table["T_ref"]), "vertical": float(table["vertical"])}
    for model, keys in wanted.items():
        for key in keys:
            given = table[key]
            if (given is None) == (model == table["model"]):
                problem = "missing" if given is None else f"a key of the model {model}"
                allowed = f'with model = "{table["model"]}": {", ".join(wanted[table["model"]])}, T_ref, vertical'
                raise SceneError(f"material.shift.{key}", given, allowed, problem)
            if given is not None:
                arguments[key] = float(given)
    return _made(table["model"], arguments, "material.shift")


def _made(kind: str, arguments: dict[str, Any], path: str) -> Any:
    import hystrip

    from ..inputs.fitted import FittedBand

    try:
        return (FittedBand if kind == "FittedBand" else getattr(hystrip, kind))(**arguments)
    except InputError as error:
        # The library says "level.h", the file "levels[1].h".
        field = path + error.field[len(error.field.partition(".")[0]) :]
        raise SceneError(field, error.value, error.allowed, "" if error.value is not None else "missing") from None
