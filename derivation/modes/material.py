"""The material's law with any number of relaxation times: a spring beside branches; which models are such solids."""

from __future__ import annotations

import sympy as sp

from ..check import Check, DerivationError, Derived, derived, holds, zero
from ..model import Model, Roots, Series, inadmissible, law_record, omega, rate, stiffness_record
from ..symbols import K, beta

K_i, tau_i, eta_i = sp.symbols("K_i tau_i eta_i", positive=True)
BRANCH = eta_i * rate / (1 + tau_i * rate)
"""What a branch adds to p/w over K."""


def foundation_law(model: Model) -> Derived:
    r"""Eq. 1 with n relaxation times: :math:`p = K w + \sum_i K_i (w - e_i)`, :math:`\tau_i \dot e_i + e_i = w`."""
    name = "foundation law"
    time = sp.Symbol("t", real=True)
    w, e = (sp.Function(letter)(time) for letter in ("w", "e_i"))
    branch = tau_i * sp.diff(e, time) + e - w
    answer = {w: sp.exp(rate * time), e: sp.exp(rate * time) / (1 + tau_i * rate)}
    force = K_i * (w - e).subs(answer) * sp.exp(-rate * time)
    checks = [
        zero(name, "a dashpot answers w = exp(rate t) with e_i = w/(1 + tau_i rate)", branch.subs(answer).doit()),
        zero(
            name,
            "and its branch carries K eta_i rate/(1 + tau_i rate) w, eta_i = K_i tau_i/K",
            sp.simplify(force - K * BRANCH.subs(eta_i, K_i * tau_i / K)),
        ),
    ]
    latex = r"p = K w + \sum_i K_i (w - e_i),\quad \tau_i \frac{d e_i}{dt} + e_i = w"
    return law_record(foundation_law, (w - e, branch), latex, checks, ", here with a state for each relaxation time")


def relaxed_stiffness(model: Model) -> Derived:
    r"""Eq. 1 at rest: :math:`p = K w`, :math:`K = Q_0/P_0`."""
    name = "relaxed stiffness"
    series = series_of(model)
    stiffness = sp.cancel(model.Q[0] / model.P[0]) if isinstance(series, Roots) else series.K
    load, any_stiffness = sp.symbols("p stiffness", positive=True)
    checks = [
        zero(name, "at rest no branch carries anything: p = K w", BRANCH.subs(rate, 0)),
        holds(name, "the K of the series is that of the operators", sp.cancel(series.K - stiffness) == 0),
        holds(name, "a larger K deforms less: K is a stiffness", sp.diff(load / any_stiffness, any_stiffness).is_negative),
    ]
    return stiffness_record(relaxed_stiffness, stiffness, rf"K = {sp.latex(stiffness)}", checks)


def series_of(model: Model) -> Series | Roots:
    if model.series is None:
        raise DerivationError("prony series", f"model {model.name!r} states its Prony series, or leaves it to the roots")
    return model.series


def prony_series(model: Model) -> Derived:
    r"""Maxwell branches beside a spring:

    .. math:: \frac pw(s) = K\left(1 + \sum_i \frac{\eta_i s}{1 + \tau_i s}\right)
    """
    name = "Prony series"
    series = series_of(model)
    if isinstance(series, Roots):
        return series_of_roots(model, series)
    stated = series.K * BRANCH.subs({eta_i: series.viscosity, tau_i: series.time}, simultaneous=True)
    viscous = sp.limit(stated / rate, rate, 0)
    checks = [
        zero(name, "its loss at low rates is K eta_i rate", viscous - series.K * series.viscosity),
        holds(
            name,
            "its stiffness at high rates is K eta_i/tau_i, or it is a bare dashpot",
            series.time == 0 or sp.cancel(sp.limit(stated, rate, sp.oo) - series.K * series.viscosity / series.time) == 0,
        ),
    ]
    return derived(
        prony_series,
        stated,
        name=name,
        statement="The foundation is a spring K beside branches, each a dashpot (displacement e_i) in line with a spring K_i. A "
        "branch without spring, tau_i = 0, is a bare dashpot.",
        latex=r"K^*(s) = K\left(1 + \sum_i \frac{\eta_i s}{1 + \tau_i s}\right),\quad \eta_i = \frac{K_i \tau_i}{K}",
        checks=checks,
    )


def series_of_roots(model: Model, series: Roots) -> Derived:
    r"""Branches from the roots of P and Q, :math:`P(-1/\tau_i) = Q(-1/\lambda_j) = 0`; eta_i is a product of differences."""
    name = "Prony series"
    n = model.modes or 0
    coefficients = sp.symbols(f"c_0:{n + 1}", positive=True)
    operator = sum(c * rate**k for k, c in enumerate(coefficients))
    turned = sum((-1) ** k * c * beta ** (n - k) for k, c in enumerate(coefficients))
    checks = [
        zero(
            name,
            "with T = -1/root an operator is sum_k (-1)^k c_k T^(n-k), over T^n",
            operator.subs(rate, -1 / beta) * beta**n - turned,
        ),
        holds(name, "K = Q_0/P_0", sp.cancel(series.K - model.Q[0] / model.P[0]) == 0),
    ]
    return derived(
        series_of_roots,
        series.K,
        name=name,
        statement="The operators are those of a spring K beside branches, each a dashpot in line with a spring, if and "
        "only if the roots of P and Q are real, negative and interlaced. They are found when the parameters are numbers.",
        latex=r"\sum_k (-1)^k Q_k \lambda_j^{n-k} = 0,\quad \sum_k (-1)^k P_k \tau_i^{n-k} = 0,\quad "
        r"\eta_i = (\lambda_i - \tau_i)\prod_{k \ne i}\frac{\lambda_k - \tau_i}{\tau_k - \tau_i}",
        checks=checks,
    )


def admissibility(model: Model) -> Derived:
    r"""Solid-like, stable, passive: :math:`\mathrm{Im}\,K^* = K\sum_i \frac{\eta_i\omega}{1 + \tau_i^2\omega^2} \ge 0`."""
    name = "admissibility"
    reasons = inadmissible_series(model)
    if reasons:
        raise DerivationError(name, f"model {model.name!r} is refused: " + "; ".join(reasons))
    time = sp.Symbol("tau_i", nonnegative=True)
    loss = sp.simplify(sp.im(sp.expand_complex(BRANCH.subs(tau_i, time).subs(rate, sp.I * omega))))
    claimed = eta_i * omega / (1 + time**2 * omega**2)
    checks = [
        holds(name, "solid-like: K > 0 carries a constant load at rest", sp.factor(series_of(model).K).is_positive),
        zero(name, "passive: every branch loses eta_i omega/(1 + tau_i^2 omega^2)", sp.simplify(loss - claimed)),
        holds(name, "passive: which is not negative", claimed.is_nonnegative),
        *_interlaced(name),
    ]
    return derived(
        admissibility,
        True,
        name=name,
        statement="The model carries a constant load at rest, forgets its past, and never gives out energy in a cycle. "
        "Between two relaxation times, and above the largest, lies one retardation time.",
        latex=r"K > 0,\quad \eta_i \ge 0,\quad \tau_i \ge 0,\qquad \tau_1 \le \lambda_1 \le \tau_2 \le \lambda_2 \le \dots",
        checks=checks,
    )


def _interlaced(name: str) -> list[Check]:
    """The stiffness vanishes at -1/lambda where sum eta_i/(lambda - tau_i) = 1: a sum of terms that fall from pole to pole."""
    time = sp.Symbol("lambda", real=True)
    term = eta_i / (time - tau_i)
    return [
        zero(name, "p/w vanishes at -1/lambda where sum_i eta_i/(lambda - tau_i) = 1", BRANCH.subs(rate, -1 / time) + term),
        holds(
            name,
            "stable: from each tau_i to the next every term falls, all together from oo to -oo: one lambda; above the largest "
            "from oo to 0: one lambda; below the least all are negative: none. So there are n, and each is positive",
            sp.diff(term, time).is_nonpositive is not False
            and sp.factor(-sp.diff(term, time) * (time - tau_i) ** 2).is_positive
            and (sp.limit(term, time, tau_i, "+"), sp.limit(term, time, tau_i, "-"), sp.limit(term, time, sp.oo))
            == (sp.oo, -sp.oo, 0),
        ),
    ]


def inadmissible_series(model: Model) -> list[str]:
    """The reasons against a model with a Prony series; none for an admissible one."""
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
    met = sorted([(root, "Q") for root in Q] + [(root, "P") for root in P], reverse=True)  # largest times first
    order, n = "".join(kind for _, kind in met), len(model.Q) - 1
    if len(Q) == n and order == ("QP" * n)[: len(order)] and len(P) >= n - 1:
        return []
    return [
        "passive: the relaxation and retardation times, -1/roots of P and Q, must be real and alternate, a retardation "
        "time the largest"
    ]
