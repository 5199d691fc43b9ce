"""Periodic orbits forced by a window, the time that a strip is free, and bounds of their gaps next to its ends (``windows``)."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from hystrip.generated.modes import across, over_period
from hystrip.generated.modes import solved as solved_modes

from ..groups import TWO_PI
from .march import CONTACT, FREE, march, one_zone
from .problem import ModeStrips, rates

#: cells in which a chord is bounded: more bound it closer, by as much work
_CELLS = np.linspace(0.0, 1.0, 7) ** 1.5
#: agreement of edges with those that a turn meets: orbits err by the square of that; and after how many turns forced ones are
#: given up: Newton's method takes three or four, thirteen where it narrows a contact by two fifths each
AGREE, SETTLING = 1e-7, 16


class Forced:
    """Periodic orbits of N strips forced by ``edges`` d, b, a, c (4, N), without contact b = a: free from c to d, in contact from
    b to a, and else in adhesion. ``states`` at a, c, d, b (n, N)."""

    def __init__(self, kernel, s: ModeStrips, edges: np.ndarray, states=None):
        self.kernel, self.s, self.edges = kernel, s, edges
        self.states = self._periodic() if states is None else states

    def _periodic(self):
        (d, b, a, c), kernel, s, m = self.edges, self.kernel, self.s, self.s.m
        lost, driven = kernel.contact_map(b, a, kernel.profile(b, s.D) / m.J_0, m)
        # a contact that is entered with any state: the pressure there follows from it, and counts as much as -J of z
        lost = lost + across(lost, m.J)[:, None] / m.J_0
        maps = ((lost, driven), kernel.relaxation_map(a, c, -s.p_0, m), kernel.relaxation_map(c, d + TWO_PI, 0.0, m),
                kernel.relaxation_map(d, b, -s.p_0, m))  # fmt: skip
        touching = solved_modes(*over_period(maps))
        states = [touching + driven - across(lost, touching)]
        for lost, driven in maps[1:-1]:
            states.append(states[-1] + driven - lost * states[-1])
        return np.stack((*states, touching))

    def take(self, index) -> Forced:
        return Forced(self.kernel, self.s.take(index), self.edges[:, index], self.states[..., index])

    @classmethod
    def settled(cls, kernel, s: ModeStrips, edges: np.ndarray, turns: int = SETTLING):
        """Orbits in the windows of ``edges`` with contacts they come to in so many ``turns``; which settled, if that is more
        than one, or have a state: none needs more to be a bound from below.

        The window that is returned ends with the contact that holds at its start, and where its gap closes."""
        found, left, good = cls(kernel, s, edges.copy()), np.arange(s.size), np.zeros(s.size, bool)
        for _ in range(turns):
            left = left[np.isfinite(found.states[..., left]).all(axis=(0, 1))]
            if not left.size:
                break
            here = found.take(left)
            after, followed = here.turned(edges[[0, 3]][:, left], turns > 1)
            change = after - here.edges
            # a strip that snaps into contact does so at its onset: orbits err by as much as these are apart, not by its square
            together = ~here.s.snaps | (np.abs(change[1] - change[0]) <= AGREE**2)
            good[left] = followed & together & (np.abs(change).max(axis=0) <= AGREE)
            left, after = left[~good[left]], after[:, ~good[left]]
            found.edges[:, left] = after
            found.states[..., left] = cls(kernel, s.take(left), after).states
        return found, good if turns > 1 else np.isfinite(found.states).all(axis=(0, 1))

    def turned(self, wide, exactly: bool):
        """Edges of a turn that starts from the orbit at the onset, in the window ``wide`` (d, c); and whether it was followed.

        ``exactly``: a contact that holds at c, or begins in the free zone, is one without adhesion there: its pressure is not
        below zero up to the onset."""
        (d, b, a, c), s, kernel = self.edges, self.s, self.kernel
        d_0, c_0 = wide if exactly else (d, c)
        z_d, none = self.states[2], np.zeros(s.size)
        turn = march(kernel, replace(s, bare=True), np.ones(s.size, bool), z_d, d, c_0 - d)
        touching = z_d.sum(axis=0) - kernel.profile(d, s.D) < s.step
        _, entry, end, _ = turn.edges
        b, a = np.where(touching, d, np.where(np.isnan(entry), c_0, entry)), np.where(np.isnan(end), c_0, end)
        b, a = (np.where(touching | (turn.contacts > 0), edge, d) for edge in (b, a))
        if not exactly:
            return np.stack((d, b, a, c)), ~turn.lost
        dry, z, start, limit = replace(s, p_0=none, delta_0=none, snaps=none > 1), z_d + turn.dz, c_0, d_0 + TWO_PI
        held = np.flatnonzero(z.sum(axis=0) < kernel.profile(c_0, s.D))
        if held.size:
            start, part, letter = start.copy(), dry.take(held), np.full(held.size, CONTACT)
            end, change, *_ = one_zone(kernel, part, letter, c_0[held], limit[held], z[:, held], None)
            start[held], z[:, held] = end, z[:, held] + change
            a[held] = end
        end = self.closing(start, limit, z)
        good = ~turn.lost & (self.pressed(start, end, limit, z) >= 0)
        closed, end = end < limit, end - TWO_PI
        b = np.where(closed | (b < end), end, b)
        return np.stack((end, b, np.where(closed & (a < end), c_0, np.maximum(a, b)), start)), good

    def pressed(self, start, end, limit, z):
        """Pressure at the ``limit`` in a contact without adhesion from ``end`` on, where a gap closed that was free from
        ``start`` with the states ``z``; zero where it did not. It rises and falls once: it was positive before."""
        kernel, s = self.kernel, self.s
        z = z + kernel.relaxation_increment(start, end, z, 0.0, s.m)
        overstress = kernel.overstress_after(end, limit, kernel.overstress(z, 0.0, s.m), s.m)
        return np.where(end < limit, kernel.contact_pressure(limit, overstress, s.D), 0.0)

    def at(self, phase: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """State at a ``phase``, and whether it is engaged there."""
        d, b, _, c = self.edges
        phase = c + np.mod(phase - c, TWO_PI)
        s, (_, free, adhering, touching) = self.s, self.states
        engaged, contact = phase > d + TWO_PI, phase > b + TWO_PI
        start = np.where(engaged, d + TWO_PI, c)
        z = np.where(engaged, adhering, free)
        z = z + self.kernel.relaxation_increment(start, phase, z, np.where(engaged, -s.p_0, 0.0), s.m)
        start, later = b + TWO_PI, np.maximum(b + TWO_PI, phase)
        crept = self.kernel.contact_increment(start, later, self.entry(), s.m)
        return np.where(contact, touching + crept, z), engaged

    def gaps(self):
        """y at release and onset."""
        (d, _, _, c), (_, z_c, z_d, _) = self.edges, self.states
        return z_c.sum(axis=0) - self.kernel.profile(c, self.s.D), z_d.sum(axis=0) - self.kernel.profile(d, self.s.D)

    def excess(self, phase):
        """Pressure above ``-p_0`` at a ``phase``, and its slope, in a contact that goes on from b."""
        s, kernel = self.s, self.kernel
        return kernel.excess_event(phase, *kernel.excess_entry(self.edges[1], self.entry(), s.p_0, s.D, s.m))

    def entry(self):
        """Overstress at the begin of contact, where the pressure follows from the state."""
        z, s, kernel = self.states[3], self.s, self.kernel
        return kernel.overstress(z, (kernel.profile(self.edges[1], s.D) - z.sum(axis=0)) / s.m.J_0, s.m)

    def adhering(self, to):
        """Least and greatest slope of chords of y from the release to phases up to ``to``, along the adhesion before it."""
        return chords(self.states[0] + self.s.m.J * self.s.p_0, rates(self.s.m.beta), self.edges[2], self.edges[3], to)

    def falling(self, to):
        """The same from the onset, along the free zone before it."""
        c, d = self.edges[3], self.edges[0]
        return chords(self.states[1], rates(self.s.m.beta), c, d + TWO_PI, to + TWO_PI)

    def closing(self, start, limit, z):
        """Where a gap, free on from ``start`` with the states ``z``, closes before the ``limit``, or that."""
        shut = replace(self.s, delta_0=np.zeros(self.s.size), snaps=np.zeros(self.s.size, bool))
        return one_zone(self.kernel, shut, np.full(start.shape, FREE), start, limit, z, None)[0]


def chords(amplitude, rate, start, at, to):
    """Least and greatest slope of chords of ``-cos x + sum_j amplitude_j exp(-(x - start) rate_j)`` from ``at`` up to ``to``.

    In a cell the slope is bounded term by term, at its ends the value is known."""
    x = at + _CELLS[:, None] * (to - at)
    faded = amplitude[:, None] * np.exp((start - x) * rate[:, None])
    change = (faded - faded[:, :1]).sum(axis=0) + np.cos(at) - np.cos(x)
    fall = faded * rate[:, None]
    low, high = sine_range(np.minimum(x[:-1], x[1:]), np.maximum(x[:-1], x[1:]))
    found = []
    for least, slopes in (
        (True, low - np.maximum(fall[:, 1:], fall[:, :-1]).sum(axis=0)),
        (False, high - np.minimum(fall[:, 1:], fall[:, :-1]).sum(axis=0)),
    ):
        pick, better = (np.min, np.fmax) if least else (np.max, np.fmin)
        with np.errstate(all="ignore"):  # no chord has a length where x does not move
            ends = (change[:-1] + slopes * np.diff(x, axis=0)) / (x[1:] - at)
            seen = change[1:] / (x[1:] - at)
        found.append(better(pick(slopes, axis=0), pick(np.concatenate((ends, seen)), axis=0)))
    return found


def sine_range(low, high):
    """Least and greatest value of ``sin s`` on [low, high], elementwise."""
    ends = np.sin(low), np.sin(high)
    holds = lambda phase: np.ceil((low - phase) / TWO_PI) * TWO_PI + phase <= high  # noqa: E731
    return np.where(holds(-0.5 * np.pi), -1.0, np.minimum(*ends)), np.where(holds(0.5 * np.pi), 1.0, np.maximum(*ends))
