"""The material's law with any number of relaxation times: a spring beside branches; which models are such solids."""

import sympy as sp

from ..check import Claim, Derived, derived, holds, zero
from ..model import Model, Roots, inadmissible, omega, rate, refuse, rounded_to_zero
from ..paper.record import CORRECTIONS
from ..symbols import K, beta

K_i, tau_i, eta_i = sp.symbols("K_i tau_i eta_i", positive=True)
BRANCH = eta_i * rate / (1 + tau_i * rate)
"""What a branch adds to p/w over K."""
VISCOSITY = K_i * tau_i / K
"""Its eta_i, by its modulus and its time."""


def foundation_law() -> Derived:
    r"""Eq. 1: The foundation is local: at each material point its displacement w and pressure p obey one linear
    equation in time, here with a state for each relaxation time.

    .. math:: p = K w + \sum_i K_i (w - e_i),\quad \tau_i \frac{d e_i}{dt} + e_i = w
    """
    time = sp.Symbol("t", real=True)
    w, e = (sp.Function(letter)(time) for letter in ("w", "e_i"))
    branch = tau_i * sp.diff(e, time) + e - w
    answer = {w: sp.exp(rate * time), e: sp.exp(rate * time) / (1 + tau_i * rate)}
    force = K_i * (w - e).subs(answer) * sp.exp(-rate * time)
    checks = [
        zero("a dashpot answers w = exp(rate t) with e_i = w/(1 + tau_i rate)", branch.subs(answer).doit()),
        zero(
            "and its branch carries K eta_i rate/(1 + tau_i rate) w, eta_i = K_i tau_i/K",
            sp.simplify(force - K * BRANCH.subs(eta_i, VISCOSITY)),
        ),
    ]
    return derived(foundation_law, (w - e, branch), checks)


def relaxed_stiffness(model: Model) -> Derived:
    r"""Eq. 1: At rest p = K w, so K is a stiffness per area (Pa/m).

    .. math:: K = Q_0/P_0
    """
    stiffness = model.series.K
    load, any_stiffness = sp.symbols("p stiffness", positive=True)
    checks = [
        zero("at rest no branch carries anything: p = K w", BRANCH.subs(rate, 0)),
        holds("a larger K deforms less: K is a stiffness", sp.diff(load / any_stiffness, any_stiffness).is_negative),
    ]
    return derived(relaxed_stiffness, stiffness, checks, latex=rf"K = {sp.latex(stiffness)}", correction=CORRECTIONS[1])


def prony_series(model: Model) -> Derived:
    r"""The foundation is a spring K beside branches, each a dashpot (displacement e_i) in line with a spring K_i. A
    branch without spring, tau_i = 0, is a bare dashpot.

    .. math:: K^*(s) = K\left(1 + \sum_i \frac{\eta_i s}{1 + \tau_i s}\right),\quad \eta_i = \frac{K_i \tau_i}{K}
    """
    series = model.series
    if isinstance(series, Roots):
        return series_of_roots(model, series)
    stated = series.K * BRANCH.subs({eta_i: series.viscosity, tau_i: series.time}, simultaneous=True)
    viscous = sp.limit(stated / rate, rate, 0)
    checks = [
        zero("its loss at low rates is K eta_i rate", viscous - series.K * series.viscosity),
        holds(
            "its stiffness at high rates is K eta_i/tau_i, or it is a bare dashpot",
            series.time == 0 or sp.cancel(sp.limit(stated, rate, sp.oo) - series.K * series.viscosity / series.time) == 0,
        ),
    ]
    if model.Q:
        checks.append(zero("spring and branch are what the operators say: p/w = Q/P", series.K + stated - model.transfer()))
    return derived(prony_series, stated, checks, "Prony series")


def series_of_roots(model: Model, series: Roots) -> Derived:
    r"""The operators are those of a spring K beside branches, each a dashpot in line with a spring, if and only if the roots of P
    and Q are real, negative and interlaced. They are found when the parameters are numbers.

    .. math:: \sum_k (-1)^k Q_k \lambda_j^{n-k} = 0,\quad \sum_k (-1)^k P_k \tau_i^{n-k} = 0,\quad \eta_i = (\lambda_i -
        \tau_i)\prod_{k \ne i}\frac{\lambda_k - \tau_i}{\tau_k - \tau_i}
    """
    n = model.modes or 0
    coefficients = sp.symbols(f"c_0:{n + 1}", positive=True)
    operator = sum(c * rate**k for k, c in enumerate(coefficients))
    turned = sum((-1) ** k * c * beta ** (n - k) for k, c in enumerate(coefficients))
    checks = [
        zero(
            "with T = -1/root an operator is sum_k (-1)^k c_k T^(n-k), over T^n",
            operator.subs(rate, -1 / beta) * beta**n - turned,
        ),
        holds("K = Q_0/P_0", sp.cancel(series.K - model.Q[0] / model.P[0]) == 0),
    ]
    return derived(series_of_roots, series.K, checks, "Prony series")


def admissibility(model: Model) -> Derived:
    r"""The model carries a constant load at rest, forgets its past, and never gives out energy in a cycle. Between two relaxation
    times, and above the largest, lies one retardation time.

    .. math:: K > 0,\quad \eta_i \ge 0,\quad \tau_i \ge 0,\qquad \tau_1 \le \lambda_1 \le \tau_2 \le \lambda_2 \le \dots
    """
    refuse(model, inadmissible_series(model))
    time = sp.Symbol("tau_i", nonnegative=True)
    loss = sp.simplify(sp.im(sp.expand_complex(BRANCH.subs(tau_i, time).subs(rate, sp.I * omega))))
    claimed = eta_i * omega / (1 + time**2 * omega**2)
    checks = [
        holds("solid-like: K > 0 carries a constant load at rest", sp.factor(model.series.K).is_positive),
        zero("passive: every branch loses eta_i omega/(1 + tau_i^2 omega^2)", sp.simplify(loss - claimed)),
        holds("passive: which is not negative", claimed.is_nonnegative),
        *_interlaced(),
    ]
    return derived(admissibility, True, checks)


def _interlaced() -> list[Claim]:
    """The stiffness vanishes at -1/lambda where sum eta_i/(lambda - tau_i) = 1: a sum of terms that fall from pole to pole."""
    time = sp.Symbol("lambda", real=True)
    term = eta_i / (time - tau_i)
    return [
        zero("p/w vanishes at -1/lambda where sum_i eta_i/(lambda - tau_i) = 1", BRANCH.subs(rate, -1 / time) + term),
        holds(
            "stable: from each tau_i to the next every term falls, all together from oo to -oo: one lambda; above the largest "
            "from oo to 0: one lambda; below the least all are negative: none. So there are n, and each is positive",
            sp.factor(-sp.diff(term, time) * (time - tau_i) ** 2).is_positive
            and (sp.limit(term, time, tau_i, "+"), sp.limit(term, time, tau_i, "-"), sp.limit(term, time, sp.oo))
            == (sp.oo, -sp.oo, 0),
        ),
    ]


def inadmissible_series(model: Model) -> list[str]:
    """The reasons against a model with a Prony series; none for an admissible one."""
    series = model.series
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


NEAR = 2.0**-20  # roots nearer to each other, relative, are one: roundings move equal ones by some 1e-8


def _not_interlaced(model: Model) -> list[str]:
    """The reason against operators whose coefficients are numbers and whose times are not real and interlaced."""
    if any(sp.sympify(c).free_symbols for c in (*model.Q, *model.P)):
        return []
    floats = lambda c: c.replace(lambda part: part.is_Float, sp.Rational)  # noqa: E731  to have roots with all their digits
    exact = {kind: [floats(sp.sympify(c)) for c in operator] for kind, operator in (("Q", model.Q), ("P", model.P))}
    operators = {kind: sp.Poly(sum(c * rate**n for n, c in enumerate(exact[kind])), rate) for kind in "QP"}
    vanishes = lambda kind, root: rounded_to_zero(c * root**n for n, c in enumerate(exact[kind]))  # noqa: E731
    Q, P = (operators[kind].real_roots() for kind in "QP")
    for kind, roots, others in (("P", P, Q), ("Q", Q, P)):
        lost = operators[kind].degree() - len(roots)  # two equal ones may have come out complex, at one of the other operator
        met = [root for root in others if lost and vanishes(kind, root) and all(abs(1 - each / root) > NEAR for each in roots)]
        roots += 2 * met[: lost // 2]
    met = sorted([(root, "Q") for root in Q] + [(root, "P") for root in P], reverse=True)  # largest times first
    n = len(model.Q) - 1
    alternate = ("QP" * n)[: len(met)]
    for k in range(len(met) - 1):  # equal times of an idle branch may have come out in the other order
        one, other = met[k : k + 2]
        if other[1] == alternate[k] != one[1] and (vanishes(other[1], one[0]) or vanishes(one[1], other[0])):
            met[k : k + 2] = other, one
    order = "".join(kind for _, kind in met)
    if len(Q) == n and order == alternate and len(P) >= n - 1:
        return []
    return [
        "passive: the relaxation and retardation times, -1/roots of P and Q, must be real and alternate, a retardation "
        "time the largest"
    ]
