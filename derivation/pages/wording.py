"""What a page says in words of its own model, beside what is the same for every model."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from typing import Any

import sympy as sp

from ..functions import written_out

Words = tuple[tuple[str, ...], ...]


@dataclass(frozen=True)
class Wording:
    """``unread``: steps whose displays have nothing to compare, and what they are. ``kinds``: of functions of a regime."""

    parameters: Words
    misprints: list[dict[str, Any]]
    unread: Mapping[str, str]
    kinds: tuple[str, ...]
    conditions: Callable[[Any], list[list[str]]]  # of a regime: meaning and LaTeX of each boundary equation
    fields: Words = ()
    small: Words = ()
    parts: Mapping[str, str] = field(default_factory=dict)  # functions that name what others of a step are made of, and that step


def plainly(term: sp.Expr) -> str:
    """LaTeX with helpers and calls written out; a fraction far wider above than below as a product, to be cut."""
    return sp.latex(written_out(term), long_frac_ratio=8)
