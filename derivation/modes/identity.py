"""Zero for identities between the modes of an actual model, where every quantity is rational in the times."""

from __future__ import annotations

import random
from collections.abc import Sequence

import sympy as sp

from ..check import Check, DerivationError

SYMBOLIC = 3  # up to so many modes identities between modes are proven in symbols, beyond at exact rational points
POINTS = 12


def vanishes(name: str, claim: str, residuals: Sequence[sp.Expr], n: int) -> Check:
    """Verify that rational expressions vanish: in symbols up to ``SYMBOLIC`` modes, beyond at exact rational points."""
    if n <= SYMBOLIC:
        for residual in residuals:
            if sp.cancel(sp.together(residual)) != 0:
                raise DerivationError(name, claim, residual)
        return Check(claim, "exact zero")
    symbols = sorted(set().union(*(sp.sympify(r).free_symbols for r in residuals)), key=str)
    draw = random.Random(f"{name} {claim} {n}")
    for _ in range(POINTS):
        point = {symbol: sp.Rational(draw.getrandbits(40) + 1, draw.getrandbits(20) + 1) for symbol in symbols}
        for residual in residuals:
            if sp.expand(sp.sympify(residual).xreplace(point), complex=True) != 0:
                raise DerivationError(name, claim, residual)
    return Check(claim, f"exact zero at {POINTS} random rational points")
