"""What the constructors of models may be given."""

import keyword
from typing import Any
from unicodedata import normalize

import sympy as sp

from hystrip.errors import InputError
from hystrip.inputs.checks import sequence

A_NAME = "a lower-case Python name without leading underscore"
A_TEXT = "text of one line without quotation marks and backslashes"  # it is put between quotation marks


def require_words(name: Any, title: Any) -> None:
    """Raise :class:`hystrip.InputError` unless a model can have the name and the title."""
    if not is_name(name):
        raise InputError("name", name, A_NAME)
    if not is_text(title):
        raise InputError("title", title, A_TEXT)


def is_name(name: Any) -> bool:
    """Whether a module can have the name."""
    lower = isinstance(name, str) and name.isidentifier() and name.isascii() and name == name.lower()
    return lower and not keyword.iskeyword(name) and not name.startswith("_")


def is_variable(name: str) -> bool:
    """Whether a function can take an argument of that very name: Python reads letters in their plain form."""
    return name.isidentifier() and not keyword.iskeyword(name) and name == normalize("NFKC", name) != "__debug__"


def is_text(text: Any) -> bool:
    """Whether a text can be emitted as it stands."""
    return isinstance(text, str) and text.isprintable() and not set(text) & {'"', "\\"}


def coefficients(field: str, operator: Any) -> tuple[sp.Expr, ...]:
    """The coefficients of an operator, numbers or expressions. Raises :class:`hystrip.InputError` for anything else."""
    made = []
    for n, given in enumerate(sequence(field, operator, "a sequence of coefficients, of the powers 0, 1, ..., n of d/dt")):
        try:
            made.append(sp.sympify(given, strict=True))
        except sp.SympifyError:
            made.append(None)
        if not isinstance(made[-1], sp.Expr):
            raise InputError(f"{field}[{n}]", given, "a number or a SymPy expression in the parameters")
    return tuple(made)
