r"""Orbits forced by their window, the time from release to onset, and chains of them that rise to the first orbit.

Let a strip be free from c to d whatever its gap, and engaged otherwise. Its state then obeys one contracting law (``order``, 2):
there is one periodic orbit F for each window, and it rises with the window, as w is nowhere less where the strip is free, its gap
not negative. With a contact imposed from b to a, whatever these are, w is nowhere more than with the unilateral one, and all is
one linear system: a lower bound of F, off by the square of what b and a are off, and periodic in all relaxation times.

*Link.* If along F(c, d) the gap has come to delta_0 at an earlier c' already and stays beyond up to c, and, free on, has not
fallen to delta_0 before a later d', then so it is along F of every window between, which is greater.

*Chain.* Let all orbits be free in the first window of a chain of links, and above F there. Then they are free in the last one,
and above F there: while the windows grow F cannot come to touch an orbit, as that is released before F is, and engaged after.
"""

import numpy as np

from hystrip.generated.modes import over_period, solved

from .event_bounds import sine_range
from .march import TWO_PI
from .problem import ModeStrips, rates
from .propagation import kick

#: links of a chain, and the share of the way that each is trusted to reach
_LINKS, _SHARE = 48, 0.65


class Forced:
    """Orbits of N strips forced by ``edges`` d, b, a, c (4, N), without contact b = a = d: ``states`` at a, c, d, b (n, N)."""

    def __init__(self, kernel, s: ModeStrips, edges: np.ndarray):
        self.kernel, self.s, self.edges = kernel, s, edges
        (d, b, a, c), m, none = edges, s.m, np.zeros((s.modes, 1))
        lost, driven = kernel.contact_map(b, a, kernel.profile(b, s.D) / m.J_0, m)
        # a contact that is entered with any state: the pressure there follows from it
        creep = [kernel.contact_increment(b, a, kernel.overstress(none, p, m), m) for p in (1.0, 0.0)]
        contact = lost + (creep[0] - creep[1])[:, None] / m.J_0, driven
        self.maps = (kernel.relaxation_map(a, c, -s.p_0, m), kernel.relaxation_map(c, d + TWO_PI, 0.0, m),
                     kernel.relaxation_map(d, b, -s.p_0, m), contact)  # fmt: skip
        self.forgets, drive = over_period(self.maps)
        self.states = [solved(self.forgets, drive)]
        for lost, driven in self.maps[:-1]:
            self.states.append(self.states[-1] + driven - lost * self.states[-1])

    def at(self, phase: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """State at a ``phase`` in the period from c on, and whether it is engaged there."""
        d, b, _, c = self.edges
        s, (_, free, adhering, touching) = self.s, self.states
        engaged, contact = phase > d + TWO_PI, phase > b + TWO_PI
        start = np.where(engaged, d + TWO_PI, c)
        z = np.where(engaged, adhering, free)
        z = z + self.kernel.relaxation_increment(start, phase, z, np.where(engaged, -s.p_0, 0.0), s.m)
        start, later = b + TWO_PI, np.maximum(b + TWO_PI, phase)
        pressure = (self.kernel.profile(start, s.D) - touching.sum(axis=0)) / s.m.J_0
        overstress = self.kernel.overstress(touching, pressure, s.m)
        return np.where(contact, touching + self.kernel.contact_increment(start, later, overstress, s.m), z), engaged

    def slopes(self) -> np.ndarray:
        """Rates (2, N) at which the gap falls to the onset and grows to the release."""
        s, (d, _, _, c), (_, z_c, z_d, _) = self.s, self.edges, self.states
        rate = rates(s.m.beta)
        slope = lambda phase, z, p: np.sin(phase) - ((z - s.m.J * p) * rate).sum(axis=0)  # noqa: E731
        return np.stack((-slope(d, z_d, 0.0), slope(c, z_c, -s.p_0)))

    def responses(self) -> np.ndarray:
        """How much the gap grows at onset and release per growth of the window at its end and at its start, (2, 2, N): each
        growth adds a step of w at its edge."""
        s, (adhesion, free, closing, contact) = self.s, self.maps
        later, earlier = kick(s) * s.jump_on, kick(s) * s.step
        after = np.stack((later, earlier - free[0] * earlier), axis=1)
        after -= closing[0][:, None] * after
        after -= np.einsum("ij...,jk...->ik...", contact[0], after)
        at_a = solved(self.forgets, after)
        at_c = at_a - adhesion[0][:, None] * at_a
        at_d = at_c.copy()
        at_d[:, 1] += earlier
        at_d -= free[0][:, None] * at_d
        return np.stack((at_d.sum(axis=0), at_c.sum(axis=0)))

    def beyond(self) -> np.ndarray:
        """Gaps at onset and release, (2, N), less delta_0."""
        s, (d, _, _, c), (_, z_c, z_d, _) = self.s, self.edges, self.states
        gap = lambda phase, z, p: self.kernel.displacement(z, p, s.m) - self.kernel.profile(phase, s.D)  # noqa: E731
        return np.stack((gap(d, z_d, 0.0), gap(c, z_c, -s.p_0))) - s.delta_0

    def links(self, d_1: np.ndarray, c_1: np.ndarray) -> np.ndarray:
        """Where a link leads to the windows from ``c_1`` to ``d_1``."""
        s, (d, _, a, c), (z_a, z_c, *_) = self.s, self.edges, self.states
        rate = rates(s.m.beta)

        def slopes(amplitude, start, low, high):
            """Least and greatest slope of the gap from ``low`` to ``high``."""
            early, late = np.exp((start - low) * rate), np.exp((start - high) * rate)
            most = np.where(amplitude > 0, early, late)
            least = np.where(amplitude > 0, late, early)
            sine = sine_range(low, high)
            return sine[0] - (amplitude * most).sum(axis=0), sine[1] - (amplitude * least).sum(axis=0)

        least, _ = slopes((z_a + s.m.J * s.p_0) * rate, a, c_1, c)
        gap = self.kernel.gap_after(a, c_1, z_a, -s.p_0, s.D, s.m)
        released = (gap > s.delta_0) & (gap + least * (c - c_1) > s.delta_0) & (a <= c_1)
        _, most = slopes(z_c * rate, c, d + TWO_PI, d_1 + TWO_PI)
        gap = self.kernel.gap_after(c, d_1 + TWO_PI, z_c, 0.0, s.D, s.m)
        return released & (gap > s.delta_0) & (gap - most * (d_1 - d) > s.delta_0) & (d_1 < c_1)


def rise(kernel, s: ModeStrips, edges: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """States (n, N) at the start of the forced orbits at the ends of chains from those of ``edges`` (4, N), and whether engaged.

    Windows grow along Newton's step for an orbit's, or away from it where orbits have vanished; along it the gaps at
    their ends are as good as linear, and a link reaches a share of what they are beyond delta_0."""
    with np.errstate(all="ignore"):
        first = Forced(kernel, s, edges)
        beyond, slopes, falls = first.beyond(), first.slopes(), -first.responses()
        falls[[0, 1], [0, 1]] += slopes
        (p, q), (r, t) = falls
        newton = np.stack((t * beyond[0] - q * beyond[1], p * beyond[1] - r * beyond[0])) / (p * t - q * r)
        way = np.where((newton > 0).all(axis=0), newton, np.where((newton < 0).all(axis=0), -newton, beyond / slopes))
        falling = (falls * way).sum(axis=1)
        gone = [np.zeros(s.size)]
        for _ in range(_LINKS):
            reach = ((beyond - falling * gone[-1]) / (slopes * way)).min(axis=0)
            gone.append(gone[-1] + _SHARE * np.maximum(reach, 0.0))
        # all states of the chain at once: strips after strips
        gone, many = np.array(gone), np.tile(np.arange(s.size), len(gone))
        growth = (gone[:, None] * way).swapaxes(0, 1).reshape(2, -1)
        d, b, a, c = edges[:, many]
        d_1, c_1 = d + growth[0], c - growth[1]
        b_1 = np.minimum(d_1 + b - d, c_1)
        a_1 = np.where(b == a, b_1, np.clip(a, b_1, c_1))
        chain = Forced(kernel, s.take(many), np.stack((d_1, b_1, a_1, c_1)))
        clear = chain.links(np.roll(d_1, -s.size), np.roll(c_1, -s.size)).reshape(len(gone), s.size)[:-1]
        last = np.cumprod(clear, axis=0).sum(axis=0) * s.size + np.arange(s.size)
        z, engaged = chain.at(s.start[many])
    return z[:, last], engaged[last]
