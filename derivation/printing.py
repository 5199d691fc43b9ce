"""SymPy expressions as NumPy source, and what the templates make functions of them with.

Only spelling happens here. SymPy's own rewrites for NumPy are left out on purpose: it turns ``1 - exp(-z)`` into
``exp(-z) expm1(z)``, which overflows.
"""

import textwrap
from collections.abc import Iterable

import sympy as sp
from sympy.printing.precedence import precedence
from sympy.printing.pycode import PythonCodePrinter

from .functions import HELPERS, Formula, flat

FUNCTIONS = {sp.sin: "np.sin", sp.cos: "np.cos", sp.sqrt: "np.sqrt", sp.atan: "np.arctan", sp.acos: "np.arccos", sp.exp: "np.exp"}
SYMBOLS = {"T_epsilon": "T_eps"}  # named so in Python; the long name is for LaTeX
WIDTH = 110  # of a docstring's lines
RENAMED = {"hypot": "np.hypot", "expm1": "np.expm1"}  # helpers that NumPy has


class NumPySource(PythonCodePrinter):
    """Prints symbols by their names, calls by theirs, and numbers as a reader would write them."""

    def _print_Function(self, expr: sp.Expr) -> str:
        name = FUNCTIONS.get(expr.func) or RENAMED.get(expr.func.__name__, expr.func.__name__)
        return f"{name}({', '.join(self._print(argument) for argument in expr.args)})"

    _print_sin = _print_cos = _print_atan = _print_acos = _print_exp = _print_hypot = _print_expm1 = _print_Function

    def _print_Symbol(self, expr: sp.Symbol) -> str:
        return SYMBOLS.get(expr.name, expr.name)

    def _print_Pi(self, expr: sp.Expr) -> str:
        return "np.pi"

    def _print_Exp1(self, expr: sp.Expr) -> str:
        return "np.e"

    def _print_Rational(self, expr: sp.Rational) -> str:
        return f"{expr.p} / {expr.q}"

    _print_Half = _print_Rational

    def _print_Add(self, expr: sp.Expr, order: object = None) -> str:
        """Terms in SymPy's canonical order, but one with a plus sign first."""
        terms = list(self._as_ordered_terms(expr, order=None))
        terms.sort(key=lambda term: term.could_extract_minus_sign())
        text = ""
        for term in terms:
            minus = term.could_extract_minus_sign()
            body = self.parenthesize(-term if minus else term, precedence(expr), strict=minus)
            text += (f" - {body}" if minus else f" + {body}") if text else (f"-{body}" if minus else body)
        return text

    def _print_Mul(self, expr: sp.Expr) -> str:
        """Numerator over denominator, numbers first, the sign in front."""
        if expr.could_extract_minus_sign():
            return f"-{self.parenthesize(-expr, precedence(expr))}"
        upper, lower = [], []
        for factor in expr.as_ordered_factors():
            if factor.is_Rational and not factor.is_Integer:
                upper += [] if factor.p == 1 else [sp.Integer(factor.p)]
                lower.append(sp.Integer(factor.q))
            elif factor.is_Pow and factor.exp.is_Rational and factor.exp < 0:
                lower.append(1 / factor)
            else:
                upper.append(factor)
        text = " * ".join(self.parenthesize(f, precedence(expr)) for f in upper) or "1"
        if lower:
            below = " * ".join(self.parenthesize(f, precedence(expr)) for f in lower)
            text += f" / ({below})" if len(lower) > 1 else f" / {self.parenthesize(lower[0], precedence(expr), strict=True)}"
        return text

    def _print_Pow(self, expr: sp.Expr, rational: bool = False) -> str:
        if expr.exp == sp.Rational(1, 2):
            return f"np.sqrt({self._print(expr.base)})"
        if expr.exp == -1:
            return f"1 / {self.parenthesize(expr.base, precedence(sp.Symbol('x') * 2), strict=True)}"
        return super()._print_Pow(expr, rational=rational)


_printer = NumPySource({"fully_qualified_modules": False, "allow_unknown_functions": True})


def source(expression: sp.Expr) -> str:
    """NumPy source of one expression."""
    return _printer.doprint(sp.sympify(expression))


def results(value: object) -> str:
    """Source of a result: an expression, or nested tuples of them."""
    if isinstance(value, tuple):
        inner = ", ".join(results(part) for part in value)
        return f"({inner},)" if len(value) == 1 else f"({inner})"
    text = source(value)  # type: ignore[arg-type]
    return f"{text}.0" if text.lstrip("-").isdigit() else text


def docstring(statement: str) -> tuple[str, tuple[str, ...]]:
    """The first sentence, which must fit a line, and the rest, wrapped."""
    first, dot, rest = statement.partition(". ")
    lines = textwrap.wrap(first + (dot.strip() or ""), WIDTH)
    return lines[0], (*lines[1:], *textwrap.wrap(rest, WIDTH))


def fits(latex: str) -> bool:
    """Whether an equation fits a line of a docstring."""
    return len(latex) <= WIDTH


def functions_of(formulas: Iterable[Formula], kinds: tuple[type, ...]) -> set[str]:
    """Names of the functions of these ``kinds`` that formulas call."""
    terms = [term for formula in formulas for term in (*(step for _, step in formula.steps), *flat(formula.result))]
    return {type(f).__name__ for term in terms for f in sp.sympify(term).atoms(sp.Function) if isinstance(f, kinds)}


def helpers_used(formulas: Iterable[Formula]) -> list[str]:
    return sorted(functions_of(formulas, HELPERS) - set(RENAMED))
