"""One strip worked through in numbers, regime by regime: each number beside its formula and the emitted function."""

from typing import Any

import numpy as np
import sympy as sp

from hystrip.derivation.sequences import CONTACT, Span, zones_of
from hystrip.derivation.symbols import PARAMETERS, J, chi, p_0

from .pictures import scenes, solved

OWN = "standard_linear_solid"
POINTS = 20000  # of the plain sums that the means are compared with


def worked() -> list[dict[str, Any]]:
    """A table for each scene of the pictures: rows of quantity, formula, number, function."""
    return [_table(scene) for scene in scenes(OWN)]


def _table(scene: dict[str, Any]) -> dict[str, Any]:
    from hystrip.generated import standard_linear_solid as solver

    strip = solved(scene)
    sequence = {"cf": "ac"}.get(str(strip.regime), str(strip.regime))
    unit, k = scene["K"] * scene["A"], 2 * np.pi / scene["l"]
    turn, ratio = k * scene["V"], scene["T_sigma"] / scene["T_eps"]
    groups = dict(
        zip(
            map(str, PARAMETERS),
            (turn * scene["T_sigma"], turn * scene["T_eps"], ratio, 1 - ratio, scene["p_0"] / unit, scene["delta_0"] / scene["A"],
             scene["D"] / scene["A"], float(scene["edge"] == "constitutive")),
            strict=True,
        )
    )  # fmt: skip
    formulas = (
        r"k V T_\sigma", r"k V T_\epsilon", r"T_\sigma/T_\epsilon", "1 - J", "p_0/(K A)", r"\delta_0/A", "D_j/A",
        r"\text{closure}",
    )  # fmt: skip
    rows = [_row(name, latex, value, "") for (name, value), latex in zip(groups.items(), formulas, strict=True)]
    regime = solver.REGIMES[sequence]
    given = tuple(groups.values())
    edges: list[float] = []
    if regime["edges"]:
        at = {"a": strip.a, "b": -strip.b, "c": strip.c, "d": -strip.d if sequence != "afc" else -strip.b}
        edges = [k * float(at[name]) for name in regime["edges"]]
        rows += [_row(name, f"s_{name}", value, "") for name, value in zip(regime["edges"], edges, strict=True)]
        rows += _zones(sequence, dict(zip(regime["edges"], edges, strict=True)), groups, solver)
        for label, left in zip(regime["equations"], regime["residual"](*edges, *given), strict=True):
            rows.append(_row(f"{label.replace('_', ' ')}: left over", "0", float(left), f"residual_{sequence}"))
    mean_p, mean_tau = (float(value) for value in regime["means"](*edges, *given))
    x = (np.arange(POINTS) + 0.5) / POINTS * scene["l"] - scene["l"] / 2
    pressure, slope = strip.pressure(x), scene["A"] * k * np.sin(k * x)
    rows += [
        _row("mean p, in K A", r"\frac{1}{2\pi}\oint p\,ds", mean_p, f"means_{sequence}"),
        _row("mean tau, in K A k A", r"\frac{1}{2\pi}\oint p\,u'\,ds", mean_tau, f"means_{sequence}"),
        _row("mean p, Pa", r"K A\,\bar p", mean_p * unit, ""),
        _row("the same by a plain sum of p(x), Pa", r"\frac1l \int p\,dx", float(pressure.mean()), ""),
        _row("mean tau, Pa", r"K A\,k A\,\bar\tau", mean_tau * unit * k * scene["A"], ""),
        _row("the same by a plain sum of p f_x, Pa", r"\frac1l \int p\,f_x\,dx", float((pressure * slope).mean()), ""),
    ]
    return {
        "title": f"{strip.regime}: {strip.regime_name}, {scene['edge']}",
        "head": ["", "formula", "number", "function"],
        "rows": rows,
    }


def _zones(sequence: str, edges: dict[str, float], groups: dict[str, float], solver: Any) -> list[list[str]]:
    """Each zone with the state in which it is entered and what its flow makes of it at its end."""
    numbers = {symbol: sp.Float(groups[str(symbol)], 17) for symbol in PARAMETERS}
    places = {sp.Symbol(name, real=True): sp.Float(value, 17) for name, value in edges.items()}
    rows = []
    for zone in zones_of(sequence, Span, chi * J * p_0 if sequence != "afc" else J * p_0, J):
        first, last, entry = (float(sp.sympify(part).subs(places).subs(numbers)) for part in (zone.first, zone.last, zone.entry))
        D, alpha, beta, L = (groups[name] for name in ("D", "alpha", "beta", "L"))
        if zone.kind == CONTACT:
            name, value = "excess_after", solver.excess_after(first, last, entry, groups["p_0"], D, alpha, beta, L)
        else:
            load = float(sp.sympify(zone.load).subs(numbers))
            name, value = "gap_after", solver.gap_after(first, last, entry, load, D, beta)
        state, letter = ("p + p_0", "q") if zone.kind == CONTACT else ("gap", "g")
        rows.append(_row(f"{zone.kind} from {zone.first}: {state} at its start", sp.latex(zone.entry), entry, ""))
        last_edge = sp.latex(zone.last)
        rows.append(_row(f"{state} at its end, asked to be {zone.exit}", f"{letter}({last_edge})", float(value), name))
    return rows


def _row(what: str, latex: str, value: float, function: str) -> list[str]:
    return [what, f"${latex}$", f"{value:.6g}" if abs(value) > 1e-12 else f"{value:.0e}" if value else "0", function]
