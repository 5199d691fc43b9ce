"""The paper's method with this library's kernels, in batches: equal strips, tables over penetration, a trapezoid along x."""

import numpy as np

import hystrip

#: penetrations among which that of the nominal pressure is looked for: few would step over a narrow minimum of p_mean;
#: then closer and closer
_ROUNDS = (100, 30, 30)


def friction(material, adhesion, levels, pressure, V, strips, depths=None):
    """Friction stress at a nominal pressure (Pa) and velocity (m/s), by ``strips`` equal strips and as many points along x.

    The laws of the lower levels are interpolated linearly over ``depths`` penetrations: as many as strips, but for 30
    to 300, if not given.
    """
    surface = _Surface(material, adhesion, tuple(levels), V, strips, depths or int(np.clip(strips, 30, 300)))
    return surface.friction(pressure)


class _Surface:
    def __init__(self, material, adhesion, levels, V, strips, depths):
        self.material, self.adhesion, self.levels, self.V = material, adhesion, levels, V
        self.strips, self.depths = strips, depths
        self.theta = np.pi * (np.arange(strips) + 0.5) / strips

    def friction(self, pressure):
        low, high = self._range(0, pressure)
        for depths in _ROUNDS:
            D, p, tau = self._table(0, np.linspace(low, high, depths))
            below = np.flatnonzero(p[:-1] < pressure)
            if not below.size:
                return 0.0
            i = below[-1]  # unloading: the largest penetration that carries the pressure
            low, high = D[i], D[i + 1]
            if not p[i + 1] > pressure:
                break
        share = min((pressure - p[i]) / (p[i + 1] - p[i]), 1.0)
        own = tau[i] + share * (tau[i + 1] - tau[i])
        if len(self.levels) == 1:
            return own
        x, local = self._contacts(0, low + share * (high - low))
        return own + self._carried(0, x, local, self._law(1, local.max(initial=0.0)))

    def _range(self, i, p_max):
        """Penetrations between which a level lets go and carries ``p_max``, or is saturated."""
        a, K, level = self.adhesion, self.material.K, self.levels[i]
        w = level.k * self.V
        R = np.hypot(1, w * self.material.T_eps) / np.hypot(1, w * self.material.T_sigma)
        lowest = -2 * a.p_0 / K - (a.delta_0 if a.p_0 > 0 else 0.0)
        carries, full = p_max / K + 0.75 * level.h, 0.5 * level.h * (1 + R) - a.p_0 / K
        return lowest, carries if i == 0 else min(carries, full)

    def _table(self, i, D):
        v = hystrip.solve_level(self.material, self.adhesion, self.levels[i], V=self.V, D=D, strips=self.strips)
        return D, v.p_mean, v.tau_mean

    def _contacts(self, i, D):
        """Points (points, strips in contact) along the contacts at penetration ``D``, m, and the pressures there, Pa."""
        level = self.levels[i]
        A, depth = level.amplitude(self.theta), D - level.drop(self.theta)
        s = hystrip.solve_strip(self.material, self.adhesion, l=level.l, A=A, D=depth, V=self.V)
        touching, full = s.contact_fraction > 0, s.contact_fraction == 1
        left, right = np.where(full, -level.l / 2, -s.a)[touching], np.where(full, level.l / 2, s.b)[touching]
        x = np.zeros((self.strips, self.strips))
        x[:, touching] = left + (right - left) * np.linspace(1e-9, 1 - 1e-9, self.strips)[:, None]
        return x[:, touching], s.pressure(x)[:, touching]

    def _carried(self, i, x, local, law):
        """Second term of Eq. 13: a trapezoid along every contact."""
        return np.trapezoid(law(local), x, axis=0).sum() / self.levels[i].l / self.strips

    def _law(self, i, p_max):
        """Friction of level ``i`` and all below over pressure along the unloading path, by linear interpolation."""
        D, p, tau = self._table(i, np.linspace(*self._range(i, p_max), self.depths))
        if i + 1 < len(self.levels):
            contacts = [self._contacts(i, depth) for depth in D]
            below = self._law(i + 1, max(local.max(initial=0.0) for _, local in contacts))
            tau = tau + [self._carried(i, x, local, below) for x, local in contacts]
        on_path = (p == np.minimum.accumulate(p[::-1])[::-1]) & (tau != 0)
        p, tau = p[on_path], tau[on_path]
        return lambda at: np.interp(at, p, tau, left=0.0) if p.size else np.zeros_like(at)
