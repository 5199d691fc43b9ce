"""The printed paper: its equations by number, its misprints and silences, with demonstrations computed from the steps."""

from __future__ import annotations

import re
from typing import Any

import sympy as sp

from ..check import CORRECTED, REPRODUCED, Derived
from ..surface import HEIGHT
from ..symbols import D_level, K, T_eps, T_sigma, V, h, k, l, p_nominal, x, y

TITLE = (
    "Modeling Sliding Friction of a Multiscale Wavy Surface over a Viscoelastic Foundation Taking into Account Adhesion "
    "(Makhovskaya, Lubricants 2019, 7, 13)"
)
SUBJECTS = {
    1: "law of the foundation",
    2: "traction of adhesion",
    3: "specific energy of adhesion",
    4: "shape of a level",
    5: "law in the moving frame",
    6: "displacement in contact",
    7: "by its place: conditions in contact and out of it",
    8: "amplitude and penetration of a strip",
    9: "by its place: conditions of the problem of a strip",
    10: "means over a strip",
    11: "means over a level",
    12: "shear of a level that carries another",
    13: "mean of that shear",
    14: "friction coefficient",
    15: "pressure of complete contact",
    16: "friction coefficient in complete contact on all levels",
}
MAIN = {10: ("means_acaf", "means of a strip"), 11: ("means over a level",), 15: ("saturated_pressure",)}
"""The step that states an equation, where that is not the first with its number."""
UNSEEN = (
    "The printed form of this number was not at hand and is not compared here. By its place, between {before} and {after}, it is "
    "about {subject}. What is derived for it comes from the statement of the problem that this derivation was made from, which "
    "was written beside the paper and names every point where the two differ: {differs}. Derived: "
)
PLACES = {
    7: (
        {
            "before": "Eq. 6 (displacement in contact)",
            "after": "Eq. 8 (strips)",
            "subject": "what holds in contact and out of it",
            "differs": "the sign of Eq. 6, and nothing in these conditions",
        },
        ("zone conditions", "adhesion law"),
    ),
    9: (
        {
            "before": "Eq. 8 (strips)",
            "after": "Eq. 10 (their means)",
            "subject": "the conditions that determine the edges of a strip",
            "differs": "of these, what w does where p steps, on which the paper is silent (see the misprints and silences)",
        },
        ("strip problem", "regime acaf"),
    ),
}
"""Numbers whose printed form was not seen: the words for the note, and the steps that state what belongs there."""


def numbers(paper: str) -> list[int]:
    """Equation numbers in a citation such as ``Eq. 10-11`` or ``Eq. 2, 3``."""
    found: list[int] = []
    for first, last in re.findall(r"(\d+)(?:-(\d+))?", paper):
        found += range(int(first), int(last or first) + 1)
    return found


def equations(steps: tuple[Derived, ...], misprinted: list[dict[str, Any]]) -> list[dict[str, Any]]:
    """The contents by equation number; the first of a row's steps is the one that states the equation.

    ``compared``: whether the printed form was seen.
    """
    wrong = {number for row in misprinted for number in row["equations"]}
    by_name = {step.name: step for step in steps}
    rows = []
    for number, subject in SUBJECTS.items():
        words, names = PLACES.get(number, ({}, ()))
        cited = [step.name for step in steps if number in numbers(step.paper)]
        listed = list(dict.fromkeys(name for name in (*MAIN.get(number, ()), *names, *cited) if name in by_name))
        rows.append(
            {
                "number": number,
                "subject": subject,
                "status": CORRECTED if number in wrong else REPRODUCED,
                "compared": not words,
                "note": UNSEEN.format(**words) + by_name[listed[0]].statement if words else "",
                "steps": listed,
            }
        )
    return rows


def misprints(steps: tuple[Derived, ...]) -> list[dict[str, Any]]:
    """Misprints and silences, with what follows from each in numbers. ``measured`` names a table of the measured figures."""
    by_name = {step.name: step for step in steps}
    return [
        sign_of_equation_6(by_name["strip profile"]),
        stiffness(by_name["relaxed stiffness"], "instantaneous compliance"),
        _closure(by_name["closures"], by_name["jump law"]),
        _unloading(),
        _equation_16(by_name["Eq. 16 as printed"]),
    ]


def sign_of_equation_6(step: Derived) -> dict[str, Any]:
    """Depth under crest and valley with either sign."""
    crest, valley = {x: 0, y: 0}, {x: sp.pi / k, y: 0}
    rows = []
    for form, w in (("w = f + D, as printed", HEIGHT + D_level), ("w = D - f", D_level - HEIGHT)):
        rows.append([form, *(f"${sp.latex(sp.expand(sp.simplify(w.subs(place))))}$" for place in (crest, valley))])
    return {
        "equations": [6],
        "what": "Sign in Eq. 6",
        "printed": "w = f + D",
        "here": "w = D - f",
        "shown": f"As printed the foundation is deepest under the valley, {rows[0][2]}; it is under the crest, {rows[1][1]}.",
        "latex": step.latex,
        "why": step.correction,
        "steps": [step.name],
        "table": {"head": ["", "w under the crest", "w under the valley"], "rows": rows},
        "measured": "",
    }


def stiffness(step: Derived, *others: str) -> dict[str, Any]:
    """What K read as the one and as the other would mean. ``others``: further steps that show it."""
    K_number, pressure = sp.Integer(10) ** 9, sp.Integer(100)
    right, wrong = _figure(pressure / K_number), _figure(pressure * K_number)
    return {
        "equations": [1],
        "what": "K called a compliance",
        "printed": "K is introduced as the elastic compliance of the foundation.",
        "here": step.statement,
        "shown": f"Under 100 Pa a foundation with K = 1e9 yields {right} m, not {wrong} m.",
        "latex": step.latex,
        "why": "At rest Eq. 1 reads p = K w: K is a stiffness per area, in Pa/m, and the compliance is 1/K.",
        "steps": [step.name, *others],
        "table": {
            "head": ["K = 1e9 read as", "displacement under 100 Pa"],
            "rows": [["stiffness, Pa/m", f"{right} m"], ["compliance, m/Pa", f"{wrong} m"]],
        },
        "measured": "",
    }


SILENT = "Nothing is said of the edges d and -c, where the traction begins and ends."


def _closure(step: Derived, law: Derived) -> dict[str, Any]:
    return {
        "equations": [],
        "what": "What w does where p steps",
        "printed": SILENT,
        "here": step.statement,
        "shown": "",
        "latex": step.latex,
        "why": law.statement + " Keeping w continuous instead leaves the instantaneous response to the step out; the energy "
        "balance then holds only with the correction X of the friction balance.",
        "steps": [law.name, "internal state", step.name, "power balance", "friction balance acaf"],
        "table": None,
        "measured": "balance",
    }


def _unloading() -> dict[str, Any]:
    return {
        "equations": [],
        "what": 'Which solution is "stable at unloading"',
        "printed": 'Several solutions can exist at one penetration; the text takes the one that is "stable at unloading" and '
        "does not define it.",
        "here": "The most engaged periodic orbit, the limit from an arbitrarily deeply pressed contact. Its counterpart, the "
        "least engaged orbit, is the limit from a free surface far below. Both can be asked for.",
        "shown": "",
        "latex": "",
        "why": "The map of a material point's state over one period preserves order, so both exist, and every other periodic "
        "orbit lies between them. An orbit is stable where the slope of the onset-to-onset map is below 1.",
        "steps": ["shift of an event", "onset_slope_acaf", "onset_slope_af"],
        "table": None,
        "measured": "branches",
    }


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
    return {
        "equations": [16],
        "what": "Eq. 16: power of h, factor, dimensions, upper limit",
        "printed": PRINTED_16,
        "here": "Factor 3 pi^2/16, h_i squared, and a sum up to M: M counts the levels, N the strips of one level.",
        "shown": f"Fig. 7: the levels' own peaks are {', '.join(row[4] for row in rows)}; as printed, with lengths in m, "
        f"{', '.join(row[6] for row in rows)}.",
        "latex": step.latex,
        "why": step.correction,
        "steps": ["saturated_stack_friction", step.name, "levels in complete contact together",
                  "least pressure in complete contact"],
        "table": {
            "caption": "Fig. 7, nominal pressure 5 MPa: each level's friction coefficient at its own peak. As printed, the third "
            "level would be the highest, where the paper's text says that the first is, and the number depends on the unit.",
            "head": ["level", "l, m", "h, m", "V at the peak, m/s", "mu, lengths in m", "in µm", "mu as printed, lengths in m",
                     "in µm", "printed/true, in m"],
            "rows": rows,
        },
        "measured": "",
    }  # fmt: skip


def _figure(value: sp.Expr, digits: int = 4) -> str:
    return f"{float(sp.N(value, 30)):.{digits}g}"
