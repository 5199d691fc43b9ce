"""Plain marching in double precision, for checking the oracle on easy scenes: sample each zone's exact flow on a fine
grid, stop at the first sign change of an exit event, and go on until two periods agree.

It knows nothing of arcs, return maps or order; it is slow and takes excursions shorter than its grid for none.
"""

import numpy as np

GRID = np.linspace(0, 2 * np.pi, 4001)[1:]


class Naive:
    def __init__(self, alpha, beta, P0, Delta, delta, closure):
        self.alpha, self.beta, self.P0, self.delta = alpha, beta, P0, delta
        self.Delta = Delta if P0 > 0 else 0.0
        self.step = alpha / beta * P0 if closure == "constitutive" else 0.0

    def profile(self, s):
        return self.delta - 1 + np.cos(s)

    def saturated(self, s):
        factor = (1 + 1j * self.beta) / (1 + 1j * self.alpha)
        return self.delta - 1 + np.real(factor * np.exp(1j * s))

    def field(self, zone, start, value, s):
        """Pressure in contact, else displacement, at s, from its value at the start of the zone."""
        if zone == "c":
            kept = np.exp(-(s - start) / self.alpha) if self.alpha else np.zeros_like(s)
            return self.saturated(s) + (value - self.saturated(start)) * kept
        rest = -self.P0 if zone == "a" else 0.0
        return rest + (value - rest) * np.exp(-(s - start) / self.beta)

    def events(self, zone, start, value):
        """(event function, direction, zone to enter) for each way out of a zone."""

        def field(s):
            return self.field(zone, start, value, s)

        def gap(s):
            return field(s) - self.profile(s)

        if zone == "c":
            return [(lambda s: field(s) + self.P0, -1, "a" if self.P0 else "f")]
        if zone == "f":
            return [(lambda s: gap(s) - self.Delta, -1, "a" if self.P0 else "c")]
        return [(gap, -1, "c"), (lambda s: gap(s) - self.Delta, 1, "f")]

    def next_zone(self, zone, start, value):
        """(phase, zone, value) at the next transition, or None within one period."""
        found = None
        for event, direction, following in self.events(zone, start, value):
            samples = direction * event(start + GRID)
            index = np.flatnonzero((samples[1:] > 0) & (samples[:-1] <= 0))
            if samples[0] > 0:  # crossed within the first step
                index = np.array([-1])
            if index.size:
                low = start + (GRID[index[0]] if index[0] >= 0 else 0.0)
                high = start + GRID[index[0] + 1]
                for _ in range(60):
                    middle = (low + high) / 2
                    low, high = (low, middle) if direction * event(middle) > 0 else (middle, high)
                if found is None or high < found[0]:
                    found = high, following
        if found is None:
            return None
        s, following = found
        return s, *self.entered(zone, following, s, self.field(zone, start, value, s))

    def entered(self, zone, following, s, value):
        """Zone and value after a transition; the closure decides on w where p steps."""
        if zone == "c":
            return following, self.profile(s)
        if following == "c":
            return following, -self.P0 if zone == "a" else 0.0
        if zone == "f" and self.step >= self.Delta:
            return "c", -self.Delta * self.P0 / self.step
        return following, value + (self.step if following == "f" else -self.step)

    def orbit(self, branch, periods=20000):
        """Zones (letter, start, end, value) of the last period, and the largest change of phase over it."""
        zone, s, value = ("c", 0.0, 1e9) if branch == "unloading" else ("f", 0.0, 1e9)
        history, previous = [], None
        while s < 2 * np.pi * periods:
            following = self.next_zone(zone, s, value)
            if following is None:
                rate = self.alpha if zone == "c" else self.beta
                length = 2 * np.pi * (1 + np.ceil(6 * rate))
                settled = history == []
                value = self.field(zone, s, value, np.float64(s + length))
                s += length
                if settled and previous is not None and abs(value - previous) < 1e-13 * (1 + abs(value)):
                    return [(zone, s, s + 2 * np.pi, value)]
                history, previous = [], value
                continue
            history.append((zone, s, following[0], value))
            s, zone, value = following
            previous = None
            size = next(
                (
                    n
                    for n in range(1, 5)
                    if len(history) > 2 * n
                    and history[-1][0] == history[-1 - n][0]
                    and abs(history[-1][2] - history[-1 - n][2] - 2 * np.pi) < 1e-12 * s + 1e-13
                ),
                None,
            )
            if size:
                return history[-size:]
            history = history[-12:]
        return None
