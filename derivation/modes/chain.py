r"""The zones of a period in turn, and the chain rule over them, for any number of zones and of modes.

A zone is an affine map of the state, :math:`z \to z + c - R z`, and its event an affine function of it, :math:`q + r z`; their
coefficients depend on the two edges of the zone. A derivative is what a small number stands before, to first order.
"""

import sympy as sp

from ..check import Derived, derived, zero
from ..sequences import PARTIAL

eps = sp.Symbol("epsilon")  # a small number
NAMES = "z c_1 c_2 R_1 R_2 q r"
z, c_1, c_2, R_1, R_2, q, r = NOW = sp.symbols(NAMES, commutative=False)
dz, dc_1, dc_2, dR_1, dR_2, dq, dr = CHANGES = sp.symbols([f"d{name}" for name in NAMES.split()], commutative=False)


def through(state: sp.Expr, drive: sp.Expr, forget: sp.Expr) -> sp.Expr:
    """The state at the end of a zone."""
    return state + drive - forget * state


def change(expression: sp.Expr) -> sp.Expr:
    """What an expression changes by to first order, where the state and the edges move."""
    moved = {each: each + eps * by for each, by in zip(NOW, CHANGES, strict=True)}
    return sp.expand(sp.expand(expression.xreplace(moved)).coeff(eps, 1))


def period_map() -> Derived:
    r"""A period is an affine map of the state, and R z = c is the state that it returns. What is forgotten is
    accumulated, not what is kept: slow modes forget little, and that little keeps its digits.

    .. math:: z \to z + c_k - R_k z,\quad c = c_2 + c_1 - R_2 c_1,\ R = R_1 + R_2 - R_2 R_1
    """
    twice = through(through(z, c_1, R_1), c_2, R_2)
    drive, forget = c_2 + c_1 - R_2 * c_1, R_1 + R_2 - R_2 * R_1
    return derived(
        period_map,
        (drive, forget),
        [zero("for matrices, which do not commute", sp.expand(twice - through(z, drive, forget)))],
        latex=rf"c = {sp.latex(drive)},\quad R = {sp.latex(forget)}",
        emitted=tuple(f"state_{sequence}" for sequence in PARTIAL),
    )


def chain_rule(period: Derived) -> Derived:
    r"""The derivative of zones in turn is that of each, in turn: modes.edge_slopes carries it over a period for every edge, and
    closes it with the state that returns; modes.monodromy carries a disturbance of the state, every event moving along.

    .. math:: dz \to dz - R\,dz + m,\quad m = \partial_{s_0}\Delta z\,ds_0 + \partial_{s_1}\Delta z\,ds_1;\qquad m = m_2 + m_1 -
        R_2 m_1;\qquad R\,dz = m

    ``period``: two zones as one. dc, dR, dq and dr are how far the coefficients move with the edges of a zone:
    m = dc - dR z.
    """
    halfway = through(z, c_1, R_1)
    m_1, m_2 = dc_1 - dR_1 * z, dc_2 - dR_2 * halfway
    drive, forget = period.value
    lost, moved = forget * dz, drive.xreplace({c_1: m_1, c_2: m_2})
    # the events of a zone and of the onset, by the state and by the edges
    ds_0, ds_1, by_state, by_start, by_end, onset_slope = sp.symbols("ds_0 ds_1 by_state by_start by_end onset_slope")
    (shift,) = sp.solve(by_state + by_start * ds_0 + by_end * ds_1, ds_1)
    (onset,) = sp.solve(by_state + onset_slope * ds_0, ds_0)
    checks = [
        zero("through one zone dz -> dz - R dz + m", sp.expand(change(halfway) - (dz - R_1 * dz + m_1))),
        zero(
            "through two zones it is of the same form: R of the period map, and m composed as drives are; so for any number",
            sp.expand(change(through(halfway, c_2, R_2)) - (dz - lost + moved)),
        ),
        zero(
            "the state that returns, R z = c, moves by R dz = m of the whole period",
            sp.expand(change(forget * z - drive) - (lost - moved)),
        ),
        zero("a boundary equation changes by what its event does: r dz + dq + dr z", change(q + r * z) - (r * dz + dq + dr * z)),
        zero(
            "where nothing but the state is disturbed the event at the end of a zone moves along: "
            "ds_1 = -(r dz + its derivative by s_0 times ds_0) / that by s_1; at the onset, by the slope of the gap before it",
            [shift + (by_state + by_start * ds_0) / by_end, onset + by_state / onset_slope],
        ),
    ]
    emitted = tuple(f"{kind}_{sequence}" for kind in ("residual_and_jacobian", "return_map") for sequence in PARTIAL)
    return derived(chain_rule, (lost, moved), checks, emitted=emitted)
