"""The grid: how every input is drawn, over the whole range on which a solver may ask for a function.

Some draws of an input come from the decades that matter most, the rest from all that is admitted; ``WORDS`` say from which.
"""

import math
import random
from collections.abc import Callable, Sequence

import mpmath
import numpy as np
import sympy as sp

from ..modes.states import exact_modes
from ..modes.symbols import STATES, m
from ..printing import source
from ..symbols import D, J, L, T_eps, T_sigma, a, alpha, b, beta, c, chi, d, p, p_0, s, s_0, s_1
from .point import ZERO, Point, following, rounded

PHASES = (d, b, a, c, s, s_0, s_1)
EDGES = PHASES[:4]
GROUPS = {alpha, beta, J, L}  # of one relaxation time, drawn together
PERIOD = 2 * math.pi
TURN = sp.Symbol("pi", positive=True)  # pi, where it is an input that is known to its own digits
NARROW = 1e-9  # the narrowest zone
Random = random.Random
Range = tuple[Callable[[Random], float], str]


def log(draw: Random, low: float, high: float) -> float:
    return 10.0 ** draw.uniform(low, high)


def signed(draw: Random, low: float, high: float) -> float:
    return draw.choice((-1.0, 1.0)) * log(draw, low, high)


FAR = (-30, 48)  # decades of a length or pressure of a strip, in its amplitude: groups are admitted up to 1e18 times 1 + beta
WIDE = "1e-30 .. 1e48"
SI = (-40, 40)  # decades of inputs in SI: no input may be beyond
SI_WIDE = "1e-40 .. 1e40"
TRACTION = f"0, unless adhesion begins, or {WIDE}"
DOMAIN: dict[str, Range] = {
    "D": (
        lambda r: r.choice((0.0, signed(r, *FAR), signed(r, -9, 6), 1.0 + signed(r, -9, 0), r.uniform(-2.0, 3.0))),
        f"0, +-{WIDE}, near 1 and near -p_0",
    ),
    "p_0": (lambda r: r.choice((0.0, log(r, *FAR), log(r, -9, 9), log(r, -2, 1))), TRACTION),
    "delta_0": (lambda r: r.choice((log(r, *FAR), log(r, -9, 6), log(r, -2, 1))), WIDE),
    "chi": (lambda r: r.choice((0.0, 1.0)), "0 and 1"),
    "p": (lambda r: r.choice((0.0, -log(r, *FAR), -log(r, -9, 9), -log(r, -2, 1))), "0 or -p_0"),
    "gap_0": (lambda r: r.choice((0.0, log(r, *FAR), log(r, -9, 6), signed(r, -3, 1))), f"0, {WIDE}, -10 .. 10"),
    "q_0": (lambda r: r.choice((0.0, 0.0, signed(r, -9, 9), signed(r, *FAR))), f"0, +-{WIDE}"),
    "p_in": (lambda r: r.choice((0.0, -log(r, *FAR), -log(r, -9, 9), signed(r, -3, 3))), f"0, -({WIDE}), +-1e-3 .. 1e3"),
    "lag_0": (lambda r: r.choice((signed(r, -9, 9), signed(r, *FAR))), f"+-{WIDE}"),
    "w_0": (lambda r: r.choice((signed(r, -9, 6), signed(r, *FAR))), f"+-{WIDE}"),
    "excess": (lambda r: r.choice((0.0, log(r, -9, 9), log(r, *FAR))), f"0, {WIDE}"),
    "kV": (lambda r: r.choice((0.0, log(r, -30, 30))), "0, 1e-30 .. 1e30 1/s"),
    "K": (lambda r: log(r, *SI), f"{SI_WIDE} Pa/m"),
    "T_eps": (lambda r: log(r, *SI), f"{SI_WIDE} s"),
    "T_sigma": (lambda r: r.choice((0.0, 1.0, log(r, -30, 0))), "0, 1e-30 T_eps .. T_eps"),  # of T_eps
    "l": (lambda r: log(r, *SI), f"{SI_WIDE} m"),
    "h": (lambda r: log(r, *SI), f"{SI_WIDE} m"),
    "V": (lambda r: r.choice((0.0, log(r, *SI), log(r, -9, 2))), f"0, {SI_WIDE} m/s"),
}
OF_STATES = (lambda r: r.choice((0.0, signed(r, *FAR), signed(r, -9, 6), signed(r, -2, 1))), f"0, +-{WIDE}, each mode by itself")
WORDS = {
    **{name: words for name, (_, words) in DOMAIN.items()},
    "alpha, beta": "beta 0, 1e-30 .. 1e30; J = alpha/beta 0, 1e-30 .. 1, 1 - 1e-16 .. 1",
    "phases": "the first anywhere in a period, near a crest or valley within 1e-9; widths 1e-9 .. 2 pi",
    "m": "1 to 30 interlaced times (of a model for any number of them), spread over 2 to 12 decades, some within 1e-9 of their "
    "neighbours, the least 0; k V 0, 1e-30 .. 1e22, the longest time times k V up to 1e30",
    "states": OF_STATES[1],
}


def drawn(
    args: Sequence[sp.Symbol],
    seed: str,
    modes: int = 0,
    moving: bool = False,
    dashpots: bool | None = None,
    narrow: bool = False,
) -> Point:
    """A point for a function with these arguments; ``modes``: of a foundation with a Prony series.

    ``moving``: never at rest, V = 0. ``dashpots``: whether the least time is 0, always or never; drawn if None. ``narrow``: all
    zones of a regime but one, or the last and those that stand behind a wide one.
    """
    draw = Random(f"{seed} {' '.join(map(str, args))} {modes}")
    edges = [symbol for symbol in PHASES if symbol in args]
    exact: dict[sp.Symbol, object] = dict(_phases(draw, edges, narrow))
    follow = {}
    if GROUPS & set(args) and m not in args:
        inputs, follow = _one_time(draw, args)
        exact |= inputs | following(follow, inputs)
    if m in args:
        exact |= _material(draw, modes, moving, dashpots)
    for symbol in args:
        name = source(symbol)
        if symbol in exact or symbol == m:
            continue
        if symbol in STATES:
            exact[symbol] = np.array([mpmath.mpf(OF_STATES[0](draw)) for _ in range(modes)], dtype=object)
        else:
            exact[symbol] = mpmath.mpf(DOMAIN[name][0](draw))
    if d in exact and p_0 in exact and not exact[p_0]:  # without traction there are no zones of adhesion
        exact[p_0] = mpmath.mpf(log(draw, -2, 1))
    if narrow and d not in exact and {b, D, p_0} <= exact.keys() and draw.random() < 0.5:  # strong adhesion, light contact
        exact[p_0] = mpmath.mpf(log(draw, -2, 18))
        exact[D] = mpmath.mpf(float(-exact[p_0] * (1 + signed(draw, -9, 0))))
    if p in exact and p_0 in exact:
        exact[p] = draw.choice((mpmath.mpf(0), -exact[p_0]))
    if T_sigma in exact:
        exact[T_sigma] = mpmath.mpf(float(exact[T_eps] * exact[T_sigma]))
    given = {symbol: rounded(value) for symbol, value in exact.items()}
    return Point(exact | {TURN: +mpmath.pi}, given, tuple(edges), modes or 1, follow)


def _phases(draw: Random, edges: Sequence[sp.Symbol], narrow: bool) -> dict[sp.Symbol, mpmath.mpf]:
    """Phases in order, as floats; of a regime's edges, the last zone is wider than 1e-9 as the others."""
    near = draw.choice((-math.pi, math.pi / 2, 0.0)) + signed(draw, -9, -1)
    position = draw.choice((draw.uniform(-math.pi, math.pi), signed(draw, -9, 0), near))
    if narrow:  # half of them at a crest or valley, where little is left of the work of what is narrow
        position = draw.choice((position, draw.choice((0.0, math.pi)) + signed(draw, -9, -3)))
    tight = narrow and draw.random() < 0.5
    wide = draw.randrange(0 if tight else 1, len(edges)) if narrow else None
    room, found = PERIOD, {}
    for number, edge in enumerate(edges):
        if number:
            if number == wide:
                width = room - log(draw, -9, -3)
            elif tight:
                width = min(log(draw, -9, -3), room / 2)
            else:
                width = draw.choice((log(draw, -9, 0), draw.uniform(0.0, 1.5), draw.uniform(0.0, room), room - log(draw, -9, 0)))
            width = min(max(width, NARROW), room - NARROW * (len(edges) - number))  # which leaves as much for those that follow
            room -= width
            position = position + width
        found[edge] = mpmath.mpf(position)
    return found


def _one_time(draw: Random, args: Sequence[sp.Symbol]) -> tuple[dict[sp.Symbol, mpmath.mpf], dict[sp.Symbol, sp.Expr]]:
    """beta and the independent one of J and L; how alpha and the other follow."""
    time = mpmath.mpf(draw.choice((0.0, log(draw, -30, 30), log(draw, -2, 2), log(draw, -8, 9), log(draw, -2, 2)))) or ZERO
    trailing, alone = args[0] == d and b not in args and a in args, not {chi, alpha, beta} & set(args)
    snap = trailing or alone  # needs an instantaneous compliance
    kind = draw.choice((J, J, L, L, 1 if snap else 0, 1))
    ratio = mpmath.mpf(log(draw, *draw.choice(((-16, 0) if kind is L else (-30, 0), (-6, 0)))))
    if kind is L:
        return {beta: time, L: ratio}, {J: 1 - L, alpha: (1 - L) * beta}
    return {beta: time, J: ratio if kind is J else mpmath.mpf(kind) or ZERO}, {L: 1 - J, alpha: J * beta}


def _material(draw: Random, modes: int, moving: bool, dashpots: bool | None) -> dict[sp.Symbol, object]:
    """Interlaced times as sums of positive steps over many decades, near-equal ones among them; the rest follows exactly."""
    dashpot = draw.random() < 0.15 if dashpots is None else dashpots
    spread = draw.choice((1.0, 3.0, 6.0))
    speed = mpmath.mpf(
        draw.choice(
            (log(draw, -2, 2) if moving else ZERO, log(draw, -30, 22), log(draw, -8, 9), log(draw, -2, 2), log(draw, -2, 2))
        )
    )
    position, times = mpmath.mpf(0), []
    for number in range(2 * modes):
        step = log(draw, -spread, spread) * (draw.choice((1.0, 1.0, 1.0, 1e-9)) if number else not dashpot)
        position += mpmath.mpf(step) or ZERO
        times.append(position * speed)
    return exact_modes(times[0::2], times[1::2])


def domain(args: Sequence[sp.Symbol]) -> list[str]:
    """The keys of ``WORDS`` that say on which domain a function with these arguments is measured."""
    names = [source(symbol) for symbol in args]
    keys = ["phases"] if set(args) & set(PHASES) else []
    keys += ["m"] if m in args else ["alpha, beta"] if GROUPS & set(args) else []
    keys += ["states"] if set(args) & set(STATES) else []
    return keys + sorted(name for name in names if name in DOMAIN)
