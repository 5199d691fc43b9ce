"""Formulas of physics that the runtime asks for beside those of the strip itself: one line each.

A function takes the :class:`Basis` and returns the kernels that its section of the generated module holds; every kernel is
emitted, has a certificate and stands in the audit. ``FOR_ONE_TIME`` goes to the standard linear solid, ``FOR_ANY_NUMBER`` to
models with a Prony series.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any


@dataclass(frozen=True)
class Basis:
    """The flows of the zones, complete contact, and the table of regimes; :mod:`.flows`, :mod:`.saturated`, :mod:`.regimes`."""

    flows: Any
    saturated: Any
    regimes: tuple[Any, ...]


Section = tuple[str, Callable[[Basis], tuple[Any, ...]]]

FOR_ONE_TIME: tuple[Section, ...] = ()
FOR_ANY_NUMBER: tuple[Section, ...] = ()


def further(sections: tuple[Section, ...], basis: Basis) -> tuple[tuple[str, tuple[Any, ...]], ...]:
    """(title, kernels) of every section."""
    return tuple((title, derive(basis)) for title, derive in sections)
