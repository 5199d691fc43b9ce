"""Inequalities of admissibility: relations between SymPy expressions, as mathematics for the audit and as code for a solver."""

from __future__ import annotations

from dataclasses import dataclass

import sympy as sp

from .functions import written_out

SIGNS = {"<=": r"\le", ">=": r"\ge", "<": "<", ">": ">", "==": "="}


@dataclass(frozen=True)
class Relation:
    """Two or more sides with the same sign between them."""

    sign: str
    sides: tuple[sp.Expr, ...]

    @property
    def code(self) -> str:
        return f" {self.sign} ".join(map(str, self.sides))

    @property
    def latex(self) -> str:
        """With every call and helper written out."""
        return f" {SIGNS[self.sign]} ".join(sp.latex(written_out(side)) for side in self.sides)


@dataclass(frozen=True)
class Inequality:
    """Relations in a sentence, each in the place of a pair of braces."""

    sentence: str
    relations: tuple[Relation, ...]

    @property
    def code(self) -> str:
        return self.sentence.format(*(relation.code for relation in self.relations))

    @property
    def prose(self) -> str:
        """The sentence with LaTeX between dollars."""
        return self.sentence.format(*(f"${relation.latex}$" for relation in self.relations))


def relation(sign: str, *sides: sp.Expr | int) -> Relation:
    return Relation(sign, tuple(map(sp.sympify, sides)))


def require(*relations: Relation, sentence: str = "{}") -> Inequality:
    """``relations`` hold, in the words of ``sentence``."""
    return Inequality(sentence, relations)
