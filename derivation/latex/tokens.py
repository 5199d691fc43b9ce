"""LaTeX in its smallest pieces, and a place among them that moves on as they are read."""

from __future__ import annotations

import re
from collections.abc import Mapping
from typing import Any

TOKEN = re.compile(r"\\\\|\\[A-Za-z]+|\\[,;!: {}|]|\d+|\S")
SKIPPED = {r"\,", r"\;", r"\!", r"\:", r"\ ", r"\left", r"\right", r"\displaystyle", "&"}
OPEN, CLOSE = {"(": ")", "[": "]", "{": "}", r"\{": r"\}"}, {")", "]", "}", r"\}"}
RELATIONS = {"=", r"\le", r"\ge", r"\leq", r"\geq", "<", ">", r"\to"}
SPACES = {r"\quad", r"\qquad", r"\\"}

Names = Mapping[str, Any]


class Unreadable(ValueError):
    """LaTeX with something in it that has no meaning here."""


def rows(latex: str) -> list[str]:
    """The lines of an environment such as ``aligned`` or ``cases``, each with its columns joined by a space."""
    inside = re.sub(r"\\(?:begin|end)\{\w+\}", "", latex)
    return [line.replace("&", " ").strip() for line in inside.split(r"\\") if line.strip()]


def joined(latex: str) -> str:
    """A formula set in several lines, as one."""
    return " ".join(rows(re.sub(r"\\(?:left|right)\s*\.", "", latex)))


def tokens(latex: str) -> list[str]:
    return [token for token in TOKEN.findall(latex) if token not in SKIPPED]


def split(tokens: list[str]) -> list[list[str]]:
    """The statements: parted by a comma before a space, a wide space, a line break or an arrow, outside all brackets."""
    parts: list[list[str]] = [[]]
    depth = 0
    for n, token in enumerate(tokens):
        depth += (token in OPEN) - (token in CLOSE)
        comma = token == "," and n + 1 < len(tokens) and tokens[n + 1] in SPACES
        if depth == 0 and (comma or token in SPACES or token == r"\Rightarrow"):
            parts.append([])
        else:
            parts[-1].append(token)
    return [part[:-1] if part and part[-1] == "," else part for part in parts if part]


class Cursor:
    """Tokens with what their names mean, read from the left."""

    def __init__(self, tokens: list[str], names: Names):
        self.tokens, self.names, self.at = tokens, names, 0
        self.differentials: list[bool] = []

    def peek(self, ahead: int = 0) -> str:
        place = self.at + ahead
        return self.tokens[place] if place < len(self.tokens) else ""

    def take(self, wanted: str = "") -> str:
        token = self.peek()
        if not token or wanted and token != wanted:
            raise Unreadable(f"{' '.join(self.tokens)!r}: {wanted or 'something'!r} is missing at {token!r}")
        self.at += 1
        return token

    def takes(self, token: str) -> bool:
        if self.peek() == token:
            self.at += 1
            return True
        return False

    def matching(self) -> int:
        depth = 0
        for n in range(self.at, len(self.tokens)):
            depth += (self.tokens[n] in OPEN) - (self.tokens[n] in CLOSE)
            if depth == 0:
                return n
        raise Unreadable(f"{' '.join(self.tokens)!r}: a bracket is not closed")

    def inside(self) -> list[str]:
        """The tokens of a group, or a single one."""
        if self.peek() != "{":
            return [self.take()]
        start, self.at = self.at + 1, self.matching() + 1
        return self.tokens[start : self.at - 1]
