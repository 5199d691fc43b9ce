"""LaTeX read back as SymPy, so that what is displayed, and what the paper prints, can be compared with what was derived.

The part of LaTeX that the displays and the paper's equations use: sums, products, fractions, powers, roots, functions, primes,
indices, integrals, sums over an index, ``[u]_a^b``, and chains of ``=``. What a name means is given by the caller; a name
without a meaning, and anything else that is not understood, is an error.
"""

from __future__ import annotations

from dataclasses import dataclass

import sympy as sp

from .analysis import Analysis
from .tokens import RELATIONS, Names, Unreadable, split, tokens


@dataclass(frozen=True)
class Statement:
    """Sides with the signs between them; one side alone is a value."""

    sides: tuple[sp.Expr, ...]
    signs: tuple[str, ...]


def read(latex: str, names: Names) -> sp.Expr:
    """One expression."""
    (statement,) = statements(latex, names)
    if len(statement.sides) != 1:
        raise Unreadable(f"{latex!r} is no single expression")
    return statement.sides[0]


def statements(latex: str, names: Names) -> tuple[Statement, ...]:
    """The equations and values of a display, in order."""
    found = []
    for part in split(tokens(latex)):
        reader = Analysis(part, names)
        sides, signs = [reader.sum()], []
        while reader.peek() in RELATIONS:
            signs.append(reader.take())
            sides.append(reader.sum())
        if reader.peek():
            raise Unreadable(f"{' '.join(part)!r}: {reader.peek()!r} is not understood")
        found.append(Statement(tuple(sides), tuple(signs)))
    return tuple(found)
