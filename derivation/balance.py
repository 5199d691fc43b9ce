"""The balance of a period, mean p = mean w, on a foundation that all but stands still: it says where orbits start."""

import sympy as sp

from .check import Derived, derived, zero
from .flows import Flows
from .sequences import PERIOD
from .symbols import J, L, a, c, delta_0, p_0, s

jump = sp.Symbol("jump", positive=True)
NAMES = {r"\Deltaw": jump}
"""In the displays."""


def standing_still(flows: Flows) -> Derived:
    r"""On a fast foundation z stands still. Then contact and adhesion last as long before the crest as after it, and w is u(a)
    while the gap adheres, more by its step in the free zone. Pi times the mean of w less that of p, and its derivative by a:

    .. math:: \pi (u(a) + \Delta w) + (p_0 - \Delta w) c - \frac{L}{J} (\sin a - a \cos a),\quad -\sin a \left(\pi + \frac{L}{J}
        a - \frac{p_0 - \Delta w}{\sin c}\right)
    """
    u = flows.strip.u
    held = u.subs(s, a)
    value = PERIOD / 2 * (held + jump) + (p_0 - jump) * c - (1 - J) / J * (sp.sin(a) - a * sp.cos(a))
    pressed = -p_0 + (u - held) / J
    summed_w = sp.integrate(u, (s, -a, a)) + held * 2 * (c - a) + (held + jump) * (PERIOD - 2 * c)
    summed_p = sp.integrate(sp.expand(pressed), (s, -a, a)) - p_0 * 2 * (c - a)
    release = sp.Function("c")(a)  # where the profile has sunk by delta_0
    moves = sp.diff(release, a)
    rate = sp.solve(sp.diff(held - u.subs(s, release) - delta_0, a), moves)[0]
    slope = sp.diff(value.subs(c, release), a).subs(moves, rate).subs(release, c)
    stated = -sp.sin(a) * (PERIOD / 2 + L / J * a - (p_0 - jump) / sp.sin(c))
    claims = [
        zero("in contact, from p = -p_0 at a, z stands still", (u - J * pressed) - (held + J * p_0)),
        zero("half of the sum of w less that of p", (summed_w - summed_p) / 2 - value),
        zero("its derivative by a, with the c that a leads to", slope - stated.subs(L, 1 - J)),
    ]
    return derived(standing_still, (value, stated), claims)
