"""What the names in a display mean for any number of relaxation times: all from what was derived (:mod:`..displays`)."""

from collections.abc import Mapping
from typing import Any

import sympy as sp

from ..displays import Binding, Names
from ..flows import steady_state
from ..latex import Of, Prefix
from ..level import R
from ..model import rate
from ..symbols import D, K, alpha, beta, p, p_in, s, s_0, s_1
from ..vocabulary import LEVELS, ONE_LEVEL, PERIOD, PLAIN, named, threshold
from .flows import ModeFlows, u
from .numbers import BRANCHES, OTHER, RETARDATION, along, applied, product_along, slope
from .saturated import PASSING
from .states import alpha_i, alpha_k, beta_i, beta_k, eta_i
from .symbols import J_0, J, S, across, enter, eta, f, f_0, leave, share, total, z, z_0


def vocabulary(flows: ModeFlows) -> dict[str, Any]:
    """The names without more: ``z``, ``f`` of any state."""
    relaxation, contact = flows.relaxation.value, flows.contact.value
    harmonic = steady_state(contact)
    stiffness = 1 + total(sp.I * eta / (1 + sp.I * alpha))
    sums = {f"sum over {i}": _over(along, axis) for i, axis in (("i", BRANCHES), ("j", RETARDATION))}
    products = {f"prod over {i}": _over(product_along, axis) for i, axis in (("i", BRANCHES), ("j", RETARDATION), ("k", OTHER))}
    return PLAIN | PERIOD | sums | products | {
        "J_0": J_0, "J": J, "J_j": J, "S": S, r"\alpha_i": alpha, r"\alpha_k": alpha_k, r"\beta_i": beta_i, r"\beta_j": beta,
        r"\beta_k": beta_k, r"\eta": eta, r"\eta_i": eta, "z": z, "z_j": z, "z_0": z_0, "z_j,0": z_0, "f": f, "f_i": f,
        "f_0": f_0, "f_i,0": f_0, "N_ij": enter, "M_ji": leave, "G_ji": share, "N": _matrix(enter), "M": _matrix(leave),
        "G": _matrix(share), "u": Of(s, u), "f_sat": Of(s, harmonic), "f_sat,i": Of(s, harmonic), "partial": slope,
        "w": J_0 * p + total(relaxation), "g": Of(s, J_0 * p + total(relaxation) - u),
        "relaxation": Of(s, relaxation), "contact": Of(s, contact), "p_sat": Of(s, u + total(harmonic)),
        "K*": lambda place=None: K * stiffness, r"\mathrmIm": Prefix(sp.im),
    }  # fmt: skip


def _over(what: type[sp.Function], axis: int) -> Any:
    return lambda body, *ends: what(body, axis)


def _matrix(matrix: sp.Symbol) -> Prefix:
    return Prefix(lambda vector: across(matrix, vector))


def _law(values: list[sp.Expr], words: Names) -> Names:
    """An oscillation exp(rate t), under which the dashpots move as their branches let them."""
    t, speed, spring = sp.symbols("t speed K_i", positive=True)
    w, e = sp.exp(speed * t), sp.exp(speed * t) / (1 + speed * alpha)
    return {"t": t, "w": w, "e_i": e, r"\tau_i": alpha, "K_i": spring * alpha, "p": K * w + total(spring * alpha * (w - e))}


def _series(values: list[sp.Expr], words: Names) -> Names:
    """Springs K_i in line with dashpots: their force by the step "foundation law"."""
    spring = K * eta / alpha
    stiffness = lambda place: K + total(spring * (1 - 1 / (1 + alpha * place)))  # noqa: E731
    return {"K*": stiffness, r"\tau_i": alpha, "K_i": spring}


def _operators(values: list[sp.Expr], words: Names) -> Names:
    """Both operators on exp(rate s)."""
    return {"d/ds": rate, "w": sp.Integer(1), "p": 1 + total(values[0].subs({alpha_i: alpha, eta_i: eta}))}


def _states(values: list[sp.Expr], words: Names) -> Names:
    overstress, w = -across(enter, z - J * p), J_0 * p + total(z)
    return {"f": overstress, "w": w, "e": w - S * overstress}


def _relaxing(values: list[sp.Expr], words: Names) -> Names:
    """z_j as the step derived it, at s_1 or along the zone."""
    flow = Of(s, values[0].subs(s_1, s))
    return {"z_j": flow, "w": J_0 * p + total(flow.expression)}


def _pressed(values: list[sp.Expr], words: Names) -> Names:
    flow = Of(s, values[0].subs(s_1, s))
    return {"f_i": flow, "p": u + total(flow.expression)}


def _in_contact(values: list[sp.Expr], words: Names) -> Names:
    flow = words["contact"].expression
    creep = sp.Integral(flow, (s, s_0, s_1)) / eta
    own = {"f_i": words["contact"], "p": Of(s, u + total(flow)), r"\Deltae": creep, r"\Deltae_i": creep}
    return own | {r"\Deltaz": values[0], "q": values[0]}


def _passing(words: Names, contact: bool) -> Names:
    """What a zone does to the state z_0 by its flow."""
    if contact:
        overstress = -across(enter, z_0 - J * p_in)
        flow = words["contact"].expression
        change = across(share, (sp.Integral(flow, (s, s_0, s_1)) / eta).subs(f_0, overstress))
        event = u.subs(s, s_1) - u.subs(s, s_0) + total(flow.subs(s, s_1).subs(f_0, overstress) - overstress)
    else:
        change = words["relaxation"](s_1) - z_0
        event = total(change) - u.subs(s, s_1) + u.subs(s, s_0)
    return {r"\Deltaz": change, r"\Deltag": event, r"\Deltap": event}


def _map(contact: bool) -> Binding:
    def names(values: list[sp.Expr], words: Names) -> Names:
        forget = lambda state: applied(values[0], state) if contact else values[0] * state  # noqa: E731
        return _passing(words, contact) | {"c": values[1], "R": Prefix(forget)}

    return names


def _level(values: list[sp.Expr], words: Names) -> Names:
    """Complete contact of a level, by the modulus of its wave."""
    wave = words["K*"]().subs(PASSING)
    ratio = sp.sqrt(sp.re(wave) ** 2 + sp.im(wave) ** 2) / K
    names = dict.fromkeys(("D_sat", "p_sat", r"\tau_sat", r"\mu"), values[0])
    return ONE_LEVEL | {"R": ratio, "K*": lambda place: wave} | names


CLOSED = {"w": u, r"\barp": D - 1, r"\bar\tau": total(eta / (1 + alpha**2)) / 2}
"""Of a closed orbit, complete contact."""
BINDINGS: Mapping[str, Binding] = LEVELS | {
    "foundation law": _law,
    "Prony series": _series,
    "dimensionless groups": _operators,
    "partial fractions": lambda values, words: {r"\eta_i": eta, "J_j": J},  # of the sample, which is made from the values
    "states": _states,
    "relaxation flow": _relaxing,
    "contact flow": _pressed,
    "displacement": named("w"),
    "overstress": named("f"),
    "dashpots": lambda values, words: _states(values, words) | {"e": values[0]},
    "relaxation_increment": lambda values, words: {"z_j": words["relaxation"]},
    "gap_after": named("g"),
    "gap_event": named("g"),
    "overstress_after": _pressed,
    "contact_pressure": named("p"),
    "excess_": _in_contact,
    "contact_increment": _in_contact,
    "contact_work": _in_contact,
    "relaxation_map": _map(contact=False),
    "contact_map": _map(contact=True),
    "relaxation_passage": lambda values, words: _passing(words, contact=False),
    "contact_passage": lambda values, words: _passing(words, contact=True),
    "modulus_ratio": named("R"),
    "saturated_overstress": named("f_sat,i"),
    "saturated_pressure": named("p_sat"),
    "saturation threshold": lambda values, words: {**threshold(values, words), "K*": lambda *place: K * R},
    "means of a strip": lambda values, words: CLOSED | {"p": u + total(words["f_sat"].expression)},
    "level_saturation_": _level,
    "stack friction": _level,
}
"""By the beginning of a step's name."""
