"""An event-driven march of material points with ``scipy.integrate.solve_ivp``: a level at a given penetration, strip by
strip, period after period.

Continuous closure. Every strip starts deeply pressed and is marched until its means repeat: the unloading branch.
"""

import math

import numpy as np
from scipy.integrate import solve_ivp

#: no zone is missed with steps of a sixtieth of a period
_STEP = 0.1
_PERIODS = 200


class Strip:
    """One strip, dimensionless; ``state`` is the pressure in contact, the displacement elsewhere."""

    def __init__(self, alpha, beta, p_0, delta_0, D, rtol):
        self.alpha, self.beta, self.p_0, self.D, self.rtol = alpha, beta, p_0, D, rtol
        self.reach = delta_0 if p_0 > 0 else 0.0
        self.state, self.zone, self.phase = 10 * (1 + abs(D) + beta / alpha), "contact", -math.pi

    def u(self, s):
        return self.D - 1 + math.cos(s)

    def means(self):
        """Mean pressure and friction of the first period whose means are those of the one before; and whether there was one."""
        last = None
        for _ in range(_PERIODS):
            now, end = np.zeros(2), self.phase + 2 * math.pi
            while self.phase < end - 1e-12:
                now += self._zone(end)
            now /= 2 * math.pi
            if last is not None and np.all(np.abs(now - last) <= 2 * self.rtol * (np.abs(now) + 1e-3)):
                return now, True
            last = now
        return now, False

    def _zone(self, end):
        """March to the next event or to ``end``; the integrals of pressure and pressure times sin gained on the way."""
        a, b, load = self.alpha, self.beta, -self.p_0 if self.zone == "adhesion" else 0.0
        if self.zone == "contact":
            rate = lambda s, y: [(self.u(s) - b * math.sin(s) - y[0]) / a, y[0], y[0] * math.sin(s)]  # noqa: E731
            events = [(lambda s, y: y[0] + self.p_0, -1)]
        else:
            rate = lambda s, y: [(load - y[0]) / b, load, load * math.sin(s)]  # noqa: E731
            closes = self.reach if self.zone == "free" else 0.0
            events = [(lambda s, y: y[0] - self.u(s) - closes, -1)]
            if self.zone == "adhesion":
                events.append((lambda s, y: y[0] - self.u(s) - self.reach, 1))
        for event, direction in events:
            event.terminal, event.direction = True, direction
        found = solve_ivp(
            rate,
            (self.phase, end),
            [self.state, 0.0, 0.0],
            method="Radau" if self.zone == "contact" else "RK45",
            events=[event for event, _ in events],
            rtol=self.rtol,
            atol=1e-2 * self.rtol,
            max_step=_STEP,
        )
        self.state, self.phase = found.y[0, -1], found.t[-1]
        if found.status == 1:
            self._enter(0 if found.t_events[0].size else 1)
        return found.y[1:, -1]

    def _enter(self, event):
        u = self.u(self.phase)
        if self.zone == "contact":
            self.zone, self.state = ("adhesion" if self.p_0 > 0 else "free"), u
        elif self.zone == "adhesion":
            self.zone, self.state = ("contact", -self.p_0) if event == 0 else ("free", u + self.reach)
        else:
            self.zone, self.state = ("adhesion", u + self.reach) if self.p_0 > 0 else ("contact", 0.0)


def friction(material, adhesion, level, D, V, strips, rtol):
    """Friction stress (Pa) of a level at penetration ``D`` (m), over equal strips; with it the strips that did not settle."""
    k = level.k
    alpha, beta = k * V * material.T_sigma, k * V * material.T_eps
    total, unsettled = 0.0, 0
    for theta in np.pi * (np.arange(strips) + 0.5) / strips:
        A, depth = level.amplitude(theta), D - level.drop(theta)
        unit = material.K * A
        (_, tau), settled = Strip(alpha, beta, adhesion.p_0 / unit, adhesion.delta_0 / A, depth / A, rtol).means()
        total, unsettled = total - tau * unit * k * A, unsettled + (not settled)
    return total / strips, unsettled
