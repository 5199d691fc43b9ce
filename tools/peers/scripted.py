"""The paper's method as a user would script it: scalar ``math``, one strip at a time with ``scipy.optimize.root``, the
strip before as start.

A root of the boundary equations is taken for a solution only if it keeps the inequalities: contact presses (no less
than ``-p_0``), gaps are open, adhesion stays within its reach. Without that look the strips of a level slide, each
started from the one before, onto a second root whose contact lies in the valley and pulls. Continuous closure,
unloading branch: the most engaged regimes are tried first.
"""

import math
from itertools import pairwise

import numpy as np
from scipy.optimize import root

TWO_PI = 2 * math.pi
#: starts to try after the strip before, by regime: edges in the order in which a material point meets them
STARTS = {
    "ac": ((-1.5, 1.5), (-0.3, 0.3), (0.5, 2.0), (-2.5, 2.5)),
    "acaf": ((-2.0, -1.5, 1.5, 2.0), (-0.5, -0.3, 0.3, 0.5), (0.0, 0.5, 2.0, 3.0), (-2.8, -2.5, 2.5, 2.8)),
    "af": ((-0.5, 0.5), (-0.1, 0.1), (0.5, 2.0), (-2.0, 2.0)),
}
#: zones from edge to edge
ZONES = {"ac": "ca", "acaf": "acaf", "af": "af"}
#: points of a zone at which the inequalities are looked at
LOOK = 40


class Script:
    """Solves strips of one level at one velocity, one after another; counts them, and those for which no solution was found."""

    def __init__(self, material, adhesion, level, V):
        self.K, self.k = material.K, level.k
        self.alpha, self.beta = level.k * V * material.T_sigma, level.k * V * material.T_eps
        self.R = math.sqrt((1 + self.beta**2) / (1 + self.alpha**2))
        self.p_0, self.delta_0, self.level = adhesion.p_0, adhesion.delta_0, level
        self.solved = self.failures = 0
        self.start = {}
        self.last = (0.0, 0.0, None, True)

    def groups(self, theta, D):
        """``(alpha, beta, p_0, delta_0, D)`` of a strip, dimensionless, and its unit of pressure."""
        A = self.level.amplitude(theta)
        return (self.alpha, self.beta, self.p_0 / (self.K * A), self.delta_0 / A, (D - self.level.drop(theta)) / A), self.K * A

    def strip(self, theta, D):
        """Mean pressure and friction (Pa), the edges (phases) of the strip's contact or None, and whether it is within reach."""
        g, unit = self.groups(theta, D)
        alpha, beta, p_0, delta_0, D = g
        steepness = self.k * unit / self.K
        self.solved += 1
        if D >= 1 + self.R - p_0:
            tau = 0.5 * (beta - alpha) / (1 + alpha**2)
            self.last = (unit * (D - 1), tau * unit * steepness, (-math.pi, math.pi), True)
            return self.last
        if p_0 == 0 and D <= 0:
            return 0.0, 0.0, None, False
        for kind in ("ac",) if p_0 == 0 else ("ac", "acaf", "a", "af"):
            if kind == "a":
                if 0 <= -p_0 - D <= delta_0 - 2:
                    return -unit * p_0, 0.0, None, True
                continue
            edges = self._solve(kind, g)
            if edges is not None:
                p_mean, tau = means(kind, edges, g)
                contact = {"ac": edges, "acaf": edges[1:3], "af": None}[kind]
                self.last = (unit * p_mean, unit * tau * steepness, contact, True)
                return self.last
        if D <= -delta_0:
            return 0.0, 0.0, None, False
        self.failures += 1  # it has to touch: a solution was missed; the best there is are the values of the strip before
        return self.last

    def _solve(self, kind, g):
        for start in (self.start.get(kind), *STARTS[kind]):
            if start is None:
                continue
            found = root(EQUATIONS[kind], start, g, method="hybr")
            edges = tuple(found.x.tolist())
            if found.success and admissible(kind, edges, g):
                self.start[kind] = edges
                return edges
        return None


def saturated_adhesion(edges, alpha, beta, p_0, delta_0, D):
    """Boundary equations of contact edges b, a with adhesion (or, without any, nothing) all over the gap."""
    b, a = edges
    if not b <= a <= b + TWO_PI:
        return [10.0 + abs(a - b)] * 2
    exit_ = _excess(a, b, alpha, beta, p_0, D)
    return [exit_, -p_0 + (_u(a, D) + p_0) * math.exp(-(b + TWO_PI - a) / beta) - _u(b, D)]


def discrete_adhesion(edges, alpha, beta, p_0, delta_0, D):
    """Boundary equations of edges d, b, a, c."""
    d, b, a, c = edges
    if not (d <= b + 1 and b <= a + 1 and a <= c + 1 and c <= d + TWO_PI + 1):
        return [10.0 + abs(e) for e in edges]
    w = -p_0 + (_u(d, D) + delta_0 + p_0) * math.exp(-(b - d) / beta)
    v = -p_0 + (_u(a, D) + p_0) * math.exp(-(c - a) / beta)
    free = (_u(c, D) + delta_0) * math.exp(-(d + TWO_PI - c) / beta)
    return [w - _u(b, D), _excess(a, b, alpha, beta, p_0, D), v - _u(c, D) - delta_0, free - _u(d, D) - delta_0]


def no_contact(edges, alpha, beta, p_0, delta_0, D):
    """Boundary equations of edges d, c of an adhesion zone without contact."""
    d, c = edges
    if not d <= c <= d + TWO_PI:
        return [10.0 + abs(c - d)] * 2
    w = -p_0 + (_u(d, D) + delta_0 + p_0) * math.exp(-(c - d) / beta)
    free = (_u(c, D) + delta_0) * math.exp(-(d + TWO_PI - c) / beta)
    return [w - _u(c, D) - delta_0, free - _u(d, D) - delta_0]


EQUATIONS = {"ac": saturated_adhesion, "acaf": discrete_adhesion, "af": no_contact}


def _u(s, D):
    return D - 1 + math.cos(s)


def _field(s, alpha, beta, D):
    return D - 1 + ((1 + alpha * beta) * math.cos(s) - (beta - alpha) * math.sin(s)) / (1 + alpha**2)


def _excess(a, b, alpha, beta, p_0, D):
    """Pressure over -p_0 at the end a of a contact that begins at b."""
    return _field(a, alpha, beta, D) + p_0 - (_field(b, alpha, beta, D) + p_0) * math.exp(-(a - b) / alpha)


def pressure(s, b, g):
    """Pressure at phases s (an array) in the contact that begins at phase b, in units of K A."""
    alpha, beta, p_0, _, D = g
    field = D - 1 + ((1 + alpha * beta) * np.cos(s) - (beta - alpha) * np.sin(s)) / (1 + alpha**2)
    return field - (_field(b, alpha, beta, D) + p_0) * np.exp(-(s - b) / alpha)


def admissible(kind, edges, g):
    """Whether a root keeps the inequalities of its regime."""
    _, beta, p_0, delta_0, D = g
    ends = (*edges, edges[0] + TWO_PI)
    near = 1e-9 * (1 + abs(D) + p_0)
    before = "f"
    for zone, (start, end) in zip(ZONES[kind], pairwise(ends), strict=True):
        if end < start:
            return False
        s = np.linspace(start, end, LOOK)
        if zone == "c":
            if np.any(pressure(s, start, g) < -p_0 - near):
                return False
        else:
            load = -p_0 if zone == "a" else 0.0
            w = load + (_u(start, D) + (0.0 if before == "c" else delta_0) - load) * np.exp(-(s - start) / beta)
            gap = w - (D - 1 + np.cos(s))
            if np.any(gap < -near if zone == "a" else gap < delta_0 - near):
                return False
            if zone == "a" and p_0 > 0 and np.any(gap > delta_0 + near):
                return False
        before = zone
    return True


def means(kind, edges, g):
    """Mean pressure and friction over a period, dimensionless: a trapezoid over the contact, closed form where adhesion pulls."""
    p_mean = tau = 0.0
    ends = (*edges, edges[0] + TWO_PI)
    for zone, (start, end) in zip(ZONES[kind], pairwise(ends), strict=True):
        if zone == "c":
            s = np.linspace(start, end, 200)
            p = pressure(s, start, g)
            p_mean, tau = p_mean + np.trapezoid(p, s), tau - np.trapezoid(p * np.sin(s), s)
        elif zone == "a":
            p_mean, tau = p_mean - g[2] * (end - start), tau + g[2] * (math.cos(start) - math.cos(end))
    return p_mean / TWO_PI, tau / TWO_PI


def friction(material, adhesion, levels, pressure_, V, strips=100, depths=100):
    """Friction stress of a surface at one velocity; with it the strips solved and the failures. Along x, too,
    ``strips`` points."""
    theta = np.pi * (np.arange(strips) + 0.5) / strips
    scripts = [Script(material, adhesion, level, V) for level in levels]
    depth, total = _at_pressure(scripts[0], theta, pressure_, depths)
    if depth is not None and len(levels) > 1:
        contacts = _contacts(scripts[0], theta, depth, strips)
        total += _carried(contacts, _law(scripts[1:], theta, _peak(contacts), depths), strips)
    return total, sum(s.solved for s in scripts), sum(s.failures for s in scripts)


def _depths(script, p_max, depths):
    """Penetrations from a load of ``p_max``, or saturation if that comes first, down to where nothing can cling."""
    lowest = -2 * script.p_0 / script.K - (script.delta_0 if script.p_0 > 0 else 0.0)
    h = script.level.h
    return np.linspace(min(p_max / script.K + 0.75 * h, 0.5 * h * (1 + script.R) - script.p_0 / script.K), lowest, depths)


def _level(script, theta, D):
    """Mean pressure and friction over the strips at ``theta``, ascending: all beyond the first that is out of reach lie
    further off."""
    rows = np.zeros((theta.size, 2))
    for row, t in zip(rows, theta, strict=True):
        p_mean, tau, _, reached = script.strip(t, D)
        if not reached:
            break
        row[:] = p_mean, tau
    return rows.mean(axis=0)


def _at_pressure(script, theta, p, depths):
    """Penetration and friction of a level at a pressure: downwards from a deep contact to the first depth that carries less."""
    h, K = script.level.h, script.K
    D = p / K + 0.75 * h
    if D >= 0.5 * h * (1 + script.R) - script.p_0 / K:
        return D, _level(script, theta, D)[1]
    above = None
    for depth in _depths(script, p, depths):
        here = _level(script, theta, depth)
        if here[0] <= p:
            if above is None:
                return depth, here[1]
            share = (p - here[0]) / (above[1][0] - here[0])
            return depth + share * (above[0] - depth), here[1] + share * (above[1][1] - here[1])
        above = depth, here
    return None, 0.0


def _contacts(script, theta, depth, points):
    """Phases and pressures (Pa) along the contact of every strip."""
    found = []
    for t in theta:
        _, _, contact, reached = script.strip(t, depth)
        if not reached:
            break
        if contact is not None:
            g, unit = script.groups(t, depth)
            s = np.linspace(*contact, points)
            # nothing of the entry is left in a contact that never ends
            entry = contact[0] - (800 * script.alpha if contact[1] - contact[0] > TWO_PI - 1e-9 else 0.0)
            found.append((s, pressure(s, entry, g) * unit))
    return found


def _peak(contacts):
    return max((float(p.max()) for _, p in contacts), default=0.0)


def _carried(contacts, law, strips):
    """Second term of Eq. 13: a trapezoid along every contact."""
    return sum(np.trapezoid(law(p), s) for s, p in contacts) / TWO_PI / strips


def _law(scripts, theta, p_max, depths):
    """Friction of a level and all below it over pressure, along the unloading path, by linear interpolation; nothing
    below pull-off."""
    script, D = scripts[0], _depths(scripts[0], p_max, depths)
    rows = np.array([_level(script, theta, depth) for depth in D])
    if len(scripts) > 1:
        contacts = [_contacts(script, theta, depth, theta.size) for depth in D]
        below = _law(scripts[1:], theta, max(map(_peak, contacts)), depths)
        rows[:, 1] += [_carried(each, below, theta.size) for each in contacts]
    p, tau = rows[::-1].T
    on_path = (p == np.minimum.accumulate(p[::-1])[::-1]) & (tau != 0)
    return lambda q: np.interp(q, p[on_path], tau[on_path], left=0.0) if on_path.any() else np.zeros_like(q)
