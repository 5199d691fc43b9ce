"""A viscoelastic model is data: a name, parameters, and the two operators of ``Q(d/dt) w = P(d/dt) p``."""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from itertools import product

import sympy as sp

from .check import Claim, DerivationError, Derived, derived, holds, zero
from .membership import constant_coefficients
from .paper.record import CORRECTIONS
from .symbols import rate

omega = sp.Symbol("omega", positive=True)
ROUNDING = sp.Rational(1, 2**50)  # of a coefficient of an operator: a few operations, as the emitted solver allows


@dataclass(frozen=True)
class Parameter:
    """A material constant: its symbol, its name in Python, unit and meaning."""

    symbol: sp.Symbol
    name: str
    unit: str
    meaning: str


@dataclass(frozen=True)
class Series:
    """The Prony series of a model, ``p/w = K (1 + sum_i eta_i s/(1 + tau_i s))``, one term per relaxation time.

    ``viscosity`` is eta_i = K_i tau_i/K in seconds and stays finite for a dashpot, tau_i = 0; ``time`` is tau_i. Both are given
    for one generic branch, in the model's parameters, of which those in ``arrays`` have one value per branch.
    """

    K: sp.Symbol
    viscosity: sp.Expr
    time: sp.Expr
    arrays: tuple[sp.Symbol, ...] = ()


@dataclass(frozen=True)
class Roots:
    """The Prony series of a model given by its operators alone: taken from their roots, once its parameters are numbers."""

    K: sp.Expr


@dataclass(frozen=True)
class Model:
    """``sum_n Q[n] d^n w/dt^n = sum_n P[n] d^n p/dt^n``.

    A model with arrays in its ``series`` states no operators, but ``count``, its number of relaxation times; None for any.
    ``differences`` writes parameters as sums of nonnegative ones, so that an inequality the model asks of its parameters
    (``T_eps >= T_sigma``) holds by construction where admissibility is checked. A model with ``series`` is derived for a generic
    one of its modes.
    """

    name: str
    title: str
    parameters: tuple[Parameter, ...]
    Q: tuple[sp.Expr, ...]
    P: tuple[sp.Expr, ...]
    differences: tuple[tuple[sp.Symbol, sp.Expr], ...] = ()
    series: Series | Roots | None = None
    count: int | None = None

    @property
    def modes(self) -> int | None:
        """Number of relaxation times, the internal states of a material point; None: any number, read by the solver."""
        return self.count if isinstance(self.series, Series) and self.series.arrays else len(self.Q) - 1

    @property
    def stated(self) -> bool:
        """Whether the model states its Prony series."""
        return isinstance(self.series, Series)

    @property
    def springy(self) -> bool:
        """Whether there is an instantaneous compliance: no bare dashpot."""
        return bool(self.series.time != 0) if isinstance(self.series, Series) else bool(self.P[-1] != 0)

    def operator_w(self, step: sp.Expr = rate) -> sp.Expr:
        return _at(self.Q, step)

    def operator_p(self, step: sp.Expr = rate) -> sp.Expr:
        return _at(self.P, step)

    def transfer(self, step: sp.Expr = rate) -> sp.Expr:
        """Stiffness ``p/w`` of a motion ``exp(rate t)``."""
        return self.operator_w(step) / self.operator_p(step)


@dataclass(frozen=True)
class Foundation:
    """An admissible model and what its operators say at once."""

    model: Model
    operators: Derived
    relaxed: Derived  # K = p/w at rest
    compliance: Derived  # J_0: instantaneous w/p
    admissible: Derived

    @property
    def K(self) -> sp.Expr:
        return self.relaxed.value

    @property
    def J_0(self) -> sp.Expr:
        return self.compliance.value


def foundation(model: Model) -> Foundation:
    """First stage: read the operators; refuse a model that is no passive, stable solid."""
    return Foundation(
        model, foundation_law(model), relaxed_stiffness(model), instantaneous_compliance(model), admissibility(model)
    )


def foundation_law(model: Model) -> Derived:
    r"""Eq. 1: The foundation is local: at each material point its displacement w and pressure p obey one linear equation in time.

    .. math:: w + T_\epsilon \dot w = (p + T_\sigma \dot p)/K
    """
    time = sp.Symbol("t", real=True)
    w, p = sp.Function("w")(time), sp.Function("p")(time)
    checks = [constant_coefficients(model)]
    equation = sp.Eq(applied(model.Q, w, time), applied(model.P, p, time))
    return derived(foundation_law, equation, checks, latex=sp.latex(equation))


def relaxed_stiffness(model: Model) -> Derived:
    r"""Eq. 1: At rest p = K w, so K is a stiffness per area (Pa/m).

    .. math:: K = \lim_{\omega\to 0} K^*(i\omega)
    """
    stiffness = sp.limit(model.transfer(), rate, 0)
    load = sp.Symbol("p", positive=True)
    at_rest = model.Q[0] * (load / stiffness) - model.P[0] * load
    softer = sp.diff(load / stiffness, model.parameters[0].symbol)
    checks = [
        zero("w = p/K is at rest under the constant pressure p", at_rest),
        holds("a larger K deforms less: K is a stiffness", softer.is_negative),
    ]
    latex = rf"K = \lim_{{\omega\to 0}} K^*(i\omega) = {sp.latex(stiffness)}"
    return derived(relaxed_stiffness, stiffness, checks, latex=latex, correction=CORRECTIONS[1])


def instantaneous_compliance(model: Model) -> Derived:
    r"""A sudden pressure step is answered at once by a step of displacement, J_0 times as large.

    .. math:: J_0 = \lim_{s\to\infty} P(s)/Q(s) = T_\sigma/(K T_\epsilon)
    """
    compliance = sp.limit(1 / model.transfer(), rate, sp.oo)
    top = len(model.Q) - 1
    checks = [zero("J_0 Q_n = P_n: the highest derivatives balance", compliance * model.Q[top] - model.P[top])]
    if top == 1:
        checks.append(_creep(model, compliance))
    return derived(
        instantaneous_compliance,
        compliance,
        checks,
        latex=rf"J_0 = \lim_{{s\to\infty}} \frac{{P(s)}}{{Q(s)}} = {sp.latex(compliance)}",
    )


def _creep(model: Model, compliance: sp.Expr) -> Claim:
    """The law solved by SymPy under a pressure that is put on at once."""
    time, load = sp.symbols("t p", positive=True)
    w = sp.Function("w")
    law = sp.Eq(applied(model.Q, w(time), time), model.P[0] * load)
    crept = sp.dsolve(law, w(time), ics={w(0): compliance * load}).rhs
    claim = "put under p at once, w creeps from J_0 p to p/K, with 1/K = P(0)/Q(0)"
    left = [crept.subs(time, 0) - compliance * load, sp.limit(crept, time, sp.oo) - load / model.transfer(sp.Integer(0))]
    return zero(claim, left)


def admissibility(model: Model) -> Derived:
    r"""The model carries a constant load at rest, forgets its past, and never gives out energy in a cycle.

    .. math:: 0 < K < \infty,\quad \mathrm{Re}\,s_i < 0,\quad \mathrm{Im}\,K^*(i\omega) \ge 0
    """
    reasons = inadmissible(model)
    checks = tuple(holds(claim, not [r for r in reasons if r.startswith(claim)]) for claim in ("solid-like", "stable", "passive"))
    return derived(admissibility, True, checks)


def inadmissible(model: Model) -> list[str]:
    """The reasons why a model is refused; none for an admissible one."""
    reasons = []
    if len(model.P) != len(model.Q):
        reasons.append(f"solid-like: P has {len(model.P)} coefficients and Q {len(model.Q)}; pad the shorter with zeros")
        return reasons
    differences = dict(model.differences)
    Q, P = ([sp.expand(sp.sympify(c).subs(differences)) for c in op] for op in (model.Q, model.P))
    if not (Q[0].is_positive and P[0].is_positive):
        reasons.append("solid-like: Q(0) and P(0) must be positive, so that a constant load is carried at rest")
    if not Q[-1].is_positive:
        reasons.append("stable: the highest coefficient of Q must be positive")
    for label, operator in (("Q", Q), ("P", P)):
        if any(c.is_negative for c in operator):
            reasons.append(f"stable: {label} has a negative coefficient, so a motion that grows in time")
        elif unknown := [c for c in operator if not _nonnegative(c)]:
            reasons.append(
                f"stable: {label} has the coefficient {unknown[0]}, which may be negative: are its symbols declared positive?"
            )
    if isinstance(model.series, Roots) and any(c.free_symbols for c in (*Q, *P)):
        return reasons  # the rest depends on the numbers: the emitted solver refuses those that are no passive solid
    if not reasons and len(Q) > 3:  # up to degree 2 positive coefficients suffice
        reasons += _unstable_roots(Q, "Q") + _unstable_roots(P, "P")
    if not all(_nonnegative(sum(terms)) or rounded_to_zero(terms) for terms in _loss(Q, P)):
        reasons.append("passive: Im K*(i omega) is not shown to be nonnegative at every frequency")
    return reasons


def refuse(model: Model, reasons: list[str]) -> None:
    """Raise an error that names every reason against the model, if there is any."""
    if reasons:
        raise DerivationError("admissibility", f"model {model.name!r} is refused: " + "; ".join(reasons))


def _loss(Q: Sequence[sp.Expr], P: Sequence[sp.Expr]) -> Iterable[list[sp.Expr]]:
    """The terms of each coefficient of Im Q(i omega) conj P(i omega), by powers of omega."""
    powers: dict[int, list[sp.Expr]] = {}
    for (n, q), (m, p) in product(enumerate(Q), enumerate(P)):
        powers.setdefault(n + m, []).append(q * p * sp.im(sp.I**n * (-sp.I) ** m))
    return powers.values()


def rounded_to_zero(terms: Iterable[sp.Expr]) -> bool:
    """Whether numbers add up to no more than roundings of them make of zero."""
    numbers = [sp.N(term, 60) for term in terms]
    return all(each.is_number for each in numbers) and bool(abs(sum(numbers)) <= ROUNDING * sum(map(abs, numbers)))


def _unstable_roots(operator: list[sp.Expr], label: str) -> list[str]:
    if any(c.free_symbols for c in operator):
        return [f"stable: the roots of {label} can only be checked for numbers"]
    roots = sp.Poly(_at(operator, rate), rate).nroots()
    return [f"stable: {label} has the root {root}, which does not decay" for root in roots if sp.re(root) >= 0]


def _at(operator: Sequence[sp.Expr], step: sp.Expr) -> sp.Expr:
    return sum((c * step**n for n, c in enumerate(operator)), sp.Integer(0))


def applied(operator: Sequence[sp.Expr], function: sp.Expr, variable: sp.Symbol) -> sp.Expr:
    """The operator in the derivative by a variable, on a function."""
    return sum((c * sp.diff(function, variable, n) for n, c in enumerate(operator)), sp.Integer(0))


def _nonnegative(coefficient: sp.Expr) -> bool:
    return bool(sp.factor(coefficient).is_nonnegative)
