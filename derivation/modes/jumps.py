"""What happens where p steps or its slope does: the law of order n integrated across the edge."""

from __future__ import annotations

import sympy as sp

from ..check import BEYOND, Check, DerivationError, Derived, derived, holds
from ..model import rate
from ..symbols import alpha, beta
from .identity import vanishes
from .law import Law
from .symbols import J_0, J


def jump_law(law: Law) -> Derived:
    r"""The n conditions at an edge: :math:`\sum_k Q_{k+m+1}[w^{(k)}] = \sum_k P_{k+m+1}[p^{(k)}]`, :math:`m = 0 \dots n-1`.

    Across the edge w and p are functions with a step in every derivative, ``w = w_- + sum_k [w^(k)] s^k/k! theta(s)``. The law
    holds as an equation between distributions: the coefficient of each derivative of the delta function vanishes.
    """
    name = "jump law"
    n = law.modes
    order = range(n)
    steps_w, steps_p = (sp.symbols(f"step_{v}:{n}", real=True) for v in ("w", "p"))
    Q, P = ([sp.Poly(op, rate).coeff_monomial(rate**k) for k in range(n + 1)] for op in law.operators)
    # d^k (theta s^j/j!)/ds^k holds the (k - j - 1)-th derivative of delta, for k > j.
    conditions = [
        sp.Add(*(Q[j + m + 1] * steps_w[j] - P[j + m + 1] * steps_p[j] for j in order if j + m + 1 <= n)) for m in order
    ]
    # In terms of the states: w^(k) from beta_j z_j' = J_j p - z_j, with a step in each z_j.
    steps_z = sp.symbols(f"step_z:{n}", real=True)
    derivatives = [list(steps_z)]
    for k in range(n - 1):
        derivatives.append([(law.values[(J, j)] * steps_p[k] - derivatives[k][j]) / law.values[(beta, j)] for j in order])
    in_states = {steps_w[k]: law.values[J_0] * steps_p[k] + sp.Add(*derivatives[k]) for k in order}
    inserted = [condition.subs(in_states) for condition in conditions]
    ratio = _ratio(name, conditions, steps_w, steps_p, law)
    checks: list[Check] = [
        vanishes(
            name,
            "continuous z_j satisfy all n conditions, whatever p and its derivatives do",
            [condition.subs(dict.fromkeys(steps_z, 0)) for condition in inserted],
            n,
        ),
        _no_other_way(name, inserted, steps_z, law),
        vanishes(name, "the highest gives [w] = J_0 [p]", [ratio - law.values[J_0]], n),
    ]
    return derived(
        jump_law,
        ratio,
        name=name,
        statement="The law integrated n times across an edge gives n conditions. They say that every retardation "
        "displacement z_j, and "
        "with it every dashpot displacement, is continuous; where p steps, w steps by J_0 [p].",
        latex=r"\sum_k Q_{k+m+1}[w^{(k)}] = \sum_k P_{k+m+1}[p^{(k)}]\ (m = 0 \dots n-1)\;\Leftrightarrow\; [z_j] = 0\ "
        r"(j = 1 \dots n)",
        checks=checks,
        status=BEYOND,
    )


def _ratio(name: str, conditions: list[sp.Expr], steps_w, steps_p, law: Law) -> sp.Expr:
    top = sp.expand(conditions[-1])
    if top.free_symbols & set((*steps_w[1:], *steps_p[1:])):
        raise DerivationError(name, "the highest condition holds steps of w and p alone")
    return -top.coeff(steps_p[0]) / top.coeff(steps_w[0])


def _no_other_way(name: str, inserted: list[sp.Expr], steps_z, law: Law) -> Check:
    """The matrix of the conditions on the steps of the z_j is regular, as it is for one set of interlaced times."""
    n = law.modes
    point = {time: sp.Integer(3) ** (k + 1) for k, time in enumerate(interlaced(law))}
    rows = [
        [condition.xreplace({**point, **{other: sp.Integer(other == step) for other in steps_z}}) for step in steps_z]
        for condition in (c.subs(dict.fromkeys(c.free_symbols - set(steps_z) - set(point), 0)) for c in inserted)
    ]
    return holds(name, f"and they have no other solution: {n} independent conditions on {n} states", sp.Matrix(rows).det() != 0)


def interlaced(law: Law) -> list[sp.Symbol]:
    """The times of the strip in their order: alpha_1, beta_1, alpha_2, ..."""
    return [law.values[(symbol, mode)] for mode in range(law.modes) for symbol in (alpha, beta)]


def closures(law: Law) -> Derived:
    r"""Which closures determine the states: ``constitutive`` always, ``continuous`` where it says the same."""
    name = "closures"
    n = law.modes
    steps = sp.symbols(f"step_z:{n}", real=True)
    step_w = sp.Add(*steps)  # at given p: w continuous asks that this vanishes
    open_conditions = n - sp.Matrix([[sp.diff(step_w, step) for step in steps]]).rank()
    without_response = law.model.P[-1] == 0
    if without_response:
        allowed, claim, holding = (0, 1), "no instantaneous compliance: the law itself keeps w continuous where p steps", True
        why = "Without instantaneous compliance there is no step, and both are one."
    elif n > 1:
        allowed, claim = (1,), f"w continuous is one condition and leaves {open_conditions} of {n} open"
        holding = open_conditions == n - 1 > 0
        why = "With several relaxation times, w continuous does not determine the states: only the law itself does."
    else:
        allowed, claim, holding = (1,), "w continuous is one condition on one state", open_conditions == 0
        why = "With one relaxation time either determines the state; the solver of the standard linear solid has both."
    return derived(
        closures,
        allowed,
        name=name,
        statement="The paper does not say what w does where p steps. Its vanishing friction at very high speed needs w "
        "continuous; "
        f"the law itself asks for a step. {why}",
        latex=r"[w] = J_0 [p],\quad [z_j] = 0",
        checks=[holds(name, claim, holding)],
    )
