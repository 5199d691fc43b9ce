"""The paper's method with this library's kernels, in batches: equal strips, a table over penetration, a trapezoid along x."""

import numpy as np

import hystrip


def friction(material, adhesion, levels, pressure, velocity, strips, depths=None):
    """Friction stress of one or two levels at a nominal pressure (Pa) for every velocity (m/s), by ``strips`` equal strips.

    The tables have ``depths`` penetrations, as many as strips but for 30 to 100 if not given.
    """
    depths = depths or int(np.clip(strips, 30, 100))
    return np.array([_at(material, adhesion, levels, pressure, float(V), strips, depths) for V in np.atleast_1d(velocity)])


def _at(material, adhesion, levels, pressure, V, strips, depths):
    level, K = levels[0], material.K
    D, p, tau = table(material, adhesion, level, V, pressure, strips, depths)
    below = np.flatnonzero(p[:-1] < pressure)
    if not below.size:
        return 0.0
    i = below[-1]  # unloading: the largest penetration that carries the pressure
    share = (pressure - p[i]) / (p[i + 1] - p[i])
    own = tau[i] + share * (tau[i + 1] - tau[i])
    if len(levels) == 1:
        return own
    depth = D[i] + share * (D[i + 1] - D[i])
    theta = np.pi * (np.arange(strips) + 0.5) / strips
    s = hystrip.solve_strip(material, adhesion, l=level.l, A=level.amplitude(theta), D=depth - level.drop(theta), V=V)
    touching = s.contact_fraction > 0
    full = s.contact_fraction == 1
    left, right = np.where(full, -level.l / 2, -s.a)[touching], np.where(full, level.l / 2, s.b)[touching]
    x = left + (right - left) * np.linspace(1e-9, 1 - 1e-9, strips)[:, None]
    all_x = np.zeros((strips, strips))
    all_x[:, touching] = x
    local = s.pressure(all_x)[:, touching]
    law = friction_law(material, adhesion, levels[1], V, float(local.max(initial=0.0)), strips, depths)
    carried = np.trapezoid(law(local), x, axis=0) / level.l
    return own + carried.sum() / strips


def table(material, adhesion, level, V, p_max, strips, depths):
    """Penetrations, ascending, with mean pressure and friction of the unloading orbits, up to where the level carries ``p_max``."""
    a, K = adhesion, material.K
    bottom = -2 * a.p_0 / K - (a.delta_0 if a.p_0 > 0 else 0.0)
    D = np.linspace(bottom, p_max / K + 0.75 * level.h, depths)
    v = hystrip.solve_level(material, adhesion, level, V=V, D=D, strips=strips)
    return D, v.p_mean, v.tau_mean


def friction_law(material, adhesion, level, V, p_max, strips, depths):
    """Friction over pressure along the unloading path, by linear interpolation."""
    _, p, tau = table(material, adhesion, level, V, p_max, strips, depths)
    least = np.minimum.accumulate(p[::-1])[::-1]
    on_path = (p == least) & (tau != 0)
    p, tau = p[on_path], tau[on_path]
    return lambda at: np.interp(at, p, tau, left=0.0) if p.size else np.zeros_like(at)
