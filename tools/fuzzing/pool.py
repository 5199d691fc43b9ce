"""Values that programs stumble over."""

from __future__ import annotations

import itertools
import random
from typing import Any

import numpy as np

#: as they stand in a TOML text
WRITTEN = [
    "0", "-0.0", "1", "-1", "1e-3", "1e9", "1e40", "1.1e40", "1e-40", "9e-41", "5e-324", "1e308", "1e400", "nan", "-inf", "inf",
    "true", "0x7fffffffffffffff", "9223372036854775808", "9" * 400, "9" * 5000, "1_000.5", "0b101", "1979-05-27",
    "1979-05-27T07:32:00Z", "07:32:00", "[]", "[[]]", "[1, [2]]", "[1, 'a']", "{}", "{start = 1, stop = 2, num = 3}",
    "{start = 0, stop = 1, num = 3, spacing = 'log'}", "{start = 1, stop = 1, num = 2}", "{start = 1e-40, stop = 1e40, num = 4}",
    "{start = 2, stop = 1, num = 1000000}", "''", "'1'", "'1 m'", "'1 GPa/m'", "'1e3 s'", "'-5 mm/s'", "'1 m m m'", "'1 \u00b5m'",
    "'1 m**2/m'", "'1 Pa/m**9**9**9'", "'1 (('", "'1 degC'", "'10 um" + " " * 60 + "'", "'1" + " " * 5000 + "x'", "'0,1 kPa'",
    "'1 m^-1'", "'1 m' # m", '"\\u001b[31m"', '"\\u0000"', '"\\ud800"', "'''a\nb'''", '"unclosed', "[" * 300, "[" * 10 + "]" * 10,
    "{a = {a = 1}}", "'1 dB'", "'1 %'", "'1 inch'", "'1 m/'", "'e5 m'", "'.5 m'", "'5. m'", "'1e999 m'", "'1e-999 m'", "[1,2,3,]",
]  # fmt: skip

UNITS = ["m", "um", "s", "Pa", "Pa/m", "J/m^2", "m/s", "GPa/m", "%", "degC", "", "m**-1", "\u03bcm", "N/m", "(m", "1/s", "m m"]

#: as Python objects
_MADE = [
    lambda: None, lambda: True, lambda: 0, lambda: -1, lambda: 1, lambda: 10**5000, lambda: 0.0, lambda: -0.0, lambda: 1e-3,
    lambda: 1e9, lambda: float("nan"), lambda: float("inf"), lambda: 1e300, lambda: 5e-324, lambda: 1e-40, lambda: 1e40,
    lambda: "1", lambda: "", lambda: "a\0b", lambda: b"1", lambda: [], lambda: [[]], lambda: [1.0], lambda: [1.0, 2.0],
    lambda: [1.0, [2.0, 3.0]], lambda: [None], lambda: (), lambda: {}, lambda: {"a": 1}, lambda: {1, 2}, lambda: 1j,
    lambda: np.array([]), lambda: np.array([1.0, np.nan]), lambda: np.ones((2, 3)), lambda: np.array("a"), lambda: np.float32(1),
    lambda: np.ma.array([1.0, 2.0], mask=[0, 1]), lambda: np.array([1, 2], dtype=object), lambda: itertools.count(1),
    lambda: itertools.repeat(1.0), lambda: (each for each in [1.0]), lambda: object(), lambda: np.longdouble("1e400"),
    lambda: type, lambda: range(3), lambda: range(10**12), lambda: memoryview(b"12"), lambda: np.datetime64("2020-01-01"),
    lambda: Exception("x"), lambda: np.array([[1.0]]), lambda: np.int8(-5), lambda: np.uint64(2**63), lambda: Endless(),
    lambda: Broken(),
]  # fmt: skip


class Endless(list):
    """A list that says it is short, and never ends."""

    def __len__(self) -> int:
        return 2

    def __iter__(self):
        return itertools.repeat(1.0, 1000)


class Broken:
    """An object that cannot even be shown."""

    def __repr__(self) -> str:
        raise RuntimeError("no repr")


def made(chance: random.Random) -> Any:
    """One of the objects."""
    return chance.choice(_MADE)()


def number(chance: random.Random) -> str:
    """A number as a text, of any size."""
    return f"{chance.choice(['', '-'])}{chance.random() * 10.0 ** chance.randint(-45, 45):.{chance.randint(0, 17)}g}"
