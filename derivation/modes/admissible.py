"""Which models are solids that can be derived: solid-like, stable, passive."""

from __future__ import annotations

import itertools

import sympy as sp

from ..check import Check, DerivationError, Derived, derived, holds
from ..model import Model, Roots, inadmissible, rate
from .identity import vanishes
from .material import series_of


def admissibility(model: Model) -> Derived:
    r"""Solid-like, stable, passive: :math:`\mathrm{Im}\,K^* = K\sum_i \frac{\eta_i\omega}{1 + \tau_i^2\omega^2} \ge 0`."""
    name = "admissibility"
    reasons = inadmissible_series(model)
    if reasons:
        raise DerivationError(name, f"model {model.name!r} is refused: " + "; ".join(reasons))
    frequency, viscosity = sp.symbols("omega eta_i", positive=True)
    time = sp.Symbol("tau_i", nonnegative=True)
    term = sp.I * viscosity * frequency / (1 + sp.I * time * frequency)
    loss = sp.simplify(sp.im(sp.expand_complex(term)))
    claimed = viscosity * frequency / (1 + time**2 * frequency**2)
    checks = [
        holds(name, "solid-like: K > 0 carries a constant load at rest", sp.factor(series_of(model).K).is_positive),
        vanishes(name, "passive: every branch loses eta_i omega/(1 + tau_i^2 omega^2)", [loss - claimed], 1),
        holds(name, "passive: which is not negative", claimed.is_nonnegative),
        *_retardation_times_interlace(name, model.modes),
    ]
    return derived(
        admissibility,
        True,
        name=name,
        statement="The model carries a constant load at rest, forgets its past, and never gives out energy in a cycle. "
        "Between two "
        "relaxation times, and above the largest, lies one retardation time.",
        latex=r"K > 0,\quad \eta_i \ge 0,\quad \tau_i \ge 0,\qquad \tau_1 \le \lambda_1 \le \tau_2 \le \lambda_2 \le \dots",
        checks=checks,
    )


def inadmissible_series(model: Model) -> list[str]:
    """The reasons against a model of this pipeline; none for an admissible one."""
    series = series_of(model)
    if isinstance(series, Roots):
        return inadmissible(model) or _not_interlaced(model)
    reasons = []
    if not sp.sympify(series.K).is_positive:
        reasons.append("solid-like: K must be positive, so that a constant load is carried at rest")
    if not sp.sympify(series.viscosity).is_nonnegative:
        reasons.append("passive: eta_i = K_i tau_i/K must not be negative: a branch would give out energy in every cycle")
    if not sp.sympify(series.time).is_nonnegative:
        reasons.append("stable: tau_i must not be negative: a branch would grow in time")
    return reasons


def _not_interlaced(model: Model) -> list[str]:
    """The reason against operators whose coefficients are numbers and whose times are not real and interlaced."""
    if any(sp.sympify(c).free_symbols for c in (*model.Q, *model.P)):
        return []
    Q, P = (sp.Poly(operator, rate).real_roots() for operator in (model.operator_w(), model.operator_p()))
    met = sorted(
        [(root, "Q") for root in Q] + [(root, "P") for root in P], reverse=True
    )  # from 0 to the left: largest times first
    order = "".join(kind for _, kind in met)
    if len(Q) == model.modes and order == ("QP" * model.modes)[: len(order)] and len(P) >= model.modes - 1:
        return []
    return [
        "passive: the relaxation and retardation times, -1/roots of P and Q, must be real and alternate, a retardation "
        "time the largest"
    ]


def _retardation_times_interlace(name: str, n: int) -> list[Check]:
    """Q has one root -1/lambda_j between -1/tau_j and -1/tau_(j+1): its sign alternates there."""
    steps = [sp.Symbol(f"step_{k}", positive=True) for k in range(n)]
    times = list(itertools.accumulate(steps))
    viscosities = sp.symbols(f"eta_1:{n + 1}", positive=True)
    signs = []
    for i, time in enumerate(times):
        at = -1 / time
        others = sp.Mul(*(sp.factor(1 + other * at) for k, other in enumerate(times) if k != i))
        value = sp.factor(viscosities[i] * at) * others  # Q/K at -1/tau_i: only the branch's own term is left
        signs.append(sp.sign(value))
    expected = [sp.Integer(-1) ** (n - i) for i in range(n)]
    return [
        holds(name, "stable: Q changes its sign from each -1/tau_i to the next, and is positive at 0", signs == expected),
    ]
