"""Second term of Eq. 13: what the levels below contribute in the contact of a strip, ``(1/l) int law[p(x)] dx``.

In contact ``p - p* + alpha p' = H - p*``: like every event function, p passes a given pressure upward at most once and downward
at most once, each in an arc known in closed form. So the contact is cut at the breaks of the law (pull-off, jumps, saturation)
and each part integrated by itself, on as many nodes as it needs.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ..numerics.quadrature import interior_nodes, interleaved, mapped_weights, sum_errors
from ..orbit.contact import Contact
from .parts import Parts, around, between
from .strips import SolvedStrips
from .table import LawTable

TWO_PI = 2 * np.pi
_HALVINGS = 12
#: a part's share of the error that an average of strips is allowed, and parts integrated at a time
_SHARE, _CHUNK = 0.1, 2048
#: how much more than told by their coefficients integrands are feared to miss that are steeper than those it is told of
_SAFE = 2.0
#: what is left in a mean over contacts of the greatest error of a law: along its pieces errors change sign
_CANCELLED = 0.3
#: share of a pressure by which two that are next to one another are told apart
_TRIFLE = 1e-9
#: how many nodes a part gets at first and at last
_FIRST, _LAST = 16, 128


@dataclass(frozen=True)
class LowerLevelLaws:
    """Contributions of the next level down. ``table`` holds its law for each group; the last column is an error estimate of
    friction.

    ``scales`` (q,): natural scales of the contributions. ``rtol``: accuracy of the averages that they go into;
    ``friction`` (groups,): see ``LevelBatch``.
    """

    table: LawTable
    rtol: float
    scales: np.ndarray
    friction: np.ndarray

    def breaks(self, group: np.ndarray) -> np.ndarray:
        """Pressures (m, k), Pa, ascending, at which the laws of each ``group`` are not smooth; inf where there are fewer."""
        return self.table.breaks[group]

    def crossed(self, strips: SolvedStrips, group: np.ndarray) -> np.ndarray:
        """Codes (m,) of the law breaks that each strip's pressure passes: how many breaks its greatest exceeds, and how many it
        exceeds all along (or at entry)."""
        crossed = np.zeros(group.size, int)
        index, contact = strips.touching
        if index.size:
            breaks = self.table.breaks[group[index]]
            top, least = (np.count_nonzero(breaks < p[:, None], axis=1) for p in _extremes(contact))
            crossed[index] = 1 + top + (breaks.shape[1] + 1) * least
        return crossed

    def heights(self, strips: SolvedStrips, group: np.ndarray) -> np.ndarray:
        """Greatest, then least pressure of each strip over the law's breaks, (m, k), Pa; NaN without contact."""
        out = np.full((group.size, 2 * self.table.breaks.shape[1]), np.nan)
        index, contact = strips.touching
        if index.size:
            breaks = self.table.breaks[group[index]]
            out[index] = np.concatenate([p[:, None] - breaks for p in _extremes(contact)], axis=1)
        return out

    def over_contact(self, strips: SolvedStrips, group: np.ndarray) -> np.ndarray:
        """Contributions averaged over the period, (m, q): the law's quantities from friction on, then their error."""
        carried = np.zeros((group.size, self.scales.size))
        index, contact = strips.touching
        if index.size:
            carried[index] = self._contributions(contact, group[index]) / TWO_PI
        return carried

    def _contributions(self, contact: Contact, group) -> np.ndarray:
        table = self.table
        total = np.zeros((group.size, self.scales.size))
        breaks = table.breaks[group]
        reached = np.count_nonzero(breaks < contact.p_peak[:, None], axis=1)
        deepest = reached.max(initial=0)
        # phases between which the pressure exceeds each break, nested
        passes = [contact.passes(breaks[:, j], reached > j) for j in range(deepest)]
        parts: list[Parts] = []
        for j, (up, down) in enumerate(passes):
            saturated = (reached > j) & (breaks[:, j] >= table.p_sat[group])
            total[saturated, :-1] += (down - up)[saturated, None] * table.saturated[group[saturated], 1:]
            rest = (reached > j) & ~saturated
            if not rest.any():
                continue
            inner = rest & (reached > j + 1)
            if inner.any():
                parts += between(contact, j, inner, up, down, *passes[j + 1])
            # saturation is a break: there is one after this
            parts += around(contact, j, rest & ~inner, up, down, contact.p_peak - breaks[:, j], breaks[:, j + 1] - contact.p_peak)
            # where the break lies is known as well as the law's pressures: that much of the jump may fall on the wrong side
            crossing = rest & (breaks[:, j] > contact.p_least)
            total[crossing, -1] += self._misplaced(contact, group, j, np.flatnonzero(crossing), up, down)
        if parts:
            self._integrate(contact, group, Parts.joined(parts).sharing(), total)
        # what is not known of a law beyond the pressure that it was built for is about as much as it ever carries
        beyond = contact.p_peak > table.top[group]
        if beyond.any():
            up, down = contact.passes(table.top[group], beyond)
            total[beyond, -1] += ((down - up) * table.most[group])[beyond]
        return total

    def _misplaced(self, contact: Contact, group, j, rows, up, down):
        table, g = self.table, group[rows]
        shift = table.break_error[g, j] / contact.unit[rows]
        reach = np.zeros(rows.size)
        for phase in (up[rows], down[rows]):
            slope = np.abs(contact.slope(rows, phase))
            reach += np.minimum(np.divide(shift, slope, out=np.full(rows.size, np.inf), where=slope > 0), np.sqrt(shift))
        return table.jumps[g, j] * np.minimum(reach, down[rows] - up[rows])

    def _integrate(self, contact: Contact, group, parts: Parts, total):
        """Add the integrals of the law over ``parts`` of the contacts, smooth inside, with their errors; what does not converge
        by halves."""
        for k in range(_HALVINGS + 1):
            if not parts.size:
                return
            left = [self._attempt(contact, group, some, total, k == _HALVINGS) for some in parts.chunks(_CHUNK)]
            parts = Parts.joined(left).halves()

    def _attempt(self, contact: Contact, group, parts: Parts, total, last: bool) -> Parts:
        """Integrate on doubled nodes what converges; returns what does not (or takes it as it is)."""
        frictions = self.table.frictions
        values, n = None, _FIRST
        while parts.size:
            t = interior_nodes(n)
            steepness = _steepness(t)
            w = steepness * mapped_weights(n)
            fresh = self._at_nodes(contact, group, parts, t if values is None else t[0::2])
            values = fresh if values is None else interleaved(fresh, values)
            p, law, errors = values[0], values[1:-2], values[-2:]
            width = parts.times * parts.width
            best = width * _summed(w, law)
            # what is not added yet counts for the size of the result, not for the result
            strip = parts.rows - parts.rows.min()
            size = np.abs(total[parts.rows][:, frictions].T) + _by_strip(np.abs(best[frictions]), strip)
            spread = contact.a[parts.rows] - contact.b[parts.rows]
            floor = np.maximum(1e-3 * self.scales[frictions, None], self.friction[group[parts.rows]])
            allowed = _SHARE * self.rtol * (spread * floor + size) * parts.share
            friction = law[frictions]
            integrand = np.multiply(friction.T, steepness[:, None], order="C")
            miss = _SAFE * width * sum_errors(integrand, (allowed / width).T).T
            own = _CANCELLED * width * _summed(w, self._own(p, np.abs(friction).sum(axis=0), errors))
            # there is no use in integrating better than the law is known
            done = ((miss <= allowed) | (miss <= own)).all(axis=0)
            done |= (_by_strip(miss, strip) <= _by_strip(allowed, strip)).all(axis=0) | (last & (n == _LAST))
            np.add.at(total, parts.rows[done], np.concatenate((best, (miss.sum(axis=0) + own)[None]))[:, done].T)
            parts, values = parts.take(~done), values[:, :, ~done]
            if n == _LAST:
                break
            n *= 2
        return parts

    def _at_nodes(self, contact: Contact, group, parts: Parts, t):
        """Pressure, what the law says and its errors of friction and pressure at the parameters ``t``, (q + 2, nodes, parts)."""
        p = contact.pressure(parts.rows, parts.low + parts.width * _along(t)[:, None])
        values, errors = self.table(group[parts.rows], parts.interval, p)
        return np.concatenate((p[None], values, errors))

    @staticmethod
    def _own(p, friction, errors):
        """Error that the law itself brings at each node: of its friction, and of the pressure it belongs to."""
        rise = np.abs(np.diff(p, axis=0))
        share = np.divide(np.minimum(errors[1, 1:], rise), rise, out=np.zeros_like(rise), where=rise > 0)
        between = share * np.abs(np.diff(friction, axis=0))
        return errors[0] + np.concatenate((between[:1], between))


def _along(t):
    """Where parameter t in [0, 1] lies in a part, as a share of it: flat like t^4 at both ends, so that a law that begins at its
    break like a root, or nearly like ``p log p``, is smooth in t."""
    return t**4 * (35 - t * (84 - t * (70 - 20 * t)))


def _steepness(t):
    """How fast that rises, over ``quadrature.mapped``: by that much more counts what is summed up there."""
    return 70 / 3 * (t * (1 - t)) ** 2


def _extremes(contact: Contact):
    """Greatest and least pressure of contacts, Pa: the least a trifle above itself. Many begin at ``-p_0``, all along y, where a
    law may let go too: rounding must not decide which of them pass that."""
    return contact.p_peak, contact.p_least + _TRIFLE * np.abs(contact.p_least)


def _summed(weights, values):
    """Weighted sum over the nodes (..., nodes, parts), one after the other: no part's sum depends on those beside it."""
    out = weights[0] * values[..., 0, :]
    for k in range(1, weights.size):
        out += weights[k] * values[..., k, :]
    return out


def _by_strip(values, strip):
    """Sums (q, parts) of ``values`` over the parts of the same strip."""
    return np.stack([np.bincount(strip, row)[strip] for row in values])
