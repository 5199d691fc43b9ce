"""The law of a foundation with n relaxation times: Prony series, factored operators, and the two sets of states.

Within a strip the two sets of times are symbols, the relaxation times ``alpha_i`` (roots of P) and the retardation times
``beta_j`` (roots of Q), interlaced: everything else is rational in them.
"""

from __future__ import annotations

import itertools
import random
from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Any

import sympy as sp

from ..check import BEYOND, CORRECTED, REPRODUCED, Check, DerivationError, Derived, derived, holds
from ..model import Model, Roots, Series, inadmissible, rate
from ..symbols import alpha, beta
from .symbols import J_0, J, S, enter, eta, leave, numbered, share
from .tensor import Values

SYMBOLIC = 3  # up to so many modes identities between modes are proven in symbols, beyond at exact rational points
POINTS = 12


@dataclass(frozen=True)
class Law:
    """Stages 1 and 2 for n modes. ``values``: each numbered quantity of a strip, rational in the times."""

    model: Model
    foundation: Derived
    relaxed: Derived
    series: Derived
    admissible: Derived
    factored: Derived
    weights: Derived
    states: Derived
    values: Values = field(compare=False, repr=False)

    @property
    def modes(self) -> int:
        return self.model.modes

    @property
    def operators(self) -> tuple[sp.Expr, sp.Expr]:
        """(Q, P) of the strip as polynomials in the derivative."""
        return self.factored.value


def law(model: Model) -> Law:
    n = model.modes
    admissible = admissibility(model)
    times = strip_times(n)
    weights = branch_weights(times)
    values = strip_values(times, weights.value)
    return Law(
        model,
        foundation_law(model),
        relaxed_stiffness(model),
        prony_series(model),
        admissible,
        factored_operators(model, times),
        weights,
        coordinates(times, values),
        values,
    )


def vanishes(name: str, claim: str, residuals: Sequence[sp.Expr], n: int) -> Check:
    """Verify that rational expressions vanish: in symbols up to ``SYMBOLIC`` modes, beyond at exact rational points."""
    if n <= SYMBOLIC:
        for residual in residuals:
            if sp.cancel(sp.together(residual)) != 0:
                raise DerivationError(name, claim, residual)
        return Check(claim, "exact zero")
    symbols = sorted(set().union(*(sp.sympify(r).free_symbols for r in residuals)), key=str)
    draw = random.Random(f"{name} {claim} {n}")
    for _ in range(POINTS):
        point = {symbol: sp.Rational(draw.getrandbits(40) + 1, draw.getrandbits(20) + 1) for symbol in symbols}
        for residual in residuals:
            if sp.expand(sp.sympify(residual).xreplace(point), complex=True) != 0:
                raise DerivationError(name, claim, residual)
    return Check(claim, f"exact zero at {POINTS} random rational points")


# -- the material ---------------------------------------------------------------------------------------------------------


def foundation_law(model: Model) -> Derived:
    r"""Eq. 1 with n relaxation times: :math:`\sum_k Q_k \partial_t^k w = \sum_k P_k \partial_t^k p`."""
    name = "foundation law"
    ratio = model.transfer()
    checks = [
        vanishes(
            name,
            "w = exp(rate t), p = (Q/P) w solves the law for any rate",
            [model.operator_w() - ratio * model.operator_p()],
            model.modes,
        )
    ]
    return derived(
        foundation_law,
        (model.Q, model.P),
        name=name,
        statement="The foundation is local: at each material point its displacement w and pressure p obey one linear equation in "
        f"time, here of order {model.modes}.",
        latex=r"\sum_{k=0}^{n} Q_k\,\frac{d^k w}{dt^k} = \sum_{k=0}^{n} P_k\,\frac{d^k p}{dt^k}",
        checks=checks,
        paper="Eq. 1",
        status=REPRODUCED,
    )


def relaxed_stiffness(model: Model) -> Derived:
    r"""Eq. 1 at rest: :math:`p = K w`, :math:`K = Q_0/P_0`."""
    name = "relaxed stiffness"
    stiffness = sp.cancel(model.Q[0] / model.P[0])
    load, any_stiffness = sp.symbols("p stiffness", positive=True)
    checks = [
        vanishes(
            name,
            "w = p/K is at rest under the constant pressure p",
            [model.Q[0] * load / stiffness - model.P[0] * load],
            model.modes,
        ),
        holds(name, "a larger K deforms less: K is a stiffness", sp.diff(load / any_stiffness, any_stiffness).is_negative),
    ]
    return derived(
        relaxed_stiffness,
        stiffness,
        name=name,
        statement="At rest p = K w, so K is a stiffness per area (Pa/m).",
        latex=rf"K = Q_0/P_0 = {sp.latex(stiffness)}",
        checks=checks,
        paper="Eq. 1",
        status=CORRECTED,
        correction="The paper calls K the elastic compliance of the foundation. Its own law gives p = K w at rest: K is a "
        "stiffness. Read as a compliance it would invert every pressure.",
    )


def series_of(model: Model) -> Series | Roots:
    if model.series is None:
        raise DerivationError("prony series", f"model {model.name!r} states its Prony series, or leaves it to the roots")
    return model.series


def prony_series(model: Model) -> Derived:
    r"""Maxwell branches beside a spring: :math:`p = K w + \sum_i K_i (w - e_i)`, :math:`\tau_i \dot e_i + e_i = w`."""
    name = "Prony series"
    series = series_of(model)
    if isinstance(series, Roots):
        return series_of_roots(model)
    branches = [series.of_branch(number) for number in range(1, model.modes + 1)]
    stated = series.K * (1 + sp.Add(*(v * rate / (1 + time * rate) for v, time in branches)))
    checks = [vanishes(name, "Q/P is the series", [model.operator_w() - stated * model.operator_p()], model.modes)]
    return derived(
        prony_series,
        stated,
        name=name,
        statement="The foundation is a spring K beside branches, each a dashpot (displacement e_i) in line with a spring K_i. A "
        "branch without spring, tau_i = 0, is a bare dashpot.",
        latex=r"\frac{p}{w}(s) = K\left(1 + \sum_i \frac{\eta_i s}{1 + \tau_i s}\right),\quad \eta_i = \frac{K_i \tau_i}{K}",
        checks=checks,
    )


def series_of_roots(model: Model) -> Derived:
    r"""Branches from the roots: :math:`P(-1/\tau_i) = 0`, :math:`Q(-1/\lambda_j) = 0`, :math:`\eta_i` a product of "
    r"differences."""
    name = "Prony series"
    n = model.modes
    times = strip_times(n)
    Q = sp.Poly(sp.Mul(*(1 + time * rate for time in times.beta)), rate)
    at_root = [sum((-1) ** k * c * time ** (n - k) for (k,), c in Q.terms()) for time in times.beta]
    checks = [
        vanishes(name, "a retardation time is a root of sum_k (-1)^k Q_k lambda^(n-k); a relaxation time one of P", at_root, n),
        holds(name, "K = Q_0/P_0", sp.cancel(series_of(model).K - model.Q[0] / model.P[0]) == 0),
    ]
    return derived(
        series_of_roots,
        series_of(model).K,
        name=name,
        statement="The operators are those of a spring K beside branches, each a dashpot in line with a spring, if and "
        "only if the roots "
        "of P and Q are real, negative and interlaced. They are found when the parameters are numbers.",
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


# -- the strip --------------------------------------------------------------------------------------------------------------


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
