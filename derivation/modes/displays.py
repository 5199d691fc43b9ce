"""The displays of a foundation with modes, read back as :mod:`..displays` does for one relaxation time.

Indices mean what they say: both sides of an equation are evaluated at random points with three modes (:mod:`.numbers`).
"""

from __future__ import annotations

import random
from collections.abc import Iterable, Mapping
from typing import Any

import mpmath
import numpy as np
import sympy as sp

from .. import displays as one_time
from ..check import Check, DerivationError, Derived
from ..displays import POINTS, READ, Binding, checked, named, read_back
from ..level import R
from ..model import rate
from ..reader import Of, Prefix
from ..surface import AMPLITUDE, PENETRATION, WAVE
from ..symbols import A, D, D_j, K, V, alpha, beta, h, k, l, p, p_0, p_in, p_nominal, s, s_0, s_1, x, y
from .flows import ModeFlows, u
from .numbers import BRANCHES, DIGITS, OTHER, RETARDATION, along, applied, product_along, sample, slope, value
from .saturated import R_LOSS
from .states import alpha_i, alpha_k, beta_i, beta_k, eta_i
from .symbols import J_0, J, S, enter, eta, f, f_0, leave, share, z, z_0
from .tensor import across, total

STATED = {
    "admissibility": "conditions on the series",
    "chain rule": "derivatives of unspecified maps",
    "jump law": "an integral over an unspecified motion",
    "closures": "a convention",
    "regime acaf": "conditions",
    "regime afc": "conditions",
    "regime af": "conditions",
    "regime ac": "conditions",
    "regime c": "a condition",
    "regime a": "a condition",
    "regime f": "a condition",
}
"""Steps whose displays have nothing to compare, and what they are, beside those of one relaxation time."""
PRINTED = ("relaxed stiffness", "period map")
OF_ROOTS = "conditions on the roots of the operators"


def displays(steps: Iterable[Derived], flows: ModeFlows, roots: bool) -> dict[str, Check]:
    """The check of every display that says something, by step. ``roots``: the series is that of given operators."""
    words = vocabulary(flows)
    return checked(steps, unread(roots), PRINTED, lambda step: read_back(step, words | bound(step, words), _same))


def unread(roots: bool) -> dict[str, str]:
    """What is said of the displays that have nothing to compare."""
    stated = {name: one_time.STATED[name] for name in ("adhesion law", "zone conditions", "inequalities of admissibility")}
    of_series = {"Prony series": OF_ROOTS} if roots else {}
    return stated | STATED | of_series | dict.fromkeys(PRINTED, "printed from what was derived")


def _same(name: str, one: sp.Expr, other: sp.Expr) -> None:
    with mpmath.workdps(DIGITS):
        for number in range(POINTS):
            point = _point(f"{name} {number}", one, other)
            left, right = (value(_plain(side), point) for side in (one, other))
            if np.any(abs(left - right) > mpmath.mpf("1e-20") * (1 + abs(left))):
                raise DerivationError(name, READ, np.ravel(left - right)[0])


def _plain(expression: sp.Expr) -> sp.Expr:
    return sp.sympify(expression).doit(integrals=False).subs(WAVE)


def _point(seed: str, *sides: sp.Expr) -> dict[sp.Symbol, Any]:
    point = dict(sample(seed))
    draw = random.Random(seed)
    free = set().union(*(_plain(side).free_symbols for side in sides)) - set(point)
    return point | {symbol: mpmath.mpf(draw.randint(20, 120)) / 100 for symbol in sorted(free, key=str)}


def vocabulary(flows: ModeFlows) -> dict[str, Any]:
    """What the symbols of the displays mean, from what was derived. ``z``, ``f`` without more: any state."""
    relaxation, contact = flows.relaxation.value, flows.contact.value
    harmonic = contact.replace(sp.exp, lambda exponent: sp.Integer(0))
    stiffness = 1 + total(sp.I * eta / (1 + sp.I * alpha))
    sums = {f"sum over {i}": _over(along, axis) for i, axis in (("i", BRANCHES), ("j", RETARDATION))}
    products = {f"prod over {i}": _over(product_along, axis) for i, axis in (("i", BRANCHES), ("j", RETARDATION), ("k", OTHER))}
    return sums | products | {
        "s": s, "s_0": s_0, "s_1": s_1, "x": x, "y": y, "D": D, "D_j": D_j, "A": A, "K": K, "V": V, "k": k, "l": l, "h": h,
        r"\pi": sp.pi, "i": sp.I, "p_0": p_0, "p": p, "p_1": p_nominal, "J_0": J_0, "J": J, "J_j": J, "S": S,
        r"\alpha": alpha, r"\alpha_i": alpha, r"\alpha_k": alpha_k, r"\beta": beta, r"\beta_i": beta_i, r"\beta_j": beta,
        r"\beta_k": beta_k, r"\eta": eta, r"\eta_i": eta, "z": z, "z_j": z, "z_0": z_0, "z_j,0": z_0, "f": f, "f_i": f,
        "f_0": f_0, "f_i,0": f_0, "N_ij": enter, "M_ji": leave, "G_ji": share, "N": _matrix(enter), "M": _matrix(leave),
        "G": _matrix(share), "u": Of(s, u), "f_sat": Of(s, harmonic), "f_sat,i": Of(s, harmonic), "partial": slope,
        "w": J_0 * p + total(relaxation), "g": Of(s, J_0 * p + total(relaxation) - u),
        "relaxation": Of(s, relaxation), "contact": Of(s, contact), "p_sat": Of(s, u + total(harmonic)),
        "K*": lambda place=None: K * stiffness, r"\mathrmIm": Prefix(sp.im), r"\mathrmRe": Prefix(sp.re),
        "oint": lambda body, phase: sp.Integral(body, (phase, 0, 2 * sp.pi)),
    }  # fmt: skip


def _over(what: type[sp.Function], axis: int) -> Any:
    return lambda body, *ends: what(body, axis)


def _matrix(matrix: sp.Symbol) -> Prefix:
    return Prefix(lambda vector: across(matrix, vector))


def bound(step: Derived, words: Mapping[str, Any]) -> dict[str, Any]:
    """The names that stand for the step's own value, or mean something of their own in it."""
    return BINDINGS[step.name](one_time.values_of(step), words) if step.name in BINDINGS else {}


def _law(values: list[sp.Expr], words: Mapping[str, Any]) -> dict[str, Any]:
    """An oscillation exp(rate t), under which the dashpots move as their branches let them."""
    t, speed, spring = sp.symbols("t speed K_i", positive=True)
    w, e = sp.exp(speed * t), sp.exp(speed * t) / (1 + speed * alpha)
    return {"t": t, "w": w, "e_i": e, r"\tau_i": alpha, "K_i": spring * alpha, "p": K * w + total(spring * alpha * (w - e))}


def _series(values: list[sp.Expr], words: Mapping[str, Any]) -> dict[str, Any]:
    """Springs K_i in line with dashpots: their force by the step "foundation law"."""
    spring = K * eta / alpha
    stiffness = lambda place: K + total(spring * (1 - 1 / (1 + alpha * place)))  # noqa: E731
    return {"K*": stiffness, r"\tau_i": alpha, "K_i": spring}


def _operators(values: list[sp.Expr], words: Mapping[str, Any]) -> dict[str, Any]:
    """Both operators on exp(rate s)."""
    return {"d/ds": rate, "w": sp.Integer(1), "p": 1 + total(values[0].subs({alpha_i: alpha, eta_i: eta}))}


def _fractions(values: list[sp.Expr], words: Mapping[str, Any]) -> dict[str, Any]:
    return {r"\eta_i": eta, "J_j": J}  # of the sample, which is made from the values


def _states(values: list[sp.Expr], words: Mapping[str, Any]) -> dict[str, Any]:
    overstress, w = -across(enter, z - J * p), J_0 * p + total(z)
    return {"f": overstress, "w": w, "e": w - S * overstress}


def _dashpots(values: list[sp.Expr], words: Mapping[str, Any]) -> dict[str, Any]:
    return _states(values, words) | {"e": values[0]}


def _relaxing(values: list[sp.Expr], words: Mapping[str, Any]) -> dict[str, Any]:
    """z_j as the step derived it, at s_1 or along the zone."""
    flow = Of(s, values[0].subs(s_1, s))
    return {"z_j": flow, "w": J_0 * p + total(flow.expression)}


def _creeping(values: list[sp.Expr], words: Mapping[str, Any]) -> dict[str, Any]:
    return {"z_j": words["relaxation"]}


def _gap(values: list[sp.Expr], words: Mapping[str, Any]) -> dict[str, Any]:
    return {"g": values[0]}


def _pressed(values: list[sp.Expr], words: Mapping[str, Any]) -> dict[str, Any]:
    flow = Of(s, values[0].subs(s_1, s))
    return {"f_i": flow, "p": u + total(flow.expression)}


def _in_contact(values: list[sp.Expr], words: Mapping[str, Any]) -> dict[str, Any]:
    flow = words["contact"].expression
    creep = sp.Integral(flow, (s, s_0, s_1)) / eta
    own = {"f_i": words["contact"], "p": Of(s, u + total(flow)), r"\Deltae": creep, r"\Deltae_i": creep}
    return own | {r"\Deltaz": values[0], "q": values[0]}


def _passing(values: list[sp.Expr], words: Mapping[str, Any], contact: bool) -> dict[str, Any]:
    """What a zone does to the state z_0 by its flow; c and R by the change of z from z_0 and from 0."""
    if contact:
        overstress = -across(enter, z_0 - J * p_in)
        flow = words["contact"].expression
        change = across(share, (sp.Integral(flow, (s, s_0, s_1)) / eta).subs(f_0, overstress))
        event = u.subs(s, s_1) - u.subs(s, s_0) + total(flow.subs(s, s_1).subs(f_0, overstress) - overstress)
    else:
        change = words["relaxation"](s_1) - z_0
        event = total(change) - u.subs(s, s_1) + u.subs(s, s_0)
    forgotten = change.subs(z_0, 0) - change
    return {r"\Deltaz": change, "R": forgotten, r"\Deltag": event, r"\Deltap": event}


def _map(contact: bool) -> Binding:
    def names(values: list[sp.Expr], words: Mapping[str, Any]) -> dict[str, Any]:
        return _passing(values, words, contact) | {"c": values[1], "R": Prefix(lambda state: applied(values[0], state))}

    return names


def _means(values: list[sp.Expr], words: Mapping[str, Any]) -> dict[str, Any]:
    """Of a closed orbit, complete contact."""
    pressure = u + total(words["f_sat"].expression)
    return {"w": u, "p": pressure, r"\barp": D - 1, r"\bar\tau": total(eta / (1 + alpha**2)) / 2}


def _threshold(values: list[sp.Expr], words: Mapping[str, Any]) -> dict[str, Any]:
    return {"D_j": A * values[0].subs(p_0, p_0 / (K * A)), "K*": lambda *place: K * R}


def _complete(values: list[sp.Expr], words: Mapping[str, Any]) -> dict[str, Any]:
    return {r"\barp": values[0], r"\bar\tau": values[1], "K*": lambda place: K * (1 + sp.I * R_LOSS)}


def _level(values: list[sp.Expr], words: Mapping[str, Any]) -> dict[str, Any]:
    """Complete contact of a level, by the modulus and the loss of its wave."""
    names = ("D_sat", "p_sat", r"\tau_sat", r"\mu")
    of_wave = {"R": R, "K*": lambda place: K * (1 + sp.I * R_LOSS), "h_i": h, "l_i": l, "k_i": k}
    return of_wave | {"sum over i": lambda body, *ends: body} | dict.fromkeys(names, values[0])


BINDINGS: dict[str, Binding] = {
    "foundation law": _law,
    "Prony series": _series,
    "dimensionless groups": _operators,
    "partial fractions": _fractions,
    "states": _states,
    "strip profile": lambda values, words: {"u": Of(s, values[0]), "A": AMPLITUDE, "D_j": PENETRATION},
    "relaxation flow": _relaxing,
    "contact flow": _pressed,
    "displacement": named("w"),
    "overstress": named("f"),
    "dashpots": _dashpots,
    "relaxation_increment": _creeping,
    "gap_after": _gap,
    "gap_event": _gap,
    "overstress_after": _pressed,
    "contact_pressure": named("p"),
    "excess_change": _in_contact,
    "contact_increment": _in_contact,
    "contact_work": _in_contact,
    "excess_event": _in_contact,
    "relaxation_map": _map(contact=False),
    "contact_map": _map(contact=True),
    "relaxation_passage": lambda values, words: _passing(values, words, contact=False),
    "contact_passage": lambda values, words: _passing(values, words, contact=True),
    "modulus_ratio": named("R"),
    "saturated_overstress": named("f_sat,i"),
    "saturated_pressure": named("p_sat"),
    "saturation threshold": _threshold,
    "means of a strip": _means,
    "means_c": _complete,
    "level_saturation_penetration": _level,
    "level_saturation_pressure": _level,
    "level_saturation_friction": _level,
    "saturated_stack_friction": _level,
}
