"""What the pages say in words (``words.toml``): misprints and silences of the paper, demonstrated from the steps."""

import tomllib
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import sympy as sp

from ..check import Derived
from ..level import FIGURE_7
from ..surface import HEIGHT
from ..symbols import D_level, K, T_eps, T_sigma, V, h, k, l, p_nominal, x, y

WORDS = tomllib.loads(Path(__file__).with_name("words.toml").read_text(encoding="utf-8"))


def misprints(steps: Mapping[str, Derived], kind: str) -> list[dict[str, Any]]:
    """Misprints and silences on the pages of a ``kind``, with what follows from each in numbers.

    ``measured`` names a table of the measured figures.
    """
    return [_row(steps, **text) for text in WORDS["misprints"] if text.get("of", kind) == kind]


def _row(known: Mapping[str, Derived], step: str = "", reason: str = "", numbers: str = "", **text: Any) -> dict[str, Any]:
    """A misprint as the ``step`` that answers it has it, if ``text`` does not say otherwise; ``reason``: a step that says why."""
    row = {"equations": [], "shown": "", "table": None, "measured": "", "latex": "", "steps": [step]}
    if step:
        row |= {"here": known[step].statement, "latex": known[step].latex, "why": known[step].correction}
    row |= {key: value for key, value in text.items() if key != "of"}
    if reason:
        row["why"] = f"{known[reason].statement} {text.get('why', '')}".strip()
    row["steps"] = [name for name in row["steps"] if name in known]
    return row | (NUMBERS[numbers](known[step]) if numbers else {})


def _sign_of_equation_6(step: Derived) -> dict[str, Any]:
    """Depth under crest and valley with either sign."""
    crest, valley = {x: 0, y: 0}, {x: sp.pi / k, y: 0}
    rows = []
    for form, w in (("w = f + D, as printed", HEIGHT + D_level), ("w = D - f", D_level - HEIGHT)):
        rows.append([form, *(f"${sp.latex(sp.expand(sp.simplify(w.subs(place))))}$" for place in (crest, valley))])
    shown = f"As printed the foundation is deepest under the valley, {rows[0][2]}; it is under the crest, {rows[1][1]}."
    return {"shown": shown, "table": {"head": ["", "w under the crest", "w under the valley"], "rows": rows}}


SCENE = {K: "1e9", T_eps: "1/100", T_sigma: "1/10000", p_nominal: "5e6"}
MICRO = 10**6  # the same lengths in micrometres: the pressures and times stay in Pa and s


def _equation_16(step: Derived) -> dict[str, Any]:
    """The levels of Fig. 7 as derived and as printed, in two units of length."""
    true, printed = step.value
    given = {symbol: sp.Rational(value) for symbol, value in SCENE.items()}
    rows = []
    for number, (length, height) in enumerate(FIGURE_7, 1):
        scene = {**given, l: length, h: height}
        scene[V] = scene[l] / (2 * sp.pi * scene[T_sigma])
        other = {**scene, K: scene[K] / MICRO, **{symbol: scene[symbol] * MICRO for symbol in (l, h, V)}}
        terms = (true.subs(scene), true.subs(other), printed.subs(scene), printed.subs(other))
        rows.append([str(number), *map(_figure, (scene[l], scene[h], scene[V], *terms, terms[2] / terms[0]))])
    peaks = (", ".join(line[column] for line in rows) for column in (4, 6))
    return {
        "shown": "Fig. 7: the levels' own peaks are {}; as printed, with lengths in m, {}.".format(*peaks),
        "table": WORDS["figure_7"] | {"rows": rows},
    }


NUMBERS = {"sign_of_equation_6": _sign_of_equation_6, "equation_16": _equation_16}


def _figure(value: sp.Expr) -> str:
    return f"{float(sp.N(value, 30)):.4g}"
