"""What a sweep solves: points in a fixed order, cut into batches that the scene alone decides."""

import copy
import hashlib
import json
import math
import re
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np

from ..arguments import check_levels
from ..errors import InputError
from ..inputs.checks import integer, numbers
from ..inputs.half_space import check_poisson
from ..inputs.materials import check_edge, kernel_of
from ..inputs.shift import check_exponents
from ..loading import solver_key
from ..scene.errors import SceneError, nearest
from ..scene.load import build_adhesion, build_level, build_material, build_objects, quantities, refuse_ambiguous
from ..scene.quantity import DIFFERENCE
from . import code

_LOADS = ("pressure", "penetration")
#: what the solver takes arrays of
RUN_KEYS = (*_LOADS, "velocity")
_UNITS = {"l": "m", "h": "m", "K": "Pa/m", "T_eps": "s", "T_sigma": "s", "E": "Pa", "nu": "1", "moduli": "Pa/m", "times": "s",
          "C_1": "1", "C_2": "K", "T_ref": "K", "E_a": "J/mol", "vertical": "1", "gamma": "J/m^2", "p_0": "Pa", "delta_0": "m",
          "pressure": "Pa", "penetration": "m", "velocity": "m/s", "temperature": "K"}  # fmt: skip

#: what is zero nowhere
_POSITIVE = ("K", "E", "l", "times", "temperature", "C_1", "C_2", "T_ref", "E_a")
#: most points of a sweep: their coordinates and numbers are held in memory at its end
_MOST = 100_000_000


@dataclass(frozen=True)
class Axis:
    """One swept quantity: its dotted key in the scene, its values in SI."""

    key: str
    values: np.ndarray
    unit: str

    @property
    def name(self) -> str:
        """Short name: ``gamma``, ``h_2`` (level 2's h), ``times_1`` (the first relaxation time), ``velocity``."""
        return short_name(self.key)


@dataclass(frozen=True)
class Plan:
    """A sweep. ``base``: the validated scene; ``axes``: what varies, the slowest first; load and velocity come last."""

    name: str
    text: str
    base: dict[str, Any]
    axes: tuple[Axis, ...]
    combine: str
    batch: int | None

    @property
    def shape(self) -> tuple[int, ...]:
        """Lengths of the axes of a grid; one length for a list."""
        sizes = tuple(axis.values.size for axis in self.axes)
        return sizes if self.combine == "grid" else sizes[:1]

    @property
    def size(self) -> int:
        return math.prod(self.shape)

    @property
    def points_of_a_call(self) -> int:
        """Points in a row that differ in load and velocity alone: the solver takes them together."""
        if self.combine == "list":
            return self.size if all(axis.key in RUN_KEYS for axis in self.axes) else 1
        return math.prod(axis.values.size for axis in self.axes if axis.key in RUN_KEYS)

    @property
    def levels(self) -> int:
        return len(self.base["levels"])

    def coordinates(self, points: np.ndarray) -> np.ndarray:
        """Values of the axes at points (n,), shape (n, axes)."""
        index = np.unravel_index(points, self.shape) if self.combine == "grid" else [points] * len(self.axes)
        return np.column_stack([axis.values[i] for axis, i in zip(self.axes, index, strict=True)])

    @cached_property
    def solved(self) -> dict[str, Any]:
        """What of the scene the numbers depend on."""
        return {key: each for key, each in self.base.items() if key not in ("title", "description", "sweep")}

    @cached_property
    def solver(self) -> str:
        """Hash of the code in the solver's folder that the scene names; empty without one."""
        return solver_key(self.base["material"]["solver"])

    @cached_property
    def fingerprint(self) -> str:
        """Changes with anything that the numbers, their order or the batches depend on: the code that solves, too."""
        axes = [[axis.key, axis.values] for axis in self.axes]
        seen = [self.solved, self.solver, axes, self.combine, self.batch, code.code_key()]
        return hashlib.sha256(json.dumps(seen, default=_listed, sort_keys=True).encode()).hexdigest()


def _listed(value: Any) -> Any:
    return [float(each).hex() for each in np.ravel(value)] + [list(np.shape(value))]


def short_name(key: str) -> str:
    """``levels[1].h`` -> ``h_2``, ``material.times[0]`` -> ``times_1``, ``material.K`` -> ``K``."""
    numbered = re.search(r"\[(\d+)\]", key)
    name = _last(key)
    return f"{name}_{int(numbered[1]) + 1}" if numbered else name


def unit_of(key: str, half_space: bool = False) -> str:
    """SI unit of a quantity of the scene; the key must be one. ``half_space``: the scene's material is one, of moduli in Pa."""
    name = _last(key)
    return "Pa" if half_space and name == "moduli" else _UNITS[name]


def written_unit(key: str, half_space: bool = False) -> str:
    """Unit of a quantity written as text: of C_2 that of a difference of temperatures, where degrees would mean another thing."""
    return DIFFERENCE if _last(key) == "C_2" else unit_of(key, half_space)


def is_half_space(values: dict[str, Any]) -> bool:
    """Whether the material of a scene is a half-space."""
    material = values.get("material")
    return isinstance(material, dict) and material.get("kind") == "half-space"


def has_unit(key: str) -> bool:
    """Whether the key ends in the name of a quantity."""
    return _last(key) in _UNITS


def _last(key: str) -> str:
    """Name of the quantity at the end of a dotted key."""
    return key.rsplit(".", 1)[-1].partition("[")[0]


def check_combination(combine: Any, batch: Any) -> tuple[str, int | None]:
    """How points are combined, and how many are a batch. Raises ``InputError``."""
    if not isinstance(combine, str) or combine not in ("grid", "list"):
        raise InputError("combine", combine, "'grid' (every combination) or 'list' (all of one length, taken together)")
    if batch is not None:
        batch = integer("batch", batch, 1, math.inf, "an integer >= 1, points that are solved and stored together")
    return combine, batch


def plan_of(values: dict[str, Any], name: str, text: str, over: dict[str, Any], combine: str | None, batch: int | None) -> Plan:
    """The sweep of a validated scene, with the values in ``over`` (dotted key -> values in SI) in place of the scene's."""
    values = copy.deepcopy(values)
    if all(key in over for key in _LOADS):
        raise InputError("over", [*_LOADS], "one of the two: each takes the place of the other")
    for key, given in over.items():
        _put(values, key, given)
    _give_way(values["adhesion"] or {}, over)
    refuse_ambiguous(values)
    settings = values["sweep"] or {"combine": "grid", "batch": None}
    combine, batch = check_combination(
        settings["combine"] if combine is None else combine, settings["batch"] if batch is None else batch
    )
    half_space = is_half_space(values)
    axes = tuple(Axis(key, each, unit_of(key, half_space)) for key, each in quantities(values) if each.ndim)
    _refuse_hopeless(values, {axis.key for axis in axes})
    sizes = {axis.key: axis.values.size for axis in axes}
    if combine == "list" and len(set(sizes.values())) > 1:
        allowed = 'lists and ranges of one length, or combine = "grid"'
        raise SceneError("sweep.combine", "list", allowed, f"lengths differ: {sizes}")
    if not axes:
        problem = "nothing is swept: every quantity is a single value"
        raise SceneError("", None, "a list or a range for at least one quantity", problem)
    plan = Plan(name, text, values, axes, combine, batch)
    if plan.size > _MOST:
        raise SceneError("", plan.size, f"at most {_MOST:.0e} points", f"{plan.size} points")
    return plan


def _refuse_hopeless(values: dict[str, Any], swept: set[str]) -> None:
    """Refuse before any work what no combination can mend; what a combination spoils is recorded point by point."""
    for key, each in quantities(values):
        if _last(key) == "vertical":
            check_exponents(key, each)
        elif _last(key) == "nu":
            check_poisson(key, each)
        elif key not in _LOADS:
            numbers(key, each, unit_of(key, is_half_space(values)), 0, strict=_last(key) in _POSITIVE)
    fixed = lambda path: not any(key.startswith(path) for key in swept)  # noqa: E731
    if fixed("material"):
        material = build_material(values)
        check_edge(material, values["edge"])
        kernel_of(material)
        if values["temperature"] is not None:
            for temperature in np.ravel(values["temperature"]):
                material.at_temperature(float(temperature))
    if fixed("levels"):
        check_levels([build_level(values, index) for index in range(len(values["levels"]))])
    if values["adhesion"] is not None and fixed("adhesion.delta_0"):
        strongest = {key: each.max() for key, each in values["adhesion"].items() if each is not None}
        build_adhesion({"adhesion": strongest})


def _put(values: dict[str, Any], key: str, given: Any) -> None:
    known = [*keys_of(values)]
    if key not in known:
        of_shift = isinstance(key, str) and (key == "temperature" or key.startswith("material.shift."))
        if of_shift and not values["material"]["shift"]:
            raise InputError("over", key, "a quantity of the scene; this one needs a [material.shift] (WLF or Arrhenius)")
        near = nearest(key, known) if isinstance(key, str) else None
        raise InputError("over", key, f"one of {', '.join(known)}" + (f" (did you mean {near!r}?)" if near else ""))
    array = numbers(key, given, unit_of(key, is_half_space(values)))
    if array.ndim > 1 or not array.size:
        raise InputError(key, given, "a number or a one-dimensional list of numbers, at least one")
    if key in _LOADS:
        values["pressure"] = values["penetration"] = None
    if key.startswith("adhesion.") and values["adhesion"] is None:
        values["adhesion"] = {"gamma": None, "p_0": None, "delta_0": None}
    *path, last = (int(step) if step.isdigit() else step for step in re.findall(r"\w+", key))
    place: Any = values
    for step in path:
        place = place[step]
    place[last] = array


def _give_way(adhesion: dict[str, Any], over: dict[str, Any]) -> None:
    """Of all three quantities, one too many, leave out one of the scene's own: its stress, else its energy, else its range."""
    own = [key for key in ("p_0", "gamma", "delta_0") if f"adhesion.{key}" not in over]
    if own and all(each is not None for each in adhesion.values()):
        adhesion[own[0]] = None


def keys_of(values: dict[str, Any]) -> list[str]:
    """Dotted keys of everything that can be swept in a validated scene."""
    keys = [f"levels[{i}].{field}" for i in range(len(values["levels"])) for field in ("l", "h")]
    material = values["material"]
    own = [f"material.{key}" for key in ("E", "nu") if material[key] is not None] or ["material.K"]
    times = [f"material.{key}" for key in ("T_eps", "T_sigma") if material[key] is not None]
    times += [f"material.{key}[{i}]" for key in ("moduli", "times") for i in range(len(material[key] or ()))]
    if material["shift"] is not None:
        times += [f"material.shift.{key}" for key, each in material["shift"].items() if isinstance(each, np.ndarray)]
    keys += [*own, *times, "adhesion.gamma", "adhesion.p_0", "adhesion.delta_0"]
    return [*keys, *(["temperature"] if material["shift"] is not None else []), "pressure", "penetration", "velocity"]


def single(base: dict[str, Any], keys: list[str], at: np.ndarray) -> dict[str, Any]:
    """Material (at its temperature), adhesion and levels at one combination of the values of ``keys`` (load and velocity are
    left alone)."""
    kept = ("material", "adhesion", "levels", "temperature", *RUN_KEYS)
    values = copy.deepcopy({key: base[key] for key in kept})
    for key, value in zip(keys, at, strict=True):
        _put(values, key, float(value))
    objects = build_objects(values)
    if values["temperature"] is not None:
        objects["material"] = objects["material"].at_temperature(float(values["temperature"]))
    return objects
