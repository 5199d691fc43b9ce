"""What the paper's symbols mean, for reading its equations: one level with index i in SI, and its strips."""

from collections.abc import Callable
from typing import Any

import sympy as sp

from ..integral import integral
from ..surface import HEIGHT, WAVE
from ..symbols import D_level, K, T_eps, T_sigma, V, delta_0, h, l, p_0, x, y

y_j = sp.Symbol("y_j", real=True)

MATERIAL = {
    "K": K, "V": V, r"T_\varepsilon": T_eps, r"T_\epsilon": T_eps, r"T_\sigma": T_sigma, "p_0": p_0, r"\delta_0": delta_0,
    r"\pi": sp.pi, r"\infty": sp.oo, "x": x, "y": y, "y_j": y_j,
}  # fmt: skip


def level(index: str, **more: Any) -> dict[str, Any]:
    """Symbols of one level under the index that the paper gives it; its height is Eq. 4."""
    return {**MATERIAL, f"h_{index}": h, f"l_{index}": l, f"D_{index}": D_level, f"f_{index}": surface, **more}


def field(expression: sp.Expr) -> Callable[..., sp.Expr]:
    """A field of x and y as the function that the paper writes."""
    return lambda along=x, across=y: expression.subs({x: along, y: across}, simultaneous=True)


surface = field(HEIGHT.subs(WAVE))


def strips(number: int, place: Callable[[int, sp.Expr], sp.Expr] | None = None) -> dict[str, Any]:
    """The paper's strips, N = ``number`` in half a cell; ``place`` of strip j, its middle unless given."""
    width = l / (2 * number)
    where = place or (lambda j, wide: (sp.Integer(j) - sp.Rational(1, 2)) * wide)

    def summed(body: sp.Expr, first: sp.Expr, last: sp.Expr) -> sp.Expr:
        done = body.replace(sp.Integral, lambda inner, over: integral(inner.doit(), *over)).doit()
        return sum((done.subs(y_j, where(j, width)) for j in range(int(first), int(last) + 1)), sp.Integer(0))

    return {"N": sp.Integer(number), r"\Delta": width, "sum over j": summed}
