"""A formula and its record as the text of one function of a generated module."""

from __future__ import annotations

import textwrap
from collections.abc import Iterable
from dataclasses import dataclass
from typing import Any

import sympy as sp

from .functions import HELPERS, Formula, flat
from .printing import RENAMED, results, source

WIDTH = 110  # of a docstring's lines


@dataclass(frozen=True)
class FunctionText:
    """One function of a generated module, as text for its template."""

    name: str
    args: tuple[str, ...]
    statement: str  # first sentence
    explanation: tuple[str, ...]
    equation: tuple[str, ...]
    derived_by: str
    paper: str
    steps: tuple[tuple[str, str], ...]
    result: str
    algorithm: str = ""  # what puts together what is derived, if not the formula


def function_text(formula: Formula, record: Any) -> FunctionText:
    return FunctionText(
        formula.name,
        tuple(map(source, formula.args)),
        *docstring(record.statement),
        tuple(record.latex.split("\n")) if len(record.latex) <= WIDTH else (),
        record.function,
        record.paper,
        tuple((source(label), source(term)) for label, term in formula.steps),
        results(formula.result),
        getattr(record, "algorithm", ""),
    )


def docstring(statement: str) -> tuple[str, tuple[str, ...]]:
    """The first sentence, which must fit a line, and the rest, wrapped."""
    first, dot, rest = statement.partition(". ")
    lines = textwrap.wrap(first + (dot.strip() or ""), WIDTH)
    return lines[0], (*lines[1:], *textwrap.wrap(rest, WIDTH))


def functions_of(formulas: Iterable[Formula], kinds: tuple[type, ...]) -> set[str]:
    """Names of the functions of these ``kinds`` that formulas call."""
    terms = [term for formula in formulas for term in (*(step for _, step in formula.steps), *flat(formula.result))]
    return {type(f).__name__ for term in terms for f in sp.sympify(term).atoms(sp.Function) if isinstance(f, kinds)}


def helpers_used(formulas: Iterable[Formula]) -> list[str]:
    return sorted(functions_of(formulas, HELPERS) - set(RENAMED))
