"""The states of a material point with any number of relaxation times, in the two sets of coordinates that decouple them.

Branch i stands for every branch, with the relaxation time alpha_i and the viscosity eta_i; j and k stand for retardation times. A
sum over the branches is taken under the sum sign: its term is shown to be a combination of terms whose sums are known,

    sum_i eta_i/(beta_j - alpha_i) = 1,    sum_i eta_i/(beta_j - alpha_i)^2 = 1/(J_j beta_j),    sum_i f_i = p - w,

the first because the stiffness vanishes at -1/beta_j, the second because J_j is the residue there. So claims hold for any n.
"""

from collections.abc import Sequence

import mpmath
import numpy as np
import sympy as sp

from ..check import EXACT, Claim, DerivationError, Derived, derived, holds, zero
from ..model import rate
from ..symbols import alpha, beta
from .symbols import J_0, J, S, enter, eta, leave, share

alpha_i, eta_i, alpha_k, beta_i, beta_j, beta_k, J_j = sp.symbols("alpha_i eta_i alpha_k beta_i beta_j beta_k J_j", positive=True)
f_i, df_i, w, dw, p = sp.symbols("f_i f_i' w w' p", real=True)
OF_BRANCH = {alpha_i, eta_i, f_i, df_i}
BRANCH = eta_i * rate / (1 + alpha_i * rate)

ENTER = eta_i / (beta_j - alpha_i)
"""f_i = -sum_j ENTER (z_j - J_j p)."""
LEAVE = J_j * beta_j / (beta_j - alpha_i)
"""z_j - J_j p = -sum_i LEAVE f_i."""
SHARE = J_j * eta_i / (beta_j - alpha_i)
"""z_j = sum_i SHARE e_i."""
NORM = eta_i / (beta_j - alpha_i) ** 2
"""Its sum over i is 1/(J_j beta_j)."""
OWN, OTHERS = beta_i - alpha_i, (beta_k - alpha_i) / (alpha_k - alpha_i)
"""eta_i is the first times the product of the second over all k but i."""

ENTERING = (ENTER, sp.Integer(1))  # a term, and its sum over the branches
NORMAL = (NORM, 1 / (J_j * beta_j))
OVERSTRESSED = (f_i, p - w)


def summed(
    claim: str,
    term: sp.Expr,
    combination: Sequence[tuple[sp.Expr | int, tuple[sp.Expr, sp.Expr]]],
    total: sp.Expr,
    over: set[sp.Symbol] = OF_BRANCH,
) -> Claim:
    """The sum of ``term`` is ``total``: it is a ``combination`` of known sums, with coefficients that are the same for all."""
    if any(sp.sympify(coefficient).free_symbols & over for coefficient, _ in combination):
        raise DerivationError("sum over modes", f"{claim}: the coefficients are the same for all that are summed")
    by_term = term - sum(coefficient * known for coefficient, (known, _) in combination)
    left = sum(coefficient * value for coefficient, (_, value) in combination) - total
    return zero(claim, [by_term, left], outcome=f"{EXACT}, term by term under the sum, for any n")


def dimensionless_groups() -> Derived:
    r"""Eq. 5: In the frame of the surface d/dt = k V d/ds. Lengths in A, pressures in K A; the roots of the operators are
    -1/alpha_i and -1/beta_j, with alpha_i = k V tau_i and beta_j = k V lambda_j. A polynomial of degree n is known by its n
    roots and its value at 0.

    .. math:: \prod_{j}\left(1 + \beta_j \frac{d}{ds}\right) w = \prod_{i}\left(1 + \alpha_i \frac{d}{ds}\right) p
    """
    speed, time, viscosity = sp.symbols("speed tau eta", positive=True)  # k V, and a branch in seconds
    in_time = viscosity * rate / (1 + time * rate)
    pole, other = 1 + alpha_i * rate, 1 + alpha_k * rate
    product = sp.cancel(BRANCH * pole * other)
    checks = [
        zero(
            "d/dt = k V d/ds: a branch keeps its form, with alpha_i = k V tau_i and eta_i = k V times that in seconds",
            in_time.subs(rate, speed * rate) - BRANCH.subs({alpha_i: speed * time, eta_i: speed * viscosity}, simultaneous=True),
        ),
        holds(
            "times prod (1 + alpha_i d/ds) every branch is a polynomial of degree n: its pole is one of the factors",
            product.is_polynomial(rate) and sp.degree(product, rate) == sp.degree(sp.expand(pole * other), rate),
        ),
        zero("which is 0 at rest: Q = P (1 + sum) is 1 there", BRANCH.subs(rate, 0)),
        zero(
            "Q vanishes at the n roots -1/beta_j: Q = prod (1 + beta_j d/ds), of degree n", BRANCH.subs(rate, -1 / beta_j) + ENTER
        ),
    ]
    return derived(dimensionless_groups, (BRANCH, 1 + beta_j * rate), checks)


def partial_fractions() -> Derived:
    r"""Interlaced times make every branch viscosity and every compliance positive. Nothing cancels: a viscosity is a product of
    differences, a compliance one over a sum of positive terms.

    .. math:: \eta_i = (\beta_i - \alpha_i)\prod_{k \ne i}\frac{\beta_k - \alpha_i}{\alpha_k - \alpha_i},\quad J_j \beta_j =
        \left(\sum_i \frac{\eta_i}{(\beta_j - \alpha_i)^2}\right)^{-1},\quad J_0 = \prod_i \frac{\alpha_i}{\beta_i}
    """
    slope = sp.diff(BRANCH, rate).subs(rate, -1 / beta_j)
    residue = sp.limit(J_j / (1 + beta_j * rate) * (rate + 1 / beta_j), rate, -1 / beta_j)
    factor = (1 + beta_k * rate) / (1 + alpha_k * rate)
    own = sp.limit(factor.subs({beta_k: beta_i, alpha_k: alpha_i}) * (rate + 1 / alpha_i), rate, -1 / alpha_i)
    of_branch = sp.limit(BRANCH * (rate + 1 / alpha_i), rate, -1 / alpha_i)
    step_1, step_2, step_3 = sp.symbols("step_1:4", positive=True)
    below = OTHERS.subs(beta_k, alpha_k + step_2).subs({alpha_i: alpha_k + step_2 + step_3}, simultaneous=True)
    above = OTHERS.subs({alpha_k: alpha_i + step_1, beta_k: alpha_i + step_1 + step_2}, simultaneous=True)
    checks = [
        summed(
            "P/Q has at -1/beta_j the residue 1/(Q/P)': J_j beta_j = 1/sum_i eta_i/(beta_j - alpha_i)^2",
            residue * slope,
            [(J_j * beta_j, NORMAL)],
            sp.Integer(1),
        ),
        zero(
            "at high rates a factor (1 + beta s)/(1 + alpha s) tends to beta/alpha: J_0 = prod alpha_i/beta_i",
            sp.limit(factor, rate, sp.oo) - beta_k / alpha_k,
        ),
        zero("at rest P/Q = 1: J_0 + sum J_j = 1", factor.subs(rate, 0) - 1),
        zero(
            "eta_i is a product of differences: the residue of the branch at -1/alpha_i is -eta_i/alpha_i^2",
            of_branch + eta_i / alpha_i**2,
        ),
        zero("that of its own factor is -(beta_i - alpha_i)/alpha_i^2", own + OWN / alpha_i**2),
        zero("and every other factor is there (beta_k - alpha_i)/(alpha_k - alpha_i)", factor.subs(rate, -1 / alpha_i) - OTHERS),
        holds(
            "interlaced times: every factor is positive, for slower and for faster k; so are eta_i, and J_j, one over a sum of "
            "positive terms",
            sp.factor(below).is_positive
            and sp.factor(above).is_positive
            and sp.factor(NORM * (beta_j - alpha_i) ** 2).is_positive,
        ),
    ]
    return derived(partial_fractions, (OWN, OTHERS, NORM), checks)


def states() -> Derived:
    r"""Three sets of n numbers describe the state of a material point. Under a constant pressure the z_j decouple, in contact the
    f_i; matrices that hold no time, only ratios of times, lead from one to the other.

    .. math:: f = -N (z - J p),\quad N_{ij} = \frac{\eta_i}{\beta_j - \alpha_i},\quad z - J p = -M f,\quad M_{ji} =
        \frac{J_j\beta_j}{\beta_j - \alpha_i},\quad z = G e,\quad G_{ji} = \frac{J_j\eta_i}{\beta_j - \alpha_i}
    """
    other = {beta_j: beta_k}
    entering_k = (ENTER.subs(other), sp.Integer(1))
    apart = J_j * beta_j / (beta_j - beta_k)
    at_pole = (J_j / (1 + beta_j * rate)).subs(rate, -1 / alpha_i)
    rates = J_j * beta_j * df_i - LEAVE * (beta_j * df_i + f_i)  # of beta z' + z - J p, but for J beta w'
    e_i = w - alpha_i / eta_i * f_i
    pole = (J_j * alpha_i / (beta_j - alpha_i), J_0)  # P/Q, in its partial fractions, vanishes at -1/alpha_i
    checks = [
        summed("leave enter = 1: on the diagonal", LEAVE * ENTER, [(J_j * beta_j, NORMAL)], sp.Integer(1)),
        summed("and beside it", LEAVE * ENTER.subs(other), [(apart, entering_k), (-apart, ENTERING)], sp.Integer(0)),
        summed(
            "z_j = J_j p - sum_i leave_ji f_i obeys beta_j z_j' + z_j = J_j p where alpha_i f_i' + f_i = eta_i w' and "
            "p = w + sum f_i",
            rates.subs(df_i, (eta_i * dw - f_i) / alpha_i),
            [(-J_j * beta_j * dw, ENTERING)],
            -J_j * beta_j * dw,
        ),
        summed(
            "z = share e, e_i = w - S_i f_i",
            SHARE * e_i,
            [(J_j * w, ENTERING), (J_j, OVERSTRESSED), (-1, (LEAVE * f_i, sp.Symbol("left")))],
            J_j * p - sp.Symbol("left"),
        ),
        zero(
            "a dashpot follows w: alpha_i e_i' + e_i = w",
            alpha_i * (dw - alpha_i / eta_i * df_i).subs(df_i, (eta_i * dw - f_i) / alpha_i) + e_i - w,
        ),
        zero("P/Q vanishes at -1/alpha_i: the sum over j of J_j alpha_i/(beta_j - alpha_i) is J_0", at_pole + pole[0]),
        summed("the columns of leave sum to 1", LEAVE, [(1, (J_j, 1 - J_0)), (1, pole)], sp.Integer(1), over={beta_j, J_j}),
        summed("so w = J_0 p + sum z_j, z_j = J_j p - sum_i leave_ji f_i", -f_i, [(-1, OVERSTRESSED)], w - (J_0 + (1 - J_0)) * p),
    ]
    return derived(states, (ENTER, LEAVE, SHARE), checks)


_own, _others, _norm = (sp.lambdify(args, form, modules="mpmath") for args, form in (
    ((alpha_i, beta_i), OWN), ((alpha_i, alpha_k, beta_k), OTHERS), ((alpha_i, eta_i, beta_j), NORM)))  # fmt: skip
_between = sp.lambdify((alpha_i, eta_i, beta_j, J_j), (ENTER, LEAVE, SHARE), modules="mpmath")


def exact_modes(relaxation: Sequence[mpmath.mpf], retardation: Sequence[mpmath.mpf]) -> dict[sp.Symbol, np.ndarray | mpmath.mpf]:
    """Every quantity of the modes with these interlaced times, by symbol, as the derived forms give them."""
    times, slower = (np.array(each, dtype=object) for each in (relaxation, retardation))
    itself = np.eye(len(times), dtype=bool)
    factors = _others(times[:, None], times + itself, slower)  # of branch i and every other
    viscosity = np.where(itself, _own(times, slower), factors).prod(axis=1)
    compliance = 1 / (slower * _norm(times[:, None], viscosity[:, None], slower).sum(axis=0))
    entering, leaving, shared = _between(times[:, None], viscosity[:, None], slower, compliance)
    return {
        alpha: times, beta: slower, eta: viscosity, J: compliance, J_0: (times / slower).prod(), S: times / viscosity,
        enter: entering, leave: leaving.T, share: shared.T,
    }  # fmt: skip
