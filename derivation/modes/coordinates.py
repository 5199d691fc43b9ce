"""The state of a material point with n relaxation times, in three sets of coordinates."""

from __future__ import annotations

import itertools
from typing import Any

import sympy as sp

from ..check import Derived, derived
from ..model import rate
from ..symbols import alpha, beta
from .identity import vanishes
from .symbols import J_0, J, S, enter, eta, leave, share
from .tensor import Values
from .times import Times


def strip_values(times: Times, weights: tuple[Any, ...]) -> dict[Any, sp.Expr]:
    """Every numbered quantity of a strip in terms of its times."""
    viscosities, compliances, instantaneous = weights
    n = len(times.alpha)
    values: dict[Any, sp.Expr] = {J_0: instantaneous}
    for i, j in itertools.product(range(n), repeat=2):
        difference = times.beta[j] - times.alpha[i]
        values[(enter, i, j)] = viscosities[i] / difference
        values[(leave, j, i)] = compliances[j] * times.beta[j] / difference
        values[(share, j, i)] = compliances[j] * viscosities[i] / difference
    for k in range(n):
        values[(alpha, k)], values[(beta, k)] = times.alpha[k], times.beta[k]
        values[(eta, k)], values[(J, k)] = viscosities[k], compliances[k]
        values[(S, k)] = times.alpha[k] / viscosities[k]
    return values


def coordinates(times: Times, values: Values) -> Derived:
    r"""States of a material point: retardation displacements z_j, overstresses f_i, dashpot displacements e_i.

    .. math:: w = J_0 p + \sum_j z_j,\quad \beta_j z_j' + z_j = J_j p;\qquad
        p = w + \sum_i f_i,\quad \alpha_i f_i' + f_i = \eta_i w'
    """
    name = "states"
    n = len(times.alpha)
    modes = range(n)
    # A motion exp(rate s) of p excites z_j/p = J_j/(1 + beta_j s), w/p = P/Q, f_i/p = eta_i s/(1 + alpha_i s) w/p, and
    # e_i = w - S_i f_i.
    w = 1 / times.transfer()
    z = [values[(J, j)] / (1 + times.beta[j] * rate) for j in modes]
    f = [values[(eta, i)] * rate / (1 + times.alpha[i] * rate) * w for i in modes]
    e = [w / (1 + times.alpha[i] * rate) for i in modes]
    lag = [z[j] - values[(J, j)] for j in modes]  # z - J p

    def applied(matrix: sp.Symbol, row: int, vector: list[sp.Expr]) -> sp.Expr:
        return sp.Add(*(values[(matrix, row, k)] * vector[k] for k in modes))

    def product(one: sp.Symbol, other: sp.Symbol, row: int, column: int) -> sp.Expr:
        return sp.Add(*(values[(one, row, k)] * values[(other, k, column)] for k in modes))

    pairs = list(itertools.product(modes, repeat=2))
    checks = [
        vanishes(name, "w = J_0 p + sum z_j", [w - values[J_0] - sp.Add(*z)], n),
        vanishes(name, "p = w + sum f_i", [1 - w - sp.Add(*f)], n),
        vanishes(name, "f = -enter (z - J p)", [f[i] + applied(enter, i, lag) for i in modes], n),
        vanishes(name, "z - J p = -leave f", [lag[j] + applied(leave, j, f) for j in modes], n),
        vanishes(name, "z = share e", [z[j] - applied(share, j, e) for j in modes], n),
        vanishes(name, "e = w - S f", [e[i] - w + values[(S, i)] * f[i] for i in modes], n),
        vanishes(name, "leave is the inverse of enter", [product(leave, enter, j, k) - int(j == k) for j, k in pairs], n),
        vanishes(
            name,
            "enter shares out: its columns sum to 1",
            [sp.Add(*(values[(enter, i, j)] for i in modes)) - 1 for j in modes],
            n,
        ),
    ]
    return derived(
        coordinates,
        (tuple(z), tuple(f), tuple(e)),
        name=name,
        statement="Three sets of n numbers describe the state of a material point. Under a constant pressure the z_j "
        "decouple, in "
        "contact the f_i; matrices that hold no time, only ratios of times, lead from one to the other. Checked on every motion "
        "exp(rate s).",
        latex=r"f = -N (z - J p),\ N_{ij} = \frac{\eta_i}{\beta_j - \alpha_i};\quad z - J p = -M f,\ "
        r"M_{ji} = \frac{J_j\beta_j}{\beta_j - \alpha_i};\quad z = G e,\ G_{ji} = \frac{J_j\eta_i}{\beta_j - \alpha_i}",
        checks=checks,
    )
