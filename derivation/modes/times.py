"""The operators of a strip, factored: the two sets of times, and the weights of both partial fractions.

Within a strip the two sets of times are symbols, the relaxation times ``alpha_i`` (roots of P) and the retardation times
``beta_j`` (roots of Q), interlaced: everything else is rational in them.
"""

from __future__ import annotations

import itertools
from collections.abc import Sequence
from dataclasses import dataclass

import sympy as sp

from ..check import BEYOND, REPRODUCED, Derived, derived, holds
from ..model import Model, rate
from ..symbols import alpha, beta
from .identity import vanishes
from .symbols import numbered


@dataclass(frozen=True)
class Times:
    """Relaxation times alpha_i and retardation times beta_j of a strip, k V times those of the material."""

    alpha: tuple[sp.Symbol, ...]
    beta: tuple[sp.Symbol, ...]

    @property
    def ordered(self) -> dict[sp.Symbol, sp.Expr]:
        """The interlaced times as sums of positive steps."""
        steps = itertools.accumulate(sp.Symbol(f"step_{k}", positive=True) for k in range(2 * len(self.alpha)))
        return dict(zip([time for pair in zip(self.alpha, self.beta, strict=True) for time in pair], steps, strict=True))

    def transfer(self, step: sp.Expr = rate) -> sp.Expr:
        """Stiffness p/w over K of a motion exp(step s)."""
        return sp.Mul(*(1 + time * step for time in self.beta)) / sp.Mul(*(1 + time * step for time in self.alpha))


def strip_times(n: int) -> Times:
    return Times(*(tuple(numbered(symbol, mode) for mode in range(n)) for symbol in (alpha, beta)))


def factored_operators(model: Model, times: Times) -> Derived:
    r"""Eq. 5: :math:`\prod_j (1 + \beta_j \partial_s)\,w = \prod_i (1 + \alpha_i \partial_s)\,p`."""
    name = "dimensionless groups"
    n = model.modes
    Q = sp.Mul(*(1 + time * rate for time in times.beta))
    P = sp.Mul(*(1 + time * rate for time in times.alpha))
    speed = sp.Symbol("speed", positive=True)  # k V: d/dt = k V d/ds
    scaled = [(model.operator_w(speed * rate) / model.Q[0]), (model.operator_p(speed * rate) / model.P[0])]
    checks = [
        holds(
            name,
            "in s the operators are polynomials with the constant term 1 and the degree of the material's: K w = p at rest",
            all(sp.cancel(op.subs(rate, 0)) == 1 for op in (*scaled, Q, P)) and sp.degree(Q, rate) == sp.degree(P, rate) == n,
        ),
    ]
    return derived(
        factored_operators,
        (Q, P),
        name=name,
        statement="In the frame of the surface d/dt = k V d/ds. Lengths in A, pressures in K A; the roots of the operators are "
        "-1/alpha_i and -1/beta_j, with alpha_i = k V tau_i and beta_j = k V lambda_j.",
        latex=r"\prod_{j}\left(1 + \beta_j \frac{d}{ds}\right) w = \prod_{i}\left(1 + \alpha_i \frac{d}{ds}\right) p",
        checks=checks,
        paper="Eq. 5",
        status=REPRODUCED,
    )


def branch_weights(times: Times) -> Derived:
    r"""Partial fractions of the factored operators:

    .. math:: \frac QP = 1 + \sum_i \frac{\eta_i s}{1 + \alpha_i s},\qquad \frac PQ = J_0 + \sum_j \frac{J_j}{1 + \beta_j s}
    """
    name = "partial fractions"
    n = len(times.alpha)
    ratio, inverse = times.transfer(), 1 / times.transfer()
    viscosities = tuple(_residue(times.beta, times.alpha, i) / (-1 / times.alpha[i]) for i in range(n))
    compliances = tuple(_residue(times.alpha, times.beta, j) for j in range(n))
    instantaneous = sp.Mul(*times.alpha) / sp.Mul(*times.beta)
    products = [
        (times.beta[i] - times.alpha[i])
        * sp.Mul(*((times.beta[k] - times.alpha[i]) / (times.alpha[k] - times.alpha[i]) for k in range(n) if k != i))
        for i in range(n)
    ]
    series = 1 + sp.Add(*(v * rate / (1 + time * rate) for v, time in zip(viscosities, times.alpha, strict=True)))
    chain = instantaneous + sp.Add(*(c / (1 + time * rate) for c, time in zip(compliances, times.beta, strict=True)))
    ordered = times.ordered
    weights = (*products, *compliances)
    checks = [
        vanishes(name, "Q/P is the Prony series", [ratio - series], n),
        vanishes(name, "P/Q is the retardation series", [inverse - chain], n),
        vanishes(name, "eta_i is a product of differences", [a - b for a, b in zip(viscosities, products, strict=True)], n),
        vanishes(name, "the compliances sum to that at rest", [instantaneous + sp.Add(*compliances) - 1], n),
        holds(name, "interlaced times: every weight is positive", all(_positive(weight, ordered) for weight in weights)),
    ]
    return derived(
        branch_weights,
        (tuple(products), compliances, instantaneous),
        name=name,
        statement="Interlaced times make every branch viscosity and every compliance positive. "
        "Nothing cancels in "
        "either: both are products of differences.",
        latex=r"\eta_i = (\beta_i - \alpha_i)\prod_{k \ne i}\frac{\beta_k - \alpha_i}{\alpha_k - \alpha_i},\quad "
        r"J_j = \frac{\prod_i (\beta_j - \alpha_i)}{\beta_j \prod_{k \ne j}(\beta_j - \beta_k)},\quad "
        r"J_0 = \prod_i \frac{\alpha_i}{\beta_i}",
        checks=checks,
        status=BEYOND,
    )


def _residue(upper: Sequence[sp.Symbol], lower: Sequence[sp.Symbol], mode: int) -> sp.Expr:
    """prod (1 + upper s)/prod over the other lower times, at the pole of one of them."""
    at = -1 / lower[mode]
    return sp.Mul(*(1 + time * at for time in upper)) / sp.Mul(*(1 + time * at for k, time in enumerate(lower) if k != mode))


def _positive(weight: sp.Expr, ordered: dict[sp.Symbol, sp.Expr]) -> bool:
    """Whether every factor of a product of differences has a sign, and these make it positive."""
    negative = 0
    for factor in sp.Mul.make_args(weight):
        base, exponent = factor.as_base_exp()
        value = sp.together(sp.expand(base.subs(ordered)))
        value = sp.together(value)
        upper, lower = (sp.expand(part) for part in sp.fraction(value))
        for part in (upper, lower):
            if part.is_negative:
                negative += int(exponent)
            elif not part.is_positive:
                return False
    return negative % 2 == 0
