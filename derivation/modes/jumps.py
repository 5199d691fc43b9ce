"""What happens to the states of a material point where p steps, and which closures determine them."""

import sympy as sp

from ..check import DerivationError, Derived, derived, holds, zero
from ..jumps import across_a_step
from ..model import Model
from ..symbols import alpha, beta, s
from .symbols import J_0, J, S, eta


def jump_law() -> Derived:
    r"""The law of every mode and of every branch, read as an equation between distributions, integrated over a vanishing interval
    around a step of p: every retardation displacement, and with it every dashpot displacement, is continuous; w steps by J_0
    [p].

    .. math:: \int_{0^-}^{0^+}(z_j + \beta_j z_j' - J_j p)\,ds = \beta_j [z_j] = 0,\quad \int_{0^-}^{0^+}(f_i + \alpha_i f_i' -
        \eta_i w')\,ds = \alpha_i [f_i] - \eta_i [w] = 0\;\Rightarrow\; [w] = J_0 [p]
    """
    steps = step_w, step_p, step_z, step_f = sp.symbols("step_w step_p step_z step_f", real=True)
    w, p, z, f = (before + step * sp.Heaviside(s) for before, step in zip(sp.symbols("w p z f", real=True), steps, strict=True))
    of_mode = across_a_step(z + beta * sp.diff(z, s) - J * p)
    of_branch = across_a_step(f + alpha * sp.diff(f, s) - eta * sp.diff(w, s))
    solutions = sp.solve(of_mode, step_z), sp.solve(of_branch, step_f)
    if [len(found) for found in solutions] != [1, 1]:
        raise DerivationError("jump law", f"one step of z and one of f, not {solutions}")
    (z_steps,), (f_steps,) = solutions
    total = sp.Symbol("sum_z", real=True)  # of the z_j, each of which is continuous
    checks = [
        zero("a retardation displacement is continuous, whatever p does", z_steps),
        zero("and so is a dashpot's, e = w - S f with S = alpha/eta", (step_w - S * f_steps).subs(S, alpha / eta)),
        zero("w = J_0 p + sum z_j: [w] = J_0 [p]", (J_0 * step_p + total * z_steps) - J_0 * step_p),
    ]
    return derived(jump_law, J_0, checks)


def closures(model: Model) -> Derived:
    r"""``constitutive`` determines the states; ``continuous``, :math:`[w] = 0`, where it says the same.

    .. math:: [w] = J_0 [p],\quad [z_j] = 0
    """
    modes = model.modes or 2  # any number: two stand for several
    steps = sp.symbols(f"step_z:{modes}", real=True)
    step_w = sp.Add(*steps)  # at given p: w continuous asks that this vanishes
    left_open = modes - sp.Matrix([[sp.diff(step_w, step) for step in steps]]).rank()
    if not model.springy:
        allowed, claim, holding = (0, 1), "no instantaneous compliance: the law itself keeps w continuous where p steps", True
        why = "Without instantaneous compliance there is no step, and both are one."
    elif modes > 1:
        allowed, claim = (1,), "w continuous is one condition on n states and leaves n - 1 open"
        holding = left_open == modes - 1 > 0
        why = "With several relaxation times, w continuous does not determine the states: only the law itself does."
    else:
        allowed, claim, holding = (1,), "w continuous is one condition on one state", left_open == 0
        why = "With one relaxation time either determines the state; the solver of the standard linear solid has both."
    return derived(
        closures,
        allowed,
        [holds(claim, holding)],
        statement="The paper does not say what w does where p steps. Its vanishing friction at very high speed needs w "
        f"continuous; the law itself asks for a step. {why}",
    )
