"""The kinds of inputs: each makes a case from a source of chance, and tries it."""

from __future__ import annotations

import random
import tempfile
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

import hystrip

from . import pool, texts

SCENE = """title = "fuzz"
pressure = 5e6
velocity = [1e-3, 2e-3]
rtol = 1e-2
edge = "continuous"
branch = "unloading"
[material]
model = "standard_linear_solid"
K = "1 GPa/m"
T_eps = 0.01
T_sigma = "0.1 ms"
[adhesion]
gamma = 0
delta_0 = "10 nm"
[sweep]
combine = "grid"
batch = 4
[[levels]]
l = "10 um"
h = 1e-6
""".splitlines()
SCENE_KEYS = ["pressure", "penetration", "velocity", "strips", "rtol", "edge", "K", "T_eps", "moduli", "times", "gamma", "p_0",
              "delta_0", "l", "h", "solver", "temperature", "E", "nu", "model",
              "[material]", "[[levels]]", "x", '"\x1b[31m"']  # fmt: skip
CSV = "f,E_stor,E_loss\nHz,MPa,MPa\n0.1,1.0,0.01\n1,1.1,0.1\n10,2.0,0.5\n100,4.0,1.0\n1000,5.9,0.3\n".splitlines()
CSV_KEYS = ["f", "omega", "E_stor", "E'", "tan delta", "Set", "T", "temperature [C]", "Hz", "GPa", ";", "\t"]
SCAN = ["# Channel: Main", "# Width: 10 um", "# Height: 10 um", "# Value units: m"]


@dataclass
class Case:
    """What is tried: ``parts``, in words, any of which may be left out; ``run`` with those that are kept. It returns whether
    the input was accepted, and raises what is wrong."""

    parts: list[str]
    run: Callable[[list[int]], bool]


def scene(chance: random.Random) -> Case:
    """A scene file, read and, if it is one, solved."""
    made = [texts.change(chance, SCENE_KEYS) for _ in range(chance.choice([1, 1, 1, 2, 3]))]

    def run(keep: list[int]) -> bool:
        text = texts.spoiled(list(SCENE), [made[i][1] for i in keep])
        with tempfile.TemporaryDirectory() as folder:
            path = Path(folder) / "fuzz.toml"
            path.write_text(text, encoding="utf-8", errors="surrogatepass", newline="")
            found = hystrip.load_scene(path)
        if found.velocity.size * found.load[1].size <= 4 and len(found.levels) < 3:
            sound(found.solve())
        return True

    return Case([each[0] for each in made], run)


def over(chance: random.Random) -> Case:
    """``KEY=VALUES`` of the command line, and the plan that follows."""
    from hystrip.sweeps.over import over_of

    keys = ["material.K", "levels[0].h", "levels[9].h", "pressure", "velocity", "adhesion.gamma", "material.times[0]", "x",
            "a.b.c", "material.K.", "[0]", "levels[-1].l", "levels[" + "9" * 30 + "].l", "material.temperature"]  # fmt: skip
    units = {"material.K": "Pa/m", "levels[0].h": "m", "pressure": "Pa", "velocity": "m/s", "adhesion.gamma": "J/m^2"}

    def good() -> str:
        key = chance.choice(sorted(units))
        values = [f"{10.0 ** chance.randint(-12, 12):g}" for _ in range(chance.randint(1, 3))]
        return f"{key}=" + ",".join(each if chance.random() < 0.5 else f"'{each} {units[key]}'" for each in values)

    def bad() -> str:
        return chance.choice(keys) + chance.choice(["=", "=", "=", " = ", "", "=="]) + texts.value(chance)

    made = [good() if chance.random() < 0.6 else bad() for _ in range(chance.choice([1, 1, 2, 3]))]

    def run(keep: list[int]) -> bool:
        with tempfile.TemporaryDirectory() as folder:
            plan(hystrip_scene(folder), over_of([made[i] for i in keep]))
        return True

    return Case([each[:200] for each in made], run)


def hystrip_scene(folder: str) -> Path:
    path = Path(folder) / "fuzz.toml"
    path.write_text("\n".join(SCENE), encoding="utf-8")
    return path


def plan(scene: Any, over: Any, **options: Any) -> None:
    """All of a sweep that comes before the first batch."""

    class Enough(Exception):
        pass

    def stop(done: int, total: int) -> None:
        raise Enough

    with tempfile.TemporaryDirectory() as out:
        try:
            hystrip.sweep(scene, over=over, out=options.pop("out", out), progress=stop, **options)
        except Enough:
            pass


def calls(chance: random.Random) -> Case:
    """A call of the interface with some arguments spoiled."""
    name, function, good = chance.choice(CALLS)
    spoiled = {key: pool.made(chance) for key in chance.sample(sorted(good), chance.randint(1, min(2, len(good))))}
    keys = list(spoiled)

    def run(keep: list[int]) -> bool:
        arguments = {key: make() for key, make in good.items()} | {keys[i]: spoiled[keys[i]] for i in keep}
        sound(function(**arguments))
        return True

    return Case([f"{name}: {key} = {hystrip_shown(each)}" for key, each in spoiled.items()], run)


def hystrip_shown(value: Any) -> str:
    from hystrip.errors import shown

    return shown(value)


def table(chance: random.Random) -> Case:
    """A file of measured moduli, read and fitted."""
    from hystrip.dma import fit_prony, read_dma

    made = [texts.change(chance, CSV_KEYS) for _ in range(chance.choice([1, 1, 1, 2, 3]))]
    terms, encoding = chance.choice([1, 1, 2, 40]), chance.choice(["utf-8", "utf-8", "utf-16", "latin-1"])

    def run(keep: list[int]) -> bool:
        lines = [
            line.replace(" = ", ",").replace("=", ",")
            for line in texts.spoiled(list(CSV), [made[i][1] for i in keep]).split("\n")
        ]
        with tempfile.TemporaryDirectory() as folder:
            path = Path(folder) / "fuzz.csv"
            path.write_bytes("\n".join(lines).encode(encoding, errors="replace"))
            series = fit_prony(read_dma(path), terms=terms)
        assert np.isfinite([series.relaxed, *series.moduli, *series.times]).all() and series.report()
        return True

    return Case([*(each[0] for each in made)], run)


def surface(chance: random.Random) -> Case:
    """A measured surface, read and made into levels."""
    from hystrip.roughness import levels_of, read_surface

    size = chance.choice([1, 7, 8, 9, 12, 12])
    grid = [" ".join(f"{chance.gauss(0, 1e-8):.6e}" for _ in range(size)) for _ in range(chance.choice([1, 8, 12, 12]))]
    made = [texts.change(chance, ["# Width", "# Height", "nan", "0"]) for _ in range(chance.choice([0, 1, 1, 2]))]
    suffix, count = chance.choice(["txt", "asc", "asc", "xyz", "nc", "npy", "sur"]), chance.choice([1, 2, 3, 100])
    options = chance.choice(
        [{}, {}, {}, {}, {"unit": "um", "sizes": (10.0, 10.0)}, {"unit": "x"}, {"sizes": (0.0, -1.0)}, {"channel": "y"}]
    )

    def run(keep: list[int]) -> bool:
        text = texts.spoiled([*SCAN, *grid], [made[i][1] for i in keep])
        with tempfile.TemporaryDirectory() as folder:
            path = Path(folder) / f"fuzz.{suffix}"
            path.write_text(text, encoding="utf-8", errors="replace")
            found = levels_of(read_surface(path, **options), count=count)
        assert all(np.isfinite([level.l, level.h]).all() for level in found.levels) and found.report()
        return True

    return Case([each[0] for each in made], run)


def sound(found: Any) -> None:
    """Raise AssertionError for numbers that contradict one another."""
    if not isinstance(found, hystrip.Result):
        return
    loaded = found.pressure != 0
    assert (
        np.isfinite(found.tau).all() and np.isfinite(found.mu[loaded]).all() and np.isfinite(found.error_estimate[loaded]).all()
    )
    assert np.allclose(found.tau_by_level.sum(axis=0), found.tau, rtol=1e-9)
    assert np.allclose((found.mu * found.pressure)[loaded], found.tau[loaded], rtol=1e-9)
    assert ((found.contact_by_level >= 0) & (found.contact_by_level <= 1 + 1e-9)).all()


def _solid() -> Any:
    return hystrip.StandardLinearSolid(1e9, 1e-2, 1e-4)


_one = lambda value: lambda: value  # noqa: E731
_SURFACE: dict[str, Callable[[], Any]] = {
    "material": _solid, "adhesion": lambda: hystrip.Dugdale(gamma=0), "levels": lambda: [hystrip.Level(1e-5, 1e-6)],
    "pressure": _one(5e6), "velocity": _one(1e-3), "edge": _one("continuous"), "branch": _one("unloading"), "rtol": _one(1e-2),
    "strips": _one(None),
}  # fmt: skip
_STRIP = {"material": _solid, "adhesion": lambda: hystrip.Dugdale(p_0=2.5e3, delta_0=1e-8), "l": _one(5e-7), "A": _one(5e-8),
          "D": _one(2e-8), "V": _one(5e-3), "edge": _one("continuous"), "branch": _one("unloading")}  # fmt: skip
_LEVEL = {"material": _solid, "adhesion": lambda: hystrip.Dugdale(gamma=0), "level": lambda: hystrip.Level(5e-7, 1e-7),
          "V": _one(5e-3), "D": _one(1e-7), "rtol": _one(1e-2), "strips": _one(None)}  # fmt: skip


def _dma(**given: Any) -> Any:
    from hystrip.dma import DynamicModulus, fit_prony

    options = {key: given.pop(key) for key in ("terms", "times", "per_decade") if key in given}
    return fit_prony(DynamicModulus(**given), **{key: each for key, each in options.items() if each is not None})


CALLS: list[tuple[str, Callable[..., Any], dict[str, Callable[[], Any]]]] = [
    ("solve", hystrip.solve, _SURFACE),
    ("solve", hystrip.solve, _SURFACE),
    ("solve_strip", hystrip.solve_strip, _STRIP),
    ("solve_level", hystrip.solve_level, _LEVEL),
    ("friction_law", hystrip.friction_law, {key: _LEVEL[key] for key in ("material", "adhesion", "level", "V", "rtol")}),
    ("StandardLinearSolid", hystrip.StandardLinearSolid, {"K": _one(1e9), "T_eps": _one(1e-2), "T_sigma": _one(1e-4)}),
    ("KelvinVoigt", hystrip.KelvinVoigt, {"K": _one(1e9), "T_eps": _one(1e-2)}),
    ("Prony", hystrip.Prony, {"K": _one(1e9), "moduli": _one([1e9, 2e9]), "times": _one([1e-3, 1e-2]), "solver": _one(None)}),
    ("HalfSpace", hystrip.HalfSpace, {"E": _one(1e6), "nu": _one(0.5), "moduli": _one([1e6]), "times": _one([1e-2])}),
    ("Dugdale", hystrip.Dugdale, {"gamma": _one(1e-5), "delta_0": _one(1e-8), "p_0": _one(None)}),
    ("Level", hystrip.Level, {"l": _one(1e-6), "h": _one(1e-7)}),
    ("load_scene", hystrip.load_scene, {"source": _one("paper_fig7")}),
    ("load_solver", hystrip.load_solver, {"folder": _one("nowhere")}),
    ("WLF", hystrip.WLF, {"C_1": _one(8.86), "C_2": _one(101.6), "T_ref": _one(300.0), "vertical": _one(0.0)}),
    ("fit_prony", _dma, {"omega": _one([1.0, 10.0, 100.0]), "storage": _one([1e6, 2e6, 3e6]), "loss": _one([1e5, 2e5, 1e5]),
                         "terms": _one(1), "times": _one(None), "per_decade": _one(None)}),
    ("sweep", lambda scene, over, **rest: plan(scene, over, **rest),
     {"scene": _one("paper_fig7"), "over": _one({"adhesion.gamma": [0.0, 1e-5]}), "combine": _one(None), "batch": _one(None),
      "workers": _one(1), "executor": _one(None), "scheduler": _one(None), "restart": _one(False), "allow_solver": _one(False)}),
]  # fmt: skip

KINDS: dict[str, Callable[[random.Random], Case]] = {
    "scene": scene, "over": over, "call": calls, "table": table, "surface": surface,
}  # fmt: skip
