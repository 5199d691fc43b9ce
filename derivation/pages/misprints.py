"""Misprints and silences of the paper, with demonstrations computed from the steps."""

from __future__ import annotations

from typing import Any

import sympy as sp

from ..check import Derived
from ..surface import HEIGHT
from ..symbols import D_level, K, T_eps, T_sigma, V, h, k, l, p_nominal, x, y


def misprints(steps: tuple[Derived, ...]) -> list[dict[str, Any]]:
    """Misprints and silences, with what follows from each in numbers. ``measured`` names a table of the measured figures."""
    by_name = {step.name: step for step in steps}
    return [
        sign_of_equation_6(by_name["zone conditions"]),
        stiffness(by_name["relaxed stiffness"], "instantaneous compliance"),
        _contact_alone(by_name["local shear"]),
        _closure(by_name["closures"], by_name["jump law"]),
        _unloading(),
        _equation_16(by_name["Eq. 16 as printed"]),
    ]


def row(what: str, printed: str, step: Derived | None, equations: tuple[int, ...] = (), **more: Any) -> dict[str, Any]:
    """A misprint or silence as the ``step`` that answers it has it, if ``more`` does not say otherwise."""
    own = {"here": step.statement, "latex": step.latex, "why": step.correction, "steps": [step.name]} if step else {"latex": ""}
    common = {"equations": list(equations), "what": what, "printed": printed, "shown": "", "table": None, "measured": ""}
    return common | own | more


def sign_of_equation_6(step: Derived) -> dict[str, Any]:
    """Depth under crest and valley with either sign."""
    crest, valley = {x: 0, y: 0}, {x: sp.pi / k, y: 0}
    rows = []
    for form, w in (("w = f + D, as printed", HEIGHT + D_level), ("w = D - f", D_level - HEIGHT)):
        rows.append([form, *(f"${sp.latex(sp.expand(sp.simplify(w.subs(place))))}$" for place in (crest, valley))])
    return row(
        "Sign in Eq. 6",
        "w = f + D",
        step,
        (6,),
        here="w = D - f",
        shown=f"As printed the foundation is deepest under the valley, {rows[0][2]}; it is under the crest, {rows[1][1]}.",
        table={"head": ["", "w under the crest", "w under the valley"], "rows": rows},
    )


def stiffness(step: Derived, *others: str) -> dict[str, Any]:
    """What K read as the one and as the other would mean. ``others``: further steps that show it."""
    K_number, pressure = sp.Integer(10) ** 9, sp.Integer(100)
    right, wrong = _figure(pressure / K_number), _figure(pressure * K_number)
    return row(
        "K called a compliance",
        "K is introduced as the elastic compliance of the foundation.",
        step,
        (1,),
        shown=f"Under 100 Pa a foundation with K = 1e9 yields {right} m, not {wrong} m.",
        why="At rest Eq. 1 reads p = K w: K is a stiffness per area, in Pa/m, and the compliance is 1/K.",
        steps=[step.name, *others],
        table={
            "head": ["K = 1e9 read as", "displacement under 100 Pa"],
            "rows": [["stiffness, Pa/m", f"{right} m"], ["compliance, m/Pa", f"{wrong} m"]],
        },
    )


JUMPS = "What w does where p steps"
SILENT = "Nothing is said of the edges d and -c, where the traction begins and ends."


def _closure(step: Derived, law: Derived) -> dict[str, Any]:
    return row(
        JUMPS,
        SILENT,
        step,
        why=law.statement + " Keeping w continuous instead leaves the instantaneous response to the step out; the energy "
        "balance then holds only with the correction X of the friction balance.",
        steps=[law.name, "internal state", step.name, "power balance", "friction balance acaf"],
        measured="balance",
    )


def _contact_alone(step: Derived) -> dict[str, Any]:
    return row(
        "Eq. 12 to 14: the whole cell, or the contact alone",
        "The stress of the lower level is added at every point, and both integrals of Eq. 13 and 14 run over the cell.",
        step,
        (12, 13, 14),
        here="It is added where the level above is in contact.",
        steps=[step.name, "carried friction", "friction coefficient"],
        measured="readings",
    )


def _unloading() -> dict[str, Any]:
    return row(
        "Which of several solutions is meant",
        "Where the friction of a level over its nominal pressure is ambiguous, its upper part is taken, which the text says "
        "is the stable solution at unloading. Of several solutions for a strip at one penetration nothing is said.",
        None,
        here="For a strip, the most engaged periodic orbit, the limit from an arbitrarily deeply pressed contact; for a level, "
        "the largest penetration that carries the nominal pressure. The least engaged orbit is the limit from a free surface far "
        "below, and can be asked for.",
        why="The map of a material point's state over one period preserves order, so both exist, and every other periodic "
        "orbit lies between them. An orbit is stable where the slope of the onset-to-onset map is below 1.",
        steps=["shift of an event", "onset_slope_acaf", "onset_slope_af"],
        measured="branches",
    )


FIGURE_7 = {"K": "1e9", "T_eps": "1/100", "T_sigma": "1/10000", "p_1": "5e6"}
FIGURE_7_LEVELS = (("1/100000", "1/1000000"), ("5/10000000", "1/10000000"), ("5/1000000000", "5/1000000000"))
PRINTED_16 = "Factor pi^2, h_i to the first power, and a sum up to N."
MICRO = 10**6  # the same lengths in micrometres: the pressures and times stay in Pa and s


def _equation_16(step: Derived) -> dict[str, Any]:
    true, printed = step.value
    names = {K: "K", T_eps: "T_eps", T_sigma: "T_sigma", p_nominal: "p_1"}
    given = {symbol: sp.Rational(FIGURE_7[name]) for symbol, name in names.items()}
    rows = []
    for number, (length, height) in enumerate(FIGURE_7_LEVELS, 1):
        scene = {**given, l: sp.Rational(length), h: sp.Rational(height)}
        scene[V] = scene[l] / (2 * sp.pi * scene[T_sigma])
        other = {**scene, K: scene[K] / MICRO, **{symbol: scene[symbol] * MICRO for symbol in (l, h, V)}}
        terms = (true.subs(scene), true.subs(other), printed.subs(scene), printed.subs(other))
        rows.append([str(number), *map(_figure, (scene[l], scene[h], scene[V], *terms, terms[2] / terms[0]))])
    return row(
        "Eq. 16: power of h, factor, dimensions, upper limit",
        PRINTED_16,
        step,
        (16,),
        here="Factor 3 pi^2/16, h_i squared, and a sum up to M: M counts the levels, N the strips of one level.",
        shown=f"Fig. 7: the levels' own peaks are {', '.join(line[4] for line in rows)}; as printed, with lengths in m, "
        f"{', '.join(line[6] for line in rows)}.",
        steps=["saturated_stack_friction", step.name, "levels in complete contact together",
               "least pressure in complete contact"],
        table={
            "caption": "Fig. 7, nominal pressure 5 MPa: each level's friction coefficient at its own peak. As printed, the third "
            "level would be the highest, where the paper's text says that the first is, and the number depends on the unit.",
            "head": ["level", "l, m", "h, m", "V at the peak, m/s", "mu, lengths in m", "in µm", "mu as printed, lengths in m",
                     "in µm", "printed/true, in m"],
            "rows": rows,
        },
    )  # fmt: skip


SMALL = (
    ("Eq. 1, 5, 15", "The retardation time is T_ε in two shapes, and T_e in the text.", "T_eps throughout.", "misprint"),
    ("Eq. 1", "K is called an elastic compliance, and given as E/H for a layer of modulus E and thickness H.",
     "E/H is a stiffness per area, and used as one.", "misnomer"),
    ("Eq. 8", "Only the penetration of a strip is written down.", "Its amplitude follows from Eq. 4: (h/4)(1 + cos "
    "ky).", "silence"),
    ("Eq. 8", "Which strips there are is nowhere said: y_j can be their edges or their middles.",
     "Middles: with edges, y_1 = 0, the friction of complete contact is too large by 4/(3 N), see Eq. 11.", "silence"),
    ("Eq. 9, 11, 13, 14", "The sums run over j = 1 .. N, the strips of half a cell.",
     "Fig. 5 shows strips 0, the central one, and 63 of N = 100, so it counts from 0.", "misprint"),
    ("after Eq. 8", "The two to four equations for the edges a, b, c, d are not printed.",
     "Derived here for every regime, and once more in the paper's variables in the step strip problem.", "silence"),
    ("before Eq. 13", "The cell of the mean has the index i.", "It is the cell of level M - 1.", "misprint"),
    ("Eq. 14", "Written out for levels 1 and 2.", "The recursion is the same for any number.", "silence"),
    ("Eq. 15", "D has no index.", "D_i, the penetration of level i.", "misprint"),
    ("Eq. 16", "The sum over the levels ends at N.", "M: N counts strips.", "misprint"),
    ("Fig. 5", "Strip 63 of 100 is in complete contact; the text gives gamma = 2.5e-5 N/m.",
     "With it the first such strip is number 75, with 5e-5 number 62: the figure was probably drawn for the larger "
     "energy of Fig. 6.",
     "open"),
    ("Fig. 6", "Drawn for two energies of adhesion, of which the text gives one.", "Scanned: see Fig. 6 answered.", "silence"),
)  # fmt: skip
"""Small misprints and silences: where, print, here, kind."""


def _figure(value: sp.Expr, digits: int = 4) -> str:
    return f"{float(sp.N(value, 30)):.{digits}g}"
