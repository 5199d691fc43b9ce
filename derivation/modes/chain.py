r"""The chain rule over the zones of a period, for any number of zones and of modes.

A zone is an affine map of the state, :math:`z \to z + c - R z`, and its event an affine function of it, :math:`q + r z`; their
coefficients depend on the two edges of the zone. A derivative is what a small number stands before, to first order.
"""

import sympy as sp

from ..check import Derived, derived, zero

eps = sp.Symbol("epsilon")  # a small number
z, dz, q, q_0, q_1, r_dz, r_z, r_0, r_1 = sp.symbols("z dz q q_0 q_1 r_dz r_z r_0z r_1z", commutative=False)
edges = ds_0, ds_1, ds_2 = sp.symbols("ds_0:3")  # how far the edges move


class Zone:
    """Zone ``number`` between two edges that move: drive and forget to first order, and the derivatives by both edges."""

    def __init__(self, number: int):
        (c, c_0, c_1), (R, R_0, R_1) = (
            sp.symbols(f"{letter}{number} {letter}{number}_0 {letter}{number}_1", commutative=False) for letter in "cR"
        )
        start, end = edges[number - 1 : number + 1]
        self.forget = R
        self.moved_drive, self.moved_forget = (
            still + eps * (first * start + last * end) for still, first, last in ((c, c_0, c_1), (R, R_0, R_1))
        )
        self.by_edges = lambda state: (c_0 - R_0 * state) * start + (c_1 - R_1 * state) * end
        self.left_by = lambda state: state + c - R * state

    def left_by_moved(self, state: sp.Expr) -> sp.Expr:
        return state + self.moved_drive - self.moved_forget * state


def chain_rule(period: Derived) -> Derived:
    r"""The derivative of zones in turn is that of each, in turn: modes.edge_slopes carries it over a period for every edge, and
    closes it with the state that returns; modes.monodromy carries a disturbance of the state, every event moving along.

    .. math:: dz \to dz - R\,dz + m,\quad m = \partial_{s_0}\Delta z\,ds_0 + \partial_{s_1}\Delta z\,ds_1;\qquad m = m_2 + m_1 -
        R_2 m_1;\qquad R\,dz = m

    ``period``: two zones as one, :mod:`.functions`.
    """
    first, second = Zone(1), Zone(2)
    halfway = first.left_by(z)
    m_1, m_2 = first.by_edges(z), second.by_edges(halfway)
    names = sp.symbols("c_1 c_2 R_1 R_2", commutative=False)
    moving = dict(zip(names, (first.moved_drive, second.moved_drive, first.moved_forget, second.moved_forget), strict=True))
    as_drives = dict(zip(names, (m_1, m_2, first.forget, second.forget), strict=True))
    drive, forget = period.value
    moved, lost = (sp.expand(part.xreplace(as_drives)) for part in (drive, forget))
    through = _first_order(second.left_by_moved(first.left_by_moved(z + eps * dz)))
    closing = _first_order(forget.xreplace(moving) * (z + eps * dz) - drive.xreplace(moving))
    # of an event q + r z: by the state, and by the edges
    event = q + eps * (q_0 * ds_0 + q_1 * ds_1) + r_z + eps * (r_dz + r_0 * ds_0 + r_1 * ds_1)
    by_state, by_start, by_end, onset_slope = sp.symbols("by_state by_start by_end onset_slope")
    (shift,) = sp.solve(by_state + by_start * ds_0 + by_end * ds_1, ds_1)
    (onset,) = sp.solve(by_state + onset_slope * ds_0, ds_0)
    checks = [
        zero(
            "through one zone dz -> dz - R dz + m",
            sp.expand(_first_order(first.left_by_moved(z + eps * dz)) - (dz - first.forget * dz + m_1)),
        ),
        zero(
            "through two zones it is of the same form: R of the period map, and m composed as drives are; so for any number",
            sp.expand(through - (dz - lost * dz + moved)),
        ),
        zero("the state that returns, R z = c, moves by R dz = m of the whole period", sp.expand(closing - (lost * dz - moved))),
        zero(
            "a boundary equation changes by what its event does: r dz + (q_0 + r_0 z) ds_0 + (q_1 + r_1 z) ds_1",
            sp.expand(_first_order(event) - (r_dz + (q_0 + r_0) * ds_0 + (q_1 + r_1) * ds_1)),
        ),
        zero(
            "where nothing but the state is disturbed the event at the end of a zone moves along: "
            "ds_1 = -(r dz + its derivative by s_0 times ds_0) / that by s_1; at the onset, by the slope of the gap before it",
            [shift + (by_state + by_start * ds_0) / by_end, onset + by_state / onset_slope],
        ),
    ]
    return derived(
        chain_rule,
        (lost * dz, moved),
        checks,
        emitted=tuple(
            f"{kind}_{sequence}" for kind in ("residual_and_jacobian", "return_map") for sequence in ("acaf", "afc", "af", "ac")
        ),
    )


def _first_order(expression: sp.Expr) -> sp.Expr:
    return sp.expand(expression).coeff(eps, 1)
