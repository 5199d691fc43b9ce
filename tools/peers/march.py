"""An event-driven march of material points with ``scipy.integrate.solve_ivp``: one strip without adhesion, period after period until it repeats."""

import numpy as np
from scipy.integrate import solve_ivp


def strip(alpha, beta, D, rtol):
    """Mean pressure and friction of a strip, dimensionless, continuous closure, from a deeply pressed start."""
    state, contact, phase, last = D - 1.0, True, -np.pi, None
    for _ in range(200):
        end = phase + 2 * np.pi
        means = np.zeros(2)
        while phase < end - 1e-12:
            state, phase, contact, gained = _until_event(alpha, beta, D, state, contact, phase, end, rtol)
            means += gained
        means /= 2 * np.pi
        if last is not None and np.all(np.abs(means - last) <= 2 * rtol * (np.abs(means) + 1e-3)):
            return means
        last = means
    return means


def _until_event(alpha, beta, D, state, contact, phase, end, rtol):
    u, slope = (lambda s: D - 1 + np.cos(s)), (lambda s: -np.sin(s))
    if contact:
        rate = lambda s, y: [(u(s) + beta * slope(s) - y[0]) / alpha, y[0], y[0] * np.sin(s)]  # noqa: E731
        event = lambda s, y: y[0]  # noqa: E731
    else:
        rate = lambda s, y: [-y[0] / beta, 0.0, 0.0]  # noqa: E731
        event = lambda s, y: y[0] - u(s)  # noqa: E731
    event.terminal, event.direction = True, -1
    method = "Radau" if contact else "RK45"
    found = solve_ivp(rate, (phase, end), [state, 0.0, 0.0], method=method, events=event, rtol=rtol, atol=rtol * 1e-2, max_step=0.1)
    y, s = found.y[:, -1], found.t[-1]
    if found.status == 1:
        state = u(s) if contact else 0.0
        return state, s, not contact, y[1:]
    return y[0], s, contact, y[1:]


def friction(material, level, D, V, strips, rtol):
    """Friction stress of a level without adhesion at penetration ``D`` (m), over equal strips."""
    k = level.k
    alpha, beta = k * V * material.T_sigma, k * V * material.T_eps
    total = 0.0
    for theta in np.pi * (np.arange(strips) + 0.5) / strips:
        A, depth = level.amplitude(theta), D - level.drop(theta)
        if depth > 0:
            total -= strip(alpha, beta, depth / A, rtol)[1] * material.K * A * k * A
    return total / strips
