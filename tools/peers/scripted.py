"""The paper's method as a user would script it: scalar ``math``, one strip at a time with ``scipy.optimize.root``, the strip before as start."""

import math

import numpy as np
from scipy.optimize import root

TWO_PI = 2 * math.pi


class Script:
    """Solves strips of one level at one velocity, continuous closure, one after another; counts what does not converge."""

    def __init__(self, material, adhesion, level, V):
        self.K, self.k = material.K, level.k
        self.alpha, self.beta = level.k * V * material.T_sigma, level.k * V * material.T_eps
        self.p_0, self.delta_0, self.level = adhesion.p_0, adhesion.delta_0, level
        self.solved = self.failures = 0
        self.start = {}

    def strip(self, theta, D):
        """Mean pressure and friction (Pa), and the edges (phases) of the strip's contact or None; tries the regimes in the paper's order."""
        A, D_j = self.level.amplitude(theta), D - self.level.drop(theta)
        g = (self.alpha, self.beta, self.p_0 / (self.K * A), self.delta_0 / A, D_j / A)
        R = math.sqrt((1 + self.beta**2) / (1 + self.alpha**2))
        self.solved += 1
        if g[4] >= 1 + R - g[2]:
            return self._saturated(g, A)
        if g[4] + g[2] > 0:
            edges = self._solve("ac", g, saturated_adhesion, (-1.5, 1.5))
            if edges is not None and (self.p_0 == 0 or _stays_within(edges, g)):
                return self._means(edges, (edges[0], *edges, edges[1]), g, A, self.p_0 > 0)
        if self.p_0 == 0:
            return 0.0, 0.0, None
        edges = self._solve("acaf", g, discrete_adhesion, (-2.0, -1.5, 1.5, 2.0))
        if edges is not None:
            return self._means(edges[1:3], edges, g, A, False)
        return 0.0, 0.0, None

    def _solve(self, kind, g, equations, first):
        for start in (self.start.get(kind), first):
            if start is None:
                continue
            found = root(equations, start, g, method="hybr")
            e = found.x
            if found.success and all(e[i] <= e[i + 1] + 1e-12 for i in range(len(e) - 1)) and e[-1] - e[0] <= TWO_PI + 1e-12:
                self.start[kind] = e
                return e
        # without adhesion a strip above the undeformed surface has to touch it; with adhesion the next regime may still be right
        self.failures += kind == "acaf" or self.p_0 == 0
        return None

    def _saturated(self, g, A):
        alpha, beta, _, _, D = g
        loss = (beta - alpha) / (1 + alpha**2)
        unit = self.K * A
        return unit * (D - 1), 0.5 * loss * unit * self.k * A, (-math.pi, math.pi)

    def _means(self, contact, edges, g, A, clings):
        """Means by the trapezoid over the contact, in which the pressure is known; adhesion adds -p_0 over its zones."""
        b, a = contact
        s = np.linspace(b, a, 200)
        p = pressure(s, b, g)
        d, c = edges[0], edges[-1]
        p_mean, tau = np.trapezoid(p, s) / TWO_PI, np.trapezoid(p * np.sin(s), s) / TWO_PI
        if clings:  # all of the gap
            p_mean -= g[2] * (TWO_PI - (a - b)) / TWO_PI
            tau -= g[2] * (math.cos(a) - math.cos(b)) / TWO_PI
        else:
            p_mean -= g[2] * ((b - d) + (c - a)) / TWO_PI
            tau -= g[2] * ((math.cos(d) - math.cos(b)) + (math.cos(a) - math.cos(c))) / TWO_PI
        unit = self.K * A
        return unit * p_mean, -unit * tau * self.k * A, (b, a)


def _fields(g):
    alpha, beta, _, _, D = g
    storage, loss = (1 + alpha * beta) / (1 + alpha**2), (beta - alpha) / (1 + alpha**2)
    return (lambda s: D - 1 + math.cos(s)), (lambda s: D - 1 + storage * math.cos(s) - loss * math.sin(s))


def pressure(s, b, g):
    """Pressure in the contact that begins at phase b, in units of K A."""
    alpha, beta, p_0, _, D = g
    storage, loss = (1 + alpha * beta) / (1 + alpha**2), (beta - alpha) / (1 + alpha**2)
    field = lambda t: D - 1 + storage * np.cos(t) - loss * np.sin(t)  # noqa: E731
    return field(s) - (field(b) + p_0) * np.exp(-(s - b) / alpha)


def saturated_adhesion(edges, alpha, beta, p_0, delta_0, D):
    """Boundary equations of contact edges b, a with adhesion (or, without any, nothing) all over the gap."""
    b, a = edges
    u, field = _fields((alpha, beta, p_0, delta_0, D))
    if a - b > TWO_PI or a < b:
        return [10.0 + abs(a - b), 10.0 + abs(a - b)]
    exit_ = field(a) + p_0 - (field(b) + p_0) * math.exp(-(a - b) / alpha)
    return [exit_, -p_0 + (u(a) + p_0) * math.exp(-(b + TWO_PI - a) / beta) - u(b)]


def discrete_adhesion(edges, alpha, beta, p_0, delta_0, D):
    """Boundary equations of edges d, b, a, c."""
    d, b, a, c = edges
    if not (d <= b + 1 and b <= a + 1 and a <= c + 1 and c <= d + TWO_PI + 1):
        return [10.0 + abs(e) for e in edges]
    u, field = _fields((alpha, beta, p_0, delta_0, D))
    w = -p_0 + (u(d) + delta_0 + p_0) * math.exp(-(b - d) / beta)
    p = field(a) + p_0 - (field(b) + p_0) * math.exp(-(a - b) / alpha)
    v = -p_0 + (u(a) + p_0) * math.exp(-(c - a) / beta)
    free = (u(c) + delta_0) * math.exp(-(d + TWO_PI - c) / beta)
    return [w - u(b), p, v - u(c) - delta_0, free - u(d) - delta_0]


def _stays_within(edges, g):
    """Whether the gap behind a contact with saturated adhesion stays within the reach of adhesion."""
    alpha, beta, p_0, delta_0, D = g
    b, a = edges
    s = np.linspace(a, b + TWO_PI, 100)
    w = -p_0 + (D - 1 + math.cos(a) + p_0) * np.exp(-(s - a) / beta)
    return bool(np.all(w - (D - 1 + np.cos(s)) <= delta_0))


def friction(material, adhesion, levels, pressure_, V, strips=100, depths=100):
    """Friction stress of one or two levels at one velocity; with it the strips solved and the failures."""
    level = levels[0]
    theta = np.pi * (np.arange(strips) + 0.5) / strips
    first = Script(material, adhesion, level, V)
    D, p, tau = _table(first, theta, level, material, adhesion, pressure_, depths)
    counts = [first.solved, first.failures]
    below = np.flatnonzero(p[:-1] < pressure_)
    if not below.size:
        return 0.0, *counts
    i = below[-1]
    share = (pressure_ - p[i]) / (p[i + 1] - p[i])
    total = tau[i] + share * (tau[i + 1] - tau[i])
    if len(levels) > 1:
        depth = D[i] + share * (D[i + 1] - D[i])
        rows = []
        for t in theta:
            _, _, contact = first.strip(t, depth)
            if contact is not None:
                s, A = np.linspace(*contact, strips), level.amplitude(t)
                g = (first.alpha, first.beta, first.p_0 / (first.K * A), first.delta_0 / A, (depth - level.drop(t)) / A)
                start = contact[0] if contact[1] - contact[0] < TWO_PI - 1e-9 else -1e9
                rows.append((s, (pressure(s, start, g) if start > -1e8 else pressure(s, -700 * g[0] - 10, g)) * first.K * A))
        second = Script(material, adhesion, levels[1], V)
        p_max = max((float(q.max()) for _, q in rows), default=0.0)
        _, p, tau = _table(second, theta, levels[1], material, adhesion, p_max, depths)
        on_path = (p == np.minimum.accumulate(p[::-1])[::-1]) & (tau != 0)
        law = lambda q: np.interp(q, p[on_path], tau[on_path], left=0.0)  # noqa: E731
        total += sum(np.trapezoid(law(q), s) for s, q in rows) / TWO_PI / strips
        counts = [first.solved + second.solved, first.failures + second.failures]
    return total, *counts


def _table(script, theta, level, material, adhesion, p_max, depths):
    """Level means from a deep contact upwards, each strip started from its neighbour."""
    bottom = -2 * adhesion.p_0 / material.K - (adhesion.delta_0 if adhesion.p_0 > 0 else 0.0)
    D = np.linspace(bottom, p_max / material.K + 0.75 * level.h, depths)
    rows = []
    for depth in D[::-1]:
        rows.append(np.mean([script.strip(t, depth)[:2] for t in theta], axis=0))
    p, tau = np.array(rows[::-1]).T
    return D, p, tau
