"""What happens to w where p steps: the law integrated across the step, and the two closures in use."""

import sympy as sp

from .check import DerivationError, Derived, derived, holds, zero
from .strip import TIMES, Strip
from .symbols import J, chi, s


def jump_law(strip: Strip) -> Derived:
    r"""Read as an equation between distributions, the law integrated over a vanishing interval around a step of p
    gives the step of w.

    .. math:: \int_{0^-}^{0^+}(w + \beta w' - p - \alpha p')\,ds = \beta [w] - \alpha [p] = 0 \;\Rightarrow\; [w] = J [p]
    """
    before_w, before_p, step_w, step_p = sp.symbols("w_minus p_minus step_w step_p", real=True)
    balance = across_a_step(strip.law(before_w + step_w * sp.Heaviside(s), before_p + step_p * sp.Heaviside(s)))
    solutions = sp.solve(balance, step_w)
    if len(solutions) != 1:
        raise DerivationError("jump law", f"one step of w for a step of p, not {solutions}")
    ratio = sp.cancel(solutions[0] / step_p)
    instantaneous = (strip.foundation.J_0 * strip.foundation.K).subs(TIMES)
    checks = [
        zero("the singular part of the law vanishes", balance.subs(step_w, ratio * step_p)),
        zero("[w]/[p] is the instantaneous compliance J", [ratio - J, ratio - instantaneous]),
    ]
    return derived(jump_law, ratio, checks)


def across_a_step(law: sp.Expr) -> sp.Expr:
    """A law for steps at s = 0, integrated over a vanishing interval around them."""
    eps = sp.Symbol("eps", positive=True)
    return sp.expand(sp.limit(sp.integrate(sp.expand(law), (s, -eps, eps)), eps, 0))


def internal_state(strip: Strip) -> Derived:
    r"""The state that a material point carries from zone to zone.

    .. math:: z = w - J p,\qquad \beta z' = p - w
    """
    w, p = sp.Function("w")(s), sp.Function("p")(s)
    z = w - J * p
    solved = sp.solve(strip.law(w, p), sp.diff(w, s))[0]
    beta = strip.operator_w[1]
    residual = (beta * sp.diff(z, s)).subs(sp.diff(w, s), solved) - (p - w)
    return derived(internal_state, z, [zero("beta z' = p - w on every motion", residual)])


def closures(ratio: sp.Expr) -> Derived:
    r"""The paper does not say what w does where p steps. Its vanishing friction at very high speed needs w continuous; the law
    itself asks for a step. One symbol selects.

    .. math:: [w] = \chi J [p],\qquad \chi = 0:\ \text{continuous},\quad \chi = 1:\ \text{constitutive}
    """
    step = sp.Symbol("step_p", real=True)
    step_w = chi * J * step
    step_z = step_w - J * step
    checks = [
        zero("chi = 1 is the jump law: z is continuous", [step_w.subs(chi, 1) - ratio * step, step_z.subs(chi, 1)]),
        zero("chi = 0 keeps w continuous", step_w.subs(chi, 0)),
        zero("over a period the steps of z cancel: p falls by p_0 at d and rises by p_0 at c", step_z + step_z.subs(step, -step)),
        holds("with T_sigma = 0 (J = 0) the two are one", step_w.subs(J, 0) == 0),
    ]
    return derived(closures, step_w, checks)
