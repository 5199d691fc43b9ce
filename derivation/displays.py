"""What is displayed is what is proven: the LaTeX of every step is read back and compared with what the step derived.

A display is a chain of equations, or values that stand for themselves. With the names bound to what was derived, all sides of
a chain are one, and a value by itself, or on a side of an inequality ``<=``, is that of the step. Both are compared at random
points (:mod:`.modes.numbers`), where an index means what it says. What the names mean: :mod:`.vocabulary` and
:mod:`.modes.vocabulary`. Displays that state a condition, a definition or an integral over fields that are not in closed form
have nothing to compare; ``displays.toml`` lists them, each with a reason of ``REASONS``.
"""

import random
import tomllib
from collections.abc import Callable, Iterable, Mapping
from pathlib import Path
from typing import Any

import mpmath
import numpy as np
import sympy as sp
from sympy.core.function import AppliedUndef

from .check import DerivationError, Derived
from .exact import RELATIONS
from .functions import flat, written_out
from .latex import Unreadable, statements
from .modes.numbers import DIGITS, sample, value
from .strip import TIMES
from .surface import WAVE
from .symbols import alpha, beta, chi

READ = "the display reads as what was proven"
POINTS, AGREED = 3, 20  # digits
#: how the reasons begin for which a display holds nothing to compare, and what it shows then, one of these at least
REASONS = {
    "printed from": ("=",),
    "condition": ("=", "<", r"\ge"),
    "a condition": ("=",),
    "a law by cases": (r"\quad",),
    "a convention": ("= 0",),
    "definitions of the means": (r"\oint",),
    "an integral over": (r"\int",),
    "a sum over": (r"\sum",),
    "derivatives of": (r"\partial",),
}
STATED: dict[str, dict[str, str]] = tomllib.loads(Path(__file__).with_suffix(".toml").read_text(encoding="utf-8"))
Names = Mapping[str, Any]
Binding = Callable[[list[sp.Expr], Names], Names]
Point = Callable[[str, set[sp.Symbol]], Mapping[sp.Symbol, Any]]


def displays(
    steps: Iterable[Derived], stated: Mapping[str, str], words: Names, bindings: Mapping[str, Binding], point: Point
) -> dict[str, str]:
    """What is said of the display of every step: read back and compared, but for those that are ``stated`` to hold nothing.

    ``words``: what the names mean; ``bindings``: by the beginning of a step's name, what they mean in it; ``point``: of random
    values. Raises :class:`DerivationError`, which names the step, for a display that reads as something else or cannot be read.
    """
    found = {}
    for step in steps:
        what = stated.get(step.name, "")
        if what:
            require_reason(step, what)
        if what.startswith("printed") and not all(sp.latex(part) in step.latex for part in values_of(step)):
            raise DerivationError(step.name, READ)
        if not what:
            read_back(step, {**words, **bound(step, words, bindings)}, point)
        found[step.name] = f"nothing to compare in the display: {what}" if what else f"{READ}: {AGREED} digits"
    return found


def require_reason(step: Derived, what: str) -> None:
    """Require that a display holds nothing to compare for the reason stated. Raises :class:`DerivationError`."""
    shown = next((signs for begins, signs in REASONS.items() if what.startswith(begins)), None)
    if shown is None:
        raise DerivationError(step.name, f"{what!r} in displays.toml begins with one of {', '.join(map(repr, REASONS))}")
    if not any(sign in step.latex for sign in shown):
        raise DerivationError(step.name, f"a display that is {what!r} shows one of {', '.join(map(repr, shown))}")


def bound(step: Derived, words: Names, bindings: Mapping[str, Binding]) -> Names:
    """The names that stand for the step's own value, or mean something of their own in it."""
    binding = bindings.get(step.name) or next((of for prefix, of in bindings.items() if step.name.startswith(prefix)), None)
    return binding(values_of(step), words) if binding else {}


def values_of(step: Derived) -> list[sp.Expr]:
    """The expressions that a step derived, in order."""
    return [part for part in flat(step.value) if isinstance(part, sp.Basic)]


def read_back(step: Derived, names: Names, point: Point) -> None:
    """Compare the display of one step with what it derived."""
    try:
        read = statements(step.latex, names)
    except Unreadable as problem:
        raise DerivationError(step.name, f"the display can be read: {problem}") from problem
    alone = iter(values_of(step))
    for statement in read:
        sides, signs = statement.sides, set(statement.signs)
        if signs == {r"\le"}:  # between values
            pairs = [(side, next(alone, None)) for side in sides]
        elif len(sides) == 1 or step.name.startswith("regime "):  # a value by itself; a boundary equation, value = 0
            pairs = [(sides[0], next(alone, None))]
        else:
            pairs = [(sides[0], side) for side in sides[1:]]
        if not (signs <= {"=", r"\ge"} or signs == {r"\le"}) or None in (other for _, other in pairs):
            raise DerivationError(step.name, f"the display {step.latex!r} is a chain of equations, or the values in order")
        for pair in pairs:
            _require_same(step.name, *map(_definite, pair), point)


def _require_same(name: str, one: sp.Expr, other: sp.Expr, point: Point) -> None:
    difference = one - other
    if difference == 0:
        return
    if difference.atoms(AppliedUndef):  # a function that stands for itself, such as the pressure of Eq. 7
        raise DerivationError(name, READ, difference)
    with mpmath.workdps(DIGITS):
        for number in range(POINTS):
            at = point(f"{name} {number}", one.free_symbols | other.free_symbols)
            left, right = value(one, at), value(other, at)
            if not np.all(abs(left - right) <= mpmath.mpf(10) ** -AGREED * (1 + abs(left))):
                raise DerivationError(name, READ, np.ravel(left - right)[0])


def _definite(expression: sp.Expr) -> sp.Expr:
    return written_out(sp.sympify(expression)).doit(integrals=False).subs(TIMES).subs(RELATIONS).subs(WAVE)


def of_one_time(seed: str, symbols: set[sp.Symbol]) -> dict[sp.Symbol, Any]:
    """Random values, with alpha < beta as for a material, and chi 0 or 1."""
    found = drawn(seed, symbols)
    if alpha in found and beta in found:
        found[alpha], found[beta] = sorted((found[alpha], found[beta] + mpmath.mpf(1) / 200))
    if chi in found:
        found[chi] = random.Random(seed).randint(0, 1)
    return found


def of_modes(seed: str, symbols: set[sp.Symbol]) -> dict[sp.Symbol, Any]:
    """Random values, and three modes."""
    modes = sample(seed)
    return {**drawn(seed, symbols - set(modes)), **modes}


def drawn(seed: str, symbols: set[sp.Symbol]) -> dict[sp.Symbol, Any]:
    draw = random.Random(seed)
    return {symbol: mpmath.mpf(draw.randint(20, 120)) / 100 for symbol in sorted(symbols, key=str)}
