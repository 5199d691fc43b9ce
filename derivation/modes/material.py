"""The material's law with n relaxation times: its two operators, and the Prony series that they are."""

from __future__ import annotations

import sympy as sp

from ..check import DerivationError, Derived, derived, holds
from ..model import Model, Roots, Series, law_record, rate, stiffness_record
from .identity import vanishes
from .times import strip_times


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
    latex = r"\sum_{k=0}^{n} Q_k\,\frac{d^k w}{dt^k} = \sum_{k=0}^{n} P_k\,\frac{d^k p}{dt^k}"
    return law_record(foundation_law, (model.Q, model.P), latex, checks, f", here of order {model.modes}")


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
    return stiffness_record(relaxed_stiffness, stiffness, rf"K = Q_0/P_0 = {sp.latex(stiffness)}", checks)


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
    r"""Branches from the roots of P and Q, :math:`P(-1/\tau_i) = Q(-1/\lambda_j) = 0`; eta_i is a product of differences."""
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
