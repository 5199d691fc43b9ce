"""What the names in a display mean for one relaxation time: all from what was derived (:mod:`.displays`)."""

from collections.abc import Mapping
from typing import Any

import sympy as sp

from . import balance, half_space, onset_map, symbols
from .displays import Binding, Names
from .flows import Flows
from .latex import Of, Prefix
from .multilevel import pressure, slope_x, tau_below
from .paper.words import strips
from .surface import AMPLITUDE, HEIGHT, PENETRATION, WAVE, mean_over_cell
from .symbols import A, D, J, K, L, V, alpha, beta, gap_0, h, k, l, lag_0, p, p_0, p_in, p_nominal, q_0, s, s_0, s_1, w_0, x, y

BRACES = {ord("{"): None, ord("}"): None}
SYMBOLS = {sp.latex(each).translate(BRACES): each for each in vars(symbols).values() if isinstance(each, sp.Symbol)}
PLAIN = SYMBOLS | {"g_0": gap_0, "e": symbols.excess, "end": s_1, "i": sp.I, r"\pi": sp.pi, r"\infty": sp.oo}
"""Symbols by what SymPy prints of them."""
PERIOD = {"oint": lambda body, phase: sp.Integral(body, (phase, 0, 2 * sp.pi))}
ONE_LEVEL = {"sum over i": lambda body, *ends: body, "h_i": h, "l_i": l, "k_i": k}  # of a stack, each level is like the other
CELL = {"l": l, "x": x, "y": y, "f": HEIGHT, r"\pi": sp.pi}


def vocabulary(flows: Flows, field: sp.Expr) -> dict[str, Any]:
    """The names without more: ``w``, ``p``, ``z`` of complete contact. ``field``: Eq. 15 in a strip."""
    strip = flows.strip
    model = strip.foundation.model
    motion = sp.Symbol("s_motion", positive=True)
    return PLAIN | PERIOD | ONE_LEVEL | {
        r"\omega": motion, "u": Of(s, strip.u), "H": Of(s, strip.law(strip.u, sp.Integer(0))), "p_sat": Of(s, field),
        "R": sp.sqrt((1 + beta**2) / (1 + alpha**2)), r"\varphi": sp.atan(beta) - sp.atan(alpha),
        "g": Of(s, flows.gap.value), "w": Of(s, flows.relaxation.value), "q": Of(s, flows.contact.value + p_0),
        "K*": lambda place=sp.I * k * V: model.transfer(place), "P": Of(s, model.operator_p(s)), "Q": Of(s, model.operator_w(s)),
        r"\mathrmRe": Prefix(lambda e: sp.re(sp.expand_complex(e))), r"\mathrmIm": Prefix(lambda e: sp.im(sp.expand_complex(e))),
    }  # fmt: skip


def named(*keys: str) -> Binding:
    return lambda values, words: dict(zip(keys, values, strict=False))


def _function(key: str) -> Binding:
    return lambda values, words: {key: Of(s, values[0])}


def _at_end(key: str) -> Binding:
    """A flow at s_1, as an expression."""
    return lambda values, words: {key: words[key](s_1)}


def _in_contact(values: list[sp.Expr], words: Names) -> Names:
    """p of the contact flow; what it adds to z is w - J p at the end less at the beginning."""
    pressure = words["q"].expression - p_0
    state = words["u"].expression - J * pressure
    return {"p": Of(s, pressure), r"\Deltaz": state.subs(s, s_1) - state.subs(s, s_0)}


def _lagging(values: list[sp.Expr], words: Names) -> Names:
    change = words["w"](s_1) - words["w"](s_0)
    return {r"\Deltaz": change.subs(w_0, lag_0 + p), "w_0": lag_0 + p}


def _motion(values: list[sp.Expr], words: Names) -> Names:
    """A motion that obeys the law: complete contact."""
    w, pressure = words["u"], words["p_sat"]
    return {"w": w, "p": pressure, "z": Of(s, w.expression - J * pressure.expression)}


def _as_one_harmonic(values: list[sp.Expr], words: Names) -> Names:
    phase = sp.Symbol("phi", positive=True)
    modulus = 1 / (sp.cos(phase) - alpha * sp.sin(phase))
    return {r"\varphi": phase, "R": modulus, "p_sat": Of(s, D - 1 + modulus * sp.cos(s + phase))}


def threshold(values: list[sp.Expr], words: Names) -> Names:
    return {"D_j": A * values[0].subs(p_0, p_0 / (K * A))}


def shape(values: list[sp.Expr], words: Names) -> Names:
    return {"u": Of(s, values[0]), "A": AMPLITUDE, "D_j": PENETRATION}


def _energies(values: list[sp.Expr], words: Names) -> Names:
    state = _motion(values, words)["z"]
    loss = beta / L * sp.Integral(sp.diff(state.expression, s) ** 2, (s, 0, 2 * sp.pi))
    heights = {f"w_{edge}": sp.Symbol(f"u_{edge}", real=True) for edge in "dbac"}
    return {"z": state, "E": loss, "X": values[0], r"\bar\tau": (loss + values[0]) / (2 * sp.pi), "K_g": 1 / J} | heights


def _least(values: list[sp.Expr], words: Names) -> Names:
    ratio = sp.Symbol("R", positive=True)
    own, below, last = sp.symbols("p_sat_i P_below P_M", positive=True)
    needed = sp.Max(own, below + (p_nominal - values[0]))
    return {r"\min": Prefix(lambda pressure: values[0]), "p_i": p_nominal, "R_i": ratio, "P_M": last, "p_sat,M": last,
            "p_sat,i": own, "P_i+1": below, "P_i": needed}  # fmt: skip


def _under_a_wave(values: list[sp.Expr], words: Names) -> Names:
    w = sp.Symbol("w", positive=True)
    return half_space.NAMES | {"w": w, "p": values[0] * w}


def _of_a_level(values: list[sp.Expr], words: Names) -> Names:
    modulus = half_space.E
    K_level = values[0] * sp.pi / l * modulus / (1 - half_space.nu**2)
    return half_space.NAMES | {"c": values[0], "E": lambda place: modulus, "K": lambda place: K_level}


def _area(values: list[sp.Expr], words: Names) -> Names:
    """Strips whose contact is linear in cos ky, which their middles sum exactly."""
    ahead, behind = ((m + n * sp.cos(k * y)).subs(WAVE) for m, n in (sp.symbols("m n"), sp.symbols("m' n'")))
    area = values[0].replace(sp.Function("length"), lambda place: (ahead + behind).subs(y, place))
    at_strip = {y: sp.Symbol("y_j", real=True)}
    return CELL | strips(2) | {"A": area.doit(), "a_j": ahead.subs(at_strip), "b_j": behind.subs(at_strip)}


def _means(values: list[sp.Expr], words: Names) -> Names:
    own = {rf"\bar{mean}_j": sp.Function(f"{name}_j")(y) for mean, name in (("p", "p"), (r"\tau", "tau"))}
    return CELL | own | {r"\barp": values[0], r"\bar\tau": values[1]}


def _shear(values: list[sp.Expr], words: Names) -> Names:
    own = {r"\tau_M-1": lambda *place: values[0], "p": pressure, "f_x": slope_x, r"\tau_M": lambda local: tau_below}
    return CELL | own


def _carried(values: list[sp.Expr], words: Names) -> Names:
    """A pressure over the whole cell, and a law that is no straight line; in a strip, contact from x = -a to b."""
    behind, ahead = sp.symbols("x_a x_b", positive=True)
    field = lambda phase: 2 + sp.cos(phase) - sp.sin(phase) / 3  # noqa: E731
    law = lambda local: local**2 + 3  # noqa: E731
    along = lambda *phase: field(*phase) if phase else field(-k * x)  # noqa: E731
    cell = lambda body, *variables: l**2 * mean_over_cell(body)  # noqa: E731
    own = mean_over_cell(field(-k * x) * sp.diff(HEIGHT, x) + law(field(-k * x)))
    part = values[0].replace(sp.Function("tau_M"), law).replace(sp.Function("p"), field)
    part = part.subs({s_0: -k * ahead, s_1: k * behind})
    return CELL | {r"\bar\tau_M-1": own, "f_x": sp.diff(HEIGHT, x), "p": along, r"\tau_M": law, "k": k, "a": behind, "b": ahead,
                   "s": s, "iint": cell, r"iint \textcontact": cell, "C_j": part}  # fmt: skip


LEVELS: dict[str, Binding] = {
    "equilibrium": lambda values, words: CELL | {r"\barp": values[0], "p": sp.Function("p"), r"iint \Omega": sp.Integral},
    "contact area": _area,
    "local stress": lambda values, words: CELL | {r"\tau": lambda *at: values[0].subs(WAVE), "p": lambda *at: pressure},
    "means over a level": _means,
    "local shear": _shear,
    "carried friction": _carried,
    "friction coefficient": lambda values, words: {r"\mu": values[0], r"\tau_1": sp.Symbol("tau_1", real=True), "p_1": p_nominal},
    "strip profile": shape,
    "means_c": lambda values, words: {r"\barp": values[0], r"\bar\tau": values[1], "p": words["p_sat"]},
    "means_": named(r"\barp", r"\bar\tau"),
}
"""Of steps that are the same on any foundation."""
BINDINGS: Mapping[str, Binding] = LEVELS | {
    "half-space under a wave": _under_a_wave,
    "foundation that stands for a half-space": _of_a_level,
    "instantaneous compliance": named("J_0"),
    "dimensionless groups": _motion,
    "contact flow": _function("p"),
    "relaxation flow": _function("w"),
    "gap flow": _function("g"),
    "internal state": _motion,
    "power balance": _motion,
    "forcing_arc": named(r"\textcentre", r"\texthalf"),
    "relaxation_increment": _lagging,
    "contact_increment": _in_contact,
    "contact_work": lambda values, words: {"p": Of(s, (words["q"].expression - p_0).subs(q_0, p_in + p_0))},
    "gap_event": named("g", "g'"),
    "excess_entry": _as_one_harmonic,
    "gap_link": _at_end("g"),
    "excess_link": _at_end("q"),
    "saturated_pressure": _function("p_sat"),
    "saturation threshold": threshold,
    "level_saturation_penetration": named("D_sat"),
    "level_saturation_pressure": named("p_sat"),
    "level_saturation_friction": named(r"\tau_sat"),
    "stack friction": named(r"\mu"),
    "Eq. 16 as printed": lambda values, words: {r"\mu": values[0], r"\textderived": values[0], r"\textprinted": values[1]},
    "friction balance": _energies,
    "onset_slope": lambda values, words: {"T'": values[0] / values[1]},
    "slope of the onset map": lambda values, words: onset_map.NAMES | {"T'": values[0]},
    "growth of the slope": lambda values, words: onset_map.NAMES,
    "standing still": lambda values, words: balance.NAMES,
    "adhesive_onset": named("g_d", "[F]"),
    "snap_onset": named("q_d", "[F]"),
    "least pressure": _least,
}
"""By the beginning of a step's name."""
