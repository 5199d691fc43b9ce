"""What is displayed is what is proven: the LaTeX of every step is read back and compared with what the step derived.

A display is a chain of equations, or values that stand for themselves. With the names bound to what was derived, all sides of
a chain are one, and a value by itself is that of the step. Both are compared at random points with 30 digits. Displays that state
a condition, a definition or an integral over fields that are not in closed form have nothing to compare; they are listed here.
"""

from __future__ import annotations

import random
from collections.abc import Callable, Container, Iterable, Mapping
from typing import Any

import mpmath
import sympy as sp
from sympy.core.function import AppliedUndef

from . import half_space
from .check import Check, DerivationError, Derived
from .exact import RELATIONS
from .flows import Flows
from .functions import flat, stack_sum, written_out
from .multilevel import pressure, slope_x, tau_below
from .paper.words import strips
from .reader import Of, Prefix, Unreadable, statements
from .strip import TIMES
from .surface import AMPLITUDE, HEIGHT, PENETRATION, WAVE, mean_over_cell
from .symbols import (
    A,
    D,
    D_j,
    J,
    K,
    L,
    T_eps,
    T_sigma,
    V,
    a,
    alpha,
    b,
    beta,
    c,
    chi,
    d,
    delta_0,
    excess,
    gap_0,
    h,
    k,
    l,
    lag_0,
    p,
    p_0,
    p_in,
    p_nominal,
    q_0,
    s,
    s_0,
    s_1,
    w_0,
    x,
    y,
)  # fmt: skip

READ = "the display reads as what was proven"
Binding = Callable[[list[sp.Expr], Mapping[str, Any]], dict[str, Any]]
Same = Callable[[str, sp.Expr, sp.Expr], None]
POINTS, DIGITS, CLOSE = 3, 30, sp.Float("1e-20", 30)
STATED = {
    "admissibility": "conditions on the operators",
    "adhesion law": "a law by cases",
    "jump law": "an integral over an unspecified motion",
    "closures": "a convention",
    "zone conditions": "conditions",
    "inequalities of admissibility": "conditions",
    "strip problem": "conditions",
    "regime c": "a condition",
    "regime a": "a condition",
    "regime f": "a condition",
    "integrals over contact": "integrals over a zone",
    "integrals over gaps": "integrals over a zone",
    "means_acaf": "definitions of the means",
    "means_afc": "definitions of the means",
    "means_af": "definitions of the means",
    "means_ac": "definitions of the means",
    "foundation law": "printed from the proven law",
    "moving frame": "printed from the proven law",
    "levels in complete contact together": "a sum over unspecified harmonics",
}
"""Steps whose displays have nothing to compare, and what they are."""
PRINTED = ("foundation law", "moving frame")  # of the above, those whose display is what SymPy prints of the value


def displays(steps: Iterable[Derived], flows: Flows, field: sp.Expr) -> dict[str, Check]:
    """The check of every display that says something, by step. ``field``: Eq. 15 in a strip."""
    words = vocabulary(flows, field)
    return checked(steps, STATED, PRINTED, lambda step: read_back(step, words | bound(step, words)))


def checked(
    steps: Iterable[Derived], stated: Container[str], printed: Container[str], read: Callable[[Derived], Check]
) -> dict[str, Check]:
    """What ``read`` finds, by step, but of those that have nothing to compare; ``printed``: of these, what SymPy prints.

    Raises :class:`DerivationError`, which names the step, for a display that reads as something else or cannot be read.
    """
    found: dict[str, Check] = {}
    for step in steps:
        if step.name in LEVELS:
            found[step.name] = of_levels(step)
        elif step.name in printed:
            require_printed(step)
        elif step.name not in stated:
            found[step.name] = read(step)
    return found


def require_printed(step: Derived) -> None:
    """Raise :class:`DerivationError` unless the display is what SymPy prints of every value of the step."""
    if not all(sp.latex(value) in step.latex for value in values_of(step)):
        raise DerivationError(step.name, READ)


def read_back(step: Derived, names: Mapping[str, Any], same: Same | None = None) -> Check:
    """Compare the display of one step with what it derived. ``same`` raises an error unless two sides are one."""
    same = same or _same
    try:
        read = statements(step.latex, names)
    except Unreadable as problem:
        raise DerivationError(step.name, f"the display can be read: {problem}") from problem
    alone = iter(values_of(step))
    for statement in read:
        sides = statement.sides
        if len(sides) == 1 or step.name.startswith("regime "):  # a value by itself; a boundary equation, value = 0
            sides = (sides[0], next(alone, None))
        if any(sign not in ("=", r"\ge") for sign in statement.signs) or sides[1] is None:
            raise DerivationError(step.name, f"the display {step.latex!r} is a chain of equations, or the values in order")
        for side in sides[1:]:
            same(step.name, sides[0], side)
    return Check(READ, f"{DIGITS} digits")


def _same(name: str, one: sp.Expr, other: sp.Expr) -> None:
    size = _definite(one)
    difference = size - _definite(other)
    if difference == 0:
        return
    if difference.atoms(AppliedUndef):  # a function that stands for itself, such as the pressure of Eq. 7
        raise DerivationError(name, READ, difference)
    draw = random.Random(name)
    symbols = sorted(difference.free_symbols | size.free_symbols, key=str)
    for _ in range(POINTS):
        point = {symbol: sp.Rational(draw.randint(20, 120), 100) for symbol in symbols}
        if alpha in point and beta in point:  # as for a material: alpha < beta
            point[alpha], point[beta] = sorted((point[alpha], point[beta] + sp.Rational(1, 200)))
        if chi in point:
            point[chi] = sp.Integer(draw.randint(0, 1))
        left = _number(difference, point)
        if not abs(left) < CLOSE * (1 + abs(_number(size, point))):
            raise DerivationError(name, READ, sp.N(left, 6))


def _number(expression: sp.Expr, point: Mapping[sp.Symbol, sp.Rational]) -> sp.Expr:
    """Value at a point; integrals by mpmath's quadrature."""
    return sp.N(
        expression.replace(sp.Integral, lambda body, over: _quadrature(body.xreplace(point), over, point)).xreplace(point), DIGITS
    )


def _quadrature(body: sp.Expr, over: sp.Tuple, point: Mapping[sp.Symbol, sp.Rational]) -> sp.Float:
    variable, low, high = over
    with mpmath.workdps(DIGITS):
        ends = [mpmath.mpf(str(sp.N(sp.sympify(end).xreplace(point), DIGITS))) for end in (low, high)]
        return sp.Float(str(mpmath.quad(sp.lambdify(variable, body, "mpmath"), ends)), DIGITS)


def _definite(expression: sp.Expr) -> sp.Expr:
    one_level = written_out(sp.sympify(expression)).replace(stack_sum, lambda term: term)
    return one_level.doit(integrals=False).subs(TIMES).subs(RELATIONS).subs(WAVE)


def of_levels(step: Derived) -> Check:
    """Compare the display of a step of Eq. 7 or 9 to 14, which is the same on any foundation, with what it derived."""
    return read_back(step, LEVELS[step.name](step.value))


def values_of(step: Derived) -> list[sp.Expr]:
    """The expressions that a step derived, in order."""
    return [part for part in flat(step.value) if isinstance(part, sp.Basic)]


def vocabulary(flows: Flows, field: sp.Expr) -> dict[str, Any]:
    """What the symbols of the displays mean, all from what was derived. ``w``, ``p``, ``z`` without more: complete contact."""
    strip = flows.strip
    model = strip.foundation.model
    modulus = sp.sqrt((1 + beta**2) / (1 + alpha**2))
    motion = sp.Symbol("s_motion", positive=True)
    return {
        "s": s, "s_0": s_0, "s_1": s_1, "end": s_1, "x": x, "y": y, "D": D, "D_j": D_j, "A": A, "J": J, "L": L, "K": K, "V": V,
        "k": k, "l": l, "h": h, r"\alpha": alpha, r"\beta": beta, r"\chi": chi, r"\pi": sp.pi, "p_0": p_0, r"\delta_0": delta_0,
        "p": p, "g_0": gap_0, "q_0": q_0, "w_0": w_0, "p_1": p_nominal, "a": a, "b": b, "c": c, "d": d, "e": excess, "i": sp.I,
        r"T_\epsilon": T_eps, r"T_\sigma": T_sigma, r"\omega": motion, r"\infty": sp.oo,
        "u": Of(s, strip.u), "H": Of(s, strip.law(strip.u, sp.Integer(0))), "p_sat": Of(s, field), "R": modulus,
        "g": Of(s, flows.gap.value), "w": Of(s, flows.relaxation.value), "q": Of(s, flows.contact.value + p_0),
        "K*": lambda place=sp.I * k * V: model.transfer(place), "P": Of(s, model.operator_p(s)), "Q": Of(s, model.operator_w(s)),
        r"\mathrmRe": Prefix(lambda e: sp.re(sp.expand_complex(e))), r"\mathrmIm": Prefix(lambda e: sp.im(sp.expand_complex(e))),
        r"\varphi": sp.atan(beta) - sp.atan(alpha), "oint": lambda body, phase: sp.Integral(body, (phase, 0, 2 * sp.pi)),
        "sum over i": lambda body, *ends: body, "h_i": h, "l_i": l,
    }  # fmt: skip


def bound(step: Derived, words: Mapping[str, Any]) -> dict[str, Any]:
    """The names that stand for the step's own value, or mean something of their own in it."""
    values = values_of(step)
    for prefix, binding in BINDINGS.items():
        if step.name.startswith(prefix):
            return binding(values, words)
    return {}


def named(*keys: str) -> Binding:
    return lambda values, words: dict(zip(keys, values, strict=False))


def _function(key: str) -> Binding:
    return lambda values, words: {key: Of(s, values[0])}


def _at_end(key: str) -> Binding:
    """A flow at s_1, as an expression."""
    return lambda values, words: {key: words[key](s_1)}


def _in_contact(values: list[sp.Expr], words: Mapping[str, Any]) -> dict[str, Any]:
    """p of the contact flow; what it adds to z is w - J p at the end less at the beginning."""
    pressure = words["q"].expression - p_0
    state = words["u"].expression - J * pressure
    return {"p": Of(s, pressure), r"\Deltaz": state.subs(s, s_1) - state.subs(s, s_0)}


def _entered(values: list[sp.Expr], words: Mapping[str, Any]) -> dict[str, Any]:
    return {"p": Of(s, (words["q"].expression - p_0).subs(q_0, p_in + p_0))}


def _lagging(values: list[sp.Expr], words: Mapping[str, Any]) -> dict[str, Any]:
    change = words["w"](s_1) - words["w"](s_0)
    return {r"\Deltaz": change.subs(w_0, lag_0 + p), "w_0": lag_0 + p}


def _motion(values: list[sp.Expr], words: Mapping[str, Any]) -> dict[str, Any]:
    """A motion that obeys the law: complete contact."""
    w, pressure = words["u"], words["p_sat"]
    return {"w": w, "p": pressure, "z": Of(s, w.expression - J * pressure.expression)}


def _as_one_harmonic(values: list[sp.Expr], words: Mapping[str, Any]) -> dict[str, Any]:
    phase = sp.Symbol("phi", positive=True)
    modulus = 1 / (sp.cos(phase) - alpha * sp.sin(phase))
    return {r"\varphi": phase, "R": modulus, "p_sat": Of(s, D - 1 + modulus * sp.cos(s + phase))}


def _threshold(values: list[sp.Expr], words: Mapping[str, Any]) -> dict[str, Any]:
    return {"D_j": A * values[0].subs(p_0, p_0 / (K * A))}


def _shape(values: list[sp.Expr], words: Mapping[str, Any]) -> dict[str, Any]:
    return {"u": Of(s, values[0]), "A": AMPLITUDE, "D_j": PENETRATION}


def _energies(values: list[sp.Expr], words: Mapping[str, Any]) -> dict[str, Any]:
    state = _motion(values, words)["z"]
    loss = beta / L * sp.Integral(sp.diff(state.expression, s) ** 2, (s, 0, 2 * sp.pi))
    heights = {f"w_{edge}": sp.Symbol(f"u_{edge}", real=True) for edge in "dbac"}
    return {"z": state, "E": loss, "X": values[0], r"\bar\tau": (loss + values[0]) / (2 * sp.pi), "K_g": 1 / J} | heights


def _least(values: list[sp.Expr], words: Mapping[str, Any]) -> dict[str, Any]:
    ratio = sp.Symbol("R", positive=True)
    own, below, last = sp.symbols("p_sat_i P_below P_M", positive=True)
    needed = sp.Max(own, below + (p_nominal - values[0]))
    return {r"\min": Prefix(lambda pressure: values[0]), "p_i": p_nominal, "R_i": ratio, "P_M": last, "p_sat,M": last,
            "p_sat,i": own, "P_i+1": below, "P_i": needed}  # fmt: skip


def _under_a_wave(values: list[sp.Expr], words: Mapping[str, Any]) -> dict[str, Any]:
    w = sp.Symbol("w", positive=True)
    return half_space.NAMES | {"w": w, "p": values[0] * w}


def _of_a_level(values: list[sp.Expr], words: Mapping[str, Any]) -> dict[str, Any]:
    modulus = half_space.E
    K_level = values[0] * sp.pi / l * modulus / (1 - half_space.nu**2)
    return half_space.NAMES | {"c": values[0], "E": lambda place: modulus, "K": lambda place: K_level}


CELL = {"l": l, "x": x, "y": y, "f": HEIGHT, r"\pi": sp.pi}


def _load(value: sp.Expr) -> dict[str, Any]:
    whole = lambda body, *variables: sp.Integral(body, *variables)  # noqa: E731
    return CELL | {r"\barp": value, "p": sp.Function("p"), r"iint \Omega": whole}


def _area(value: sp.Expr) -> dict[str, Any]:
    """Strips whose contact is linear in cos ky, which their middles sum exactly."""
    ahead, behind = ((m + n * sp.cos(k * y)).subs(WAVE) for m, n in (sp.symbols("m n"), sp.symbols("m' n'")))
    area = value.replace(sp.Function("length"), lambda place: (ahead + behind).subs(y, place))
    at_strip = {y: sp.Symbol("y_j", real=True)}
    return CELL | strips(2) | {"A": area.doit(), "a_j": ahead.subs(at_strip), "b_j": behind.subs(at_strip)}


def _means(value: tuple[sp.Expr, sp.Expr]) -> dict[str, Any]:
    own = {rf"\bar{mean}_j": sp.Function(f"{name}_j")(y) for mean, name in (("p", "p"), (r"\tau", "tau"))}
    return CELL | own | {r"\barp": value[0], r"\bar\tau": value[1]}


def _stress(value: sp.Expr) -> dict[str, Any]:
    return CELL | {r"\tau": lambda *place: value.subs(WAVE), "p": lambda *place: pressure}


def _shear(value: sp.Expr) -> dict[str, Any]:
    return CELL | {r"\tau_M-1": lambda *place: value, "p": pressure, "f_x": slope_x, r"\tau_M": lambda local: tau_below}


def _carried(value: sp.Expr) -> dict[str, Any]:
    """A pressure over the whole cell, and a law that is no straight line; in a strip, contact from x = -a to b."""
    behind, ahead = sp.symbols("x_a x_b", positive=True)
    field = lambda phase: 2 + sp.cos(phase) - sp.sin(phase) / 3  # noqa: E731
    law = lambda local: local**2 + 3  # noqa: E731
    along = lambda *phase: field(*phase) if phase else field(-k * x)  # noqa: E731
    cell = lambda body, *variables: l**2 * mean_over_cell(body)  # noqa: E731
    own = mean_over_cell(field(-k * x) * sp.diff(HEIGHT, x) + law(field(-k * x)))
    derived_part = value.replace(sp.Function("tau_M"), law).replace(sp.Function("p"), field)
    derived_part = derived_part.subs({s_0: -k * ahead, s_1: k * behind})
    return CELL | {r"\bar\tau_M-1": own, "f_x": sp.diff(HEIGHT, x), "p": along, r"\tau_M": law, "k": k, "a": behind, "b": ahead,
                   "s": s, "iint": cell, r"iint \text{contact}": cell, "C_j": derived_part}  # fmt: skip


def _coefficient(value: sp.Expr) -> dict[str, Any]:
    return {r"\mu": value, r"\tau_1": sp.Symbol("tau_1", real=True), "p_1": p_nominal}


LEVELS: dict[str, Callable[[Any], dict[str, Any]]] = {
    "equilibrium": _load,
    "contact area": _area,
    "local stress": _stress,
    "means over a level": _means,
    "local shear": _shear,
    "carried friction": _carried,
    "friction coefficient": _coefficient,
}
"""Eq. 7 and 9 to 14: what the symbols of their displays mean, the derived value among them."""
BINDINGS: dict[str, Binding] = {
    "half-space under a wave": _under_a_wave,
    "foundation that stands for a half-space": _of_a_level,
    "instantaneous compliance": named("J_0"),
    "strip profile": _shape,
    "dimensionless groups": _motion,
    "contact flow": _function("p"),
    "relaxation flow": _function("w"),
    "gap flow": _function("g"),
    "internal state": _motion,
    "power balance": _motion,
    "forcing_arc": named(r"\textcentre", r"\texthalf"),
    "relaxation_increment": _lagging,
    "contact_pressure": _in_contact,
    "contact_increment": _in_contact,
    "contact_work": _entered,
    "gap_event": named("g", "g'"),
    "excess_entry": _as_one_harmonic,
    "gap_link": _at_end("g"),
    "excess_link": _at_end("q"),
    "saturated_pressure": _function("p_sat"),
    "means_c": lambda values, words: {r"\barp": values[0], r"\bar\tau": values[1], "p": words["p_sat"]},
    "means_": named(r"\barp", r"\bar\tau"),
    "saturation threshold": _threshold,
    "level_saturation_penetration": named("D_sat"),
    "level_saturation_pressure": named("p_sat"),
    "level_saturation_friction": named(r"\tau_sat"),
    "saturated_stack_friction": named(r"\mu"),
    "Eq. 16 as printed": named(r"\textderived", r"\textprinted"),
    "friction balance": _energies,
    "onset_slope": named("T'"),
    "least pressure": _least,
}
"""By the beginning of a step's name."""
