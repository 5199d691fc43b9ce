"""Texts spoiled by a list of changes, any of which can be left out again."""

from __future__ import annotations

import random
import re
from collections.abc import Callable

from .pool import UNITS, WRITTEN, number

Change = Callable[[list[str]], list[str]]


def spoiled(lines: list[str], changes: list[Change]) -> str:
    """The text with all changes made."""
    for change in changes:
        lines = change(lines) or [""]
    return "\n".join(lines) + "\n"


def change(chance: random.Random, keys: list[str]) -> tuple[str, Change]:
    """A change, and what it does in words."""
    at, where, text = chance.random(), chance.random(), value(chance)
    key, char = (
        chance.choice(keys),
        chr(chance.choice([0, 9, 10, 27, 34, 39, 44, 46, 61, 91, 123, 0x2028, 0x202E, 0xFEFF, 0xFFFD])),
    )
    kinds: list[tuple[str, Change]] = [
        (f"value {text[:60]!r}", lambda lines: on(lines, at, lambda line: f"{line.partition('=')[0]}= {text}")),
        (f"value {text[:60]!r}", lambda lines: on(lines, at, lambda line: f"{line.partition('=')[0]}= {text}")),
        *[
            (
                f"numbers of a line times 10**{(at - 0.5) * size:.2g}",
                lambda lines, size=size: on(lines, where, lambda line: scaled(line, (at - 0.5) * size)),
            )
            for size in (2, 6, 6, 20, 60)
        ],
        ("line gone", lambda lines: [each for i, each in enumerate(lines) if i != int(at * len(lines))]),
        ("line twice", lambda lines: on(lines, at, lambda line: f"{line}\n{line}")),
        (f"key {key!r}", lambda lines: on(lines, at, lambda line: f"{key} ={line.partition('=')[2]}")),
        (f"line of {key!r}", lambda lines: on(lines, at, lambda line: f"{line}\n{key} = {text}")),
        (f"character {char!r}", lambda lines: on(lines, at, lambda line: into(line, where, char))),
        ("cut", lambda lines: lines[: int(at * len(lines)) + 1]),
        ("swapped", lambda lines: swapped(lines, at, where)),
        ("joined", lambda lines: on(lines, at, lambda line: line.replace("=", chance.choice([":", "==", "", "."]), 1))),
        ("dots", lambda lines: on(lines, at, lambda line: "a." * int(10 ** (4 * where)) + line)),
    ]
    return chance.choice(kinds)


def value(chance: random.Random) -> str:
    """A value as it may stand in a text."""
    kind = chance.randrange(4)
    if kind == 0:
        return number(chance)
    if kind == 1:
        return f"'{number(chance)} {chance.choice(UNITS)}'"
    if kind == 2:
        return "[" + ", ".join(value(chance)[:50] for _ in range(chance.randrange(4))) + "]"
    return chance.choice(WRITTEN)


def on(lines: list[str], at: float, edit: Callable[[str], str]) -> list[str]:
    number = int(at * len(lines))
    return [edit(line) if i == number else line for i, line in enumerate(lines)]


def into(line: str, where: float, char: str) -> str:
    place = int(where * (len(line) + 1))
    return line[:place] + char + line[place:]


def scaled(line: str, power: float) -> str:
    """The line with its numbers times ``10**power``."""
    key, equals, rest = line.partition("=")
    times = lambda found: f"{float(found[0]) * 10.0**power:.6g}"  # noqa: E731
    return (
        key + equals + re.sub(r"(?<![\w_])\d+\.?\d*(e-?\d+)?", times, rest)
        if equals
        else re.sub(r"\d+\.\d+(e-?\d+)?", times, line)
    )


def swapped(lines: list[str], at: float, where: float) -> list[str]:
    i, j, out = int(at * len(lines)), int(where * len(lines)), list(lines)
    out[i], out[j] = out[j], out[i]
    return out
