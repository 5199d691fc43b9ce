"""Second term of Eq. 13 for levels without adhesion: the law of the level below averaged over the contact pressures of all strips of a level."""

from __future__ import annotations

import numpy as np

from hystrip.solver import Foundation

from .law import BareLaws
from .means import Level, cells, gauss
from .orbit import Wave
from .pressure import ContactPressure

#: nodes over the strips and over each contact, tried in turn
RULES = ((8, 8), (12, 12), (18, 18), (27, 27), (40, 40), (60, 60))
_QUADRATURE, _FASTEST = 0.2, 0.1


class Carrier:
    """A level that carries the ``laws`` of the next one: its contact pressures."""

    def __init__(self, foundation: Foundation, level: Level, rate: np.ndarray, pressure: float, laws: BareLaws):
        self.foundation, self.level, self.rate, self.pressure, self.laws = foundation, level, rate, pressure, laws
        self.strips = 0

    def carried(self, group: np.ndarray, d: np.ndarray, goal: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """What columns at ``d = D/h`` carry (m, q), to ``goal`` (m, q), and the errors of the sums (m, q)."""
        out, errors = np.zeros((d.size, self.laws.full.shape[1])), np.zeros((d.size, self.laws.full.shape[1]))
        left, before, last = np.flatnonzero(d > 0), None, None
        for rule in RULES:
            new = self._sums(group[left], d[left], *rule)
            if before is not None:
                change = np.abs(new - before)
                pace = 1.0 if last is None else np.clip(np.divide(change, last, out=np.ones_like(change), where=last > 0), _FASTEST, 1.0)
                miss = change * pace
                done = (miss <= _QUADRATURE * goal[left]).all(axis=1) | (rule == RULES[-1])
                out[left[done]], errors[left[done]] = new[done], miss[done]
                left, new, last = left[~done], new[~done], change[~done]
                if not left.size:
                    break
            before = new
        return out, errors

    def _sums(self, group, d, strips: int, nodes: int):
        f = self.level.family
        out = np.zeros((d.size, self.laws.full.shape[1]))
        some = np.flatnonzero(d < 0.5 * f.s_sat[group])
        if some.size:
            out[some] = self._partial(group[some], d[some], strips, nodes)
        some = np.flatnonzero(d > 1)
        if some.size:
            out[some] += self._complete(group[some], d[some], strips, nodes)
        return out

    def _partial(self, group, d, strips, nodes):
        """Strips in partial contact."""
        f = self.level.family
        at = cells(d, f.s_sat[group], strips)
        width = 2 * np.pi * np.clip(f.values(group, at.s)[:, :, 2], 1e-9, 1 - 1e-9).ravel()
        wave = Wave(self.foundation, np.repeat(self.rate[group], strips))
        orbits = wave.orbits(width)
        self.strips += width.size
        t, w = gauss(nodes)
        share = np.broadcast_to(t * t * (3 - 2 * t), (width.size, nodes))
        p = ContactPressure(wave, orbits).at(share) * (0.5 * self.pressure * at.u.ravel())[:, None]
        weight = (at.weight.ravel() * width / (2 * np.pi))[:, None] * (w * 6 * t * (1 - t))
        return self.laws.averages(group, p.reshape(d.size, -1), weight.reshape(d.size, -1))

    def _complete(self, group, d, strips, nodes):
        """Strips in complete contact: one harmonic of the phase about the mean."""
        f = self.level.family
        start = _starts(d, f.s_sat[group])
        first = 2 * np.arccos(np.sqrt(start))
        y, v = gauss(strips)
        # the strip that just becomes so is at the start of the interval, others are smooth
        theta = first[:, None] + (np.pi - first)[:, None] * y * y
        u = np.cos(0.5 * theta) ** 2
        t, w = gauss(nodes)
        half = np.cos(np.pi * (1 - (1 - t) ** 2))
        p = (d - 1)[:, None, None] + 0.5 * u[:, :, None] * (1 + (f.s_sat[group] - 1)[:, None, None] * half)
        weight = ((np.pi - first) / np.pi)[:, None, None] * (v * 2 * y)[None, :, None] * (w * 2 * (1 - t))
        return self.laws.averages(group, self.pressure * np.maximum(p, 0.0).reshape(d.size, -1), weight.reshape(d.size, -1))


def _starts(d, s_sat):
    return np.minimum(np.divide(2 * (d - 1), s_sat - 2, out=np.ones_like(d), where=s_sat > 2), 1.0)
