"""One strip of the moving surface: rigid profile, the law in the frame of the surface, dimensionless groups."""

from dataclasses import dataclass

import sympy as sp

from .check import Derived, derived, zero
from .model import Foundation, applied
from .surface import AMPLITUDE, HEIGHT, PENETRATION, RIGID
from .symbols import A, D, D_j, D_level, J, K, L, T_eps, T_sigma, V, alpha, beta, delta_0, k, p_0, s, t, x

TIMES = {T_sigma: alpha / (k * V), T_eps: beta / (k * V)}
"""Times of the material in terms of those of the strip."""


@dataclass(frozen=True)
class Strip:
    """The second stage: the profile ``u(s)`` in a strip and the dimensionless operators that act on it."""

    foundation: Foundation
    adhesion: Derived  # gamma
    profile: Derived  # u(s) = D - 1 + cos s
    moving_frame: Derived
    groups: Derived
    operator_w: tuple[sp.Expr, ...]  # coefficients of d^n w/ds^n
    operator_p: tuple[sp.Expr, ...]

    @property
    def u(self) -> sp.Expr:
        return self.profile.value

    def misses(self, w: sp.Expr, p: sp.Expr) -> sp.Expr:
        """Left minus right side of Eq. 5 for fields of x, in SI."""
        equation = self.moving_frame.value
        fields = {sp.Function("w")(x): w, sp.Function("p")(x): p}
        return (equation.lhs - equation.rhs).subs(fields).doit()

    def law(self, w: sp.Expr, p: sp.Expr) -> sp.Expr:
        """Left minus right side of the law for ``w(s)`` and ``p(s)``: zero on a motion."""
        return applied(self.operator_w, w, s) - applied(self.operator_p, p, s)


def strip(foundation: Foundation) -> Strip:
    """Stage 2: from the law of the material to the law in a strip."""
    moving = moving_frame(foundation)
    groups = dimensionless_groups(foundation)
    operator_w, operator_p = groups.value
    return Strip(foundation, adhesion_law(), strip_profile(), moving, groups, operator_w, operator_p)


def traction(gap: sp.Expr) -> sp.Piecewise:
    """Pressure in an open gap."""
    return sp.Piecewise((-p_0, gap <= delta_0), (0, True))


def adhesion_law() -> Derived:
    r"""Eq. 2, 3: Dugdale's adhesion: a constant traction within a short range of the surface.

    .. math:: p = -p_0\ (0 < g \le \delta_0),\quad p = 0\ (g > \delta_0),\qquad \gamma = \int p_0\,dg = p_0 \delta_0
    """
    opening, far = sp.symbols("g g_1", positive=True)
    work = -sp.integrate(traction(opening), (opening, 0, far))
    energy = sp.simplify(work.subs(far, delta_0 + t**2 + 1))
    checks = [
        zero("the work that separates a unit area beyond delta_0 is p_0 delta_0", energy - p_0 * delta_0),
        zero("and half of that at half of the range", work.subs(far, delta_0 / 2) - p_0 * delta_0 / 2),
    ]
    return derived(adhesion_law, p_0 * delta_0, checks)


def strip_profile() -> Derived:
    r"""Eq. 4, 8: In contact the foundation follows the rigid surface, w = D - f. In the strip at y this is a cosine
    of amplitude A about the strip's own penetration D_j.

    .. math:: u(s) = D - 1 + \cos s,\quad A = \tfrac h4 (1 + \cos k y),\quad D_j = D - \tfrac h2 (1 - \cos k y)
    """
    target = PENETRATION - AMPLITUDE * (1 - sp.cos(k * x))
    scaled = (D_j - A * (1 - sp.cos(k * x))).subs({D_j: A * D, x: -s / k}) / A
    checks = [
        zero("w = D - f is D_j - A (1 - cos kx) with the A and D_j of Eq. 8", D_level - HEIGHT - target),
        zero("in units of A and with s = -k x the profile is u = D - 1 + cos s", scaled - RIGID),
    ]
    return derived(strip_profile, RIGID, checks, emitted=("profile", "profile_slope", "profile_rise"))


def moving_frame(foundation: Foundation) -> Derived:
    r"""Eq. 5: In the frame of the surface, which slides in +x, the fields are steady; a material point passes towards -x.

    .. math:: w - V T_\epsilon w_x = (p - V T_\sigma p_x)/K
    """
    model = foundation.model
    fixed = sp.Symbol("X", real=True)
    w, p = sp.Function("w"), sp.Function("p")
    frame = {x: fixed - V * t}
    moved = applied(model.Q, w(fixed - V * t), t) - applied(model.P, p(fixed - V * t), t)
    equation = sp.Eq(_in_space(model.Q, w(x)), _in_space(model.P, p(x)))
    claimed = equation.lhs - equation.rhs
    tried = {w: sp.Lambda(x, sp.exp(3 * x) + x**3), p: sp.Lambda(x, sp.sin(2 * x) + x**2)}
    difference = moved.subs(tried).doit() - claimed.subs(tried).doit().subs(frame)
    checks = [zero("a field that moves with the surface, w(X - V t), obeys d/dt = -V d/dx", sp.expand(difference))]
    return derived(moving_frame, equation, checks, latex=sp.latex(equation))


def dimensionless_groups(foundation: Foundation) -> Derived:
    r"""Everything about a strip follows from alpha, beta, p_0/(K A), delta_0/A and D_j/A. J = K J_0 and L = 1 - J are kept beside
    alpha and beta, because neither can be had from them at V = 0 or without cancellation.

    .. math:: w + \beta w' = p + \alpha p',\quad \alpha = k V T_\sigma,\quad \beta = k V T_\epsilon,\quad J =
        T_\sigma/T_\epsilon,\quad L = 1 - J
    """
    model = foundation.model
    # d/dt = -V d/dx = k V d/ds; p is in units of K A, w in units of A, and the law is divided by A.
    operator_w = tuple(sp.cancel((q * (k * V) ** n).subs(TIMES)) for n, q in enumerate(model.Q))
    operator_p = tuple(sp.cancel((q * foundation.K * (k * V) ** n).subs(TIMES)) for n, q in enumerate(model.P))
    w, p = sp.Function("w"), sp.Function("p")
    fields = {w: sp.Lambda(x, A * sp.exp(2 * k * x)), p: sp.Lambda(x, K * A * sp.cos(k * x))}
    si = (_in_space(model.Q, w(x)) - _in_space(model.P, p(x))).subs(fields).doit()
    ours = applied(operator_w, sp.exp(-2 * s), s) - applied(operator_p, sp.cos(s), s)
    compliance = (foundation.J_0 * foundation.K).subs(TIMES)
    checks = [
        zero("the SI law of the moving frame, divided by A, is the law in s", (si / A).subs(x, -s / k).subs(TIMES) - ours),
        zero("K J_0 = alpha/beta = J", compliance - J),
        zero("beta - alpha = L beta with L = 1 - J", beta - alpha - L * beta),
    ]
    return derived(dimensionless_groups, (operator_w, operator_p), checks)


def _in_space(operator: tuple[sp.Expr, ...], function: sp.Expr) -> sp.Expr:
    return applied([q * (-V) ** n for n, q in enumerate(operator)], function, x)
