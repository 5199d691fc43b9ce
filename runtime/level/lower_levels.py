"""Second term of Eq. 13: what the levels below contribute in the contact of a strip, ``(1/l) int law[p(x)] dx``.

In contact ``p - p* + alpha p' = H - p*``: like every event function, p passes a given pressure upward at most once and downward
at most once, each in an arc known in closed form. So the contact is cut at the breaks of the law (pull-off, jumps, saturation)
and each part integrated by itself, on as many nodes as it needs.
"""

from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from ..numerics.gauss import graded_gauss, left_out, summed
from ..orbit.batch import Ranges
from ..orbit.contact import Contact
from ..orbit.groups import TWO_PI
from .law import Laws
from .strips import SolvedStrips

#: a part's share of the error that an average of strips is allowed, and parts integrated at a time
_SHARE, _CHUNK = 0.1, 4096
#: what is left in a mean over contacts of the errors of a law, and of sums over parts: most panels and parts err by a hundredth
#: of their bounds, which have to hold for each, and along a law's pieces errors change sign; so much of a piece errs alike. With
#: 0.3 and 0.05, as without adhesion, one of 25 surfaces is solved twice
_CANCELLED, _SUMMED, _ALIKE = 0.08, 0.3, 0.02
#: after how many memories pressure is as if it had stepped
_MEMORIES = 5.0
#: nodes of a part, tried in turn
_NODES = (12, 20, 34, 54, 84)


@dataclass
class Parts(Ranges):
    """Parts [low, high] of the contacts ``rows``, ascending, in phase, where the pressure lies between the breaks ``interval``
    and the next ones; all (m,). ``times``: how often each counts, since in saturated contact the pressure falls as it rises."""

    rows: np.ndarray
    interval: np.ndarray
    times: np.ndarray


@dataclass(frozen=True)
class LowerLevelLaws:
    """Contributions of the next level down, the last an error estimate of friction; ``laws`` holds a law for each group.

    ``scales`` (q,): natural scales of the contributions. ``rtol``: accuracy of the averages that they go into."""

    laws: Laws
    rtol: float
    scales: np.ndarray

    def passed(self, strips: SolvedStrips, group: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Codes (m,) of the law's breaks that pressures of each strip pass: how many its greatest exceeds, how many its least.
        And its greatest pressure, then, of saturated contact, the least, over these breaks, (m, k), Pa, else NaN."""
        breaks, (index, contact) = self.laws.breaks, strips.touching
        codes, over_breaks = np.zeros(group.size, int), np.full((group.size, 2 * breaks.shape[1]), np.nan)
        least = np.where(contact.full, contact.p_entry, np.nan)
        over = [p[:, None] - breaks[group[index]] for p in (contact.p_peak, least)]
        exceeded, all_along = (np.count_nonzero(each > 0, axis=1) for each in over)
        codes[index], over_breaks[index] = 1 + exceeded + (breaks.shape[1] + 1) * all_along, np.concatenate(over, axis=1)
        return codes, over_breaks

    def kinks(self, strips: SolvedStrips, group: np.ndarray, memory: np.ndarray, x: np.ndarray) -> np.ndarray:
        """Where along lines of strips, at places ``x`` (m, n), what they carry all but has a kink, (m,): where pressure right
        after entry passes the greatest of the jumps of the law that it passes; NaN if none.

        Within a few times the shortest ``memory`` (m n,), in phase, pressure rises all but at once to what decides how far on it
        passes a break: on one side of such a place that is next to entry. Without memory it steps there, and that is a kink."""
        (index, contact), line = strips.touching, np.arange(len(x))
        over = np.full((group.size, self.laws.breaks.shape[1]), np.nan)
        over[index] = contact.entered(_MEMORIES * memory[index])[:, None] - self.laws.breaks[group[index]]
        over = over.reshape(*x.shape, over.shape[1])
        jumps = (over[:, 1:] * over[:, :-1] < 0) * self.laws.at_breaks[0][group].reshape(over.shape)[:, 1:]
        at = jumps.max(axis=2).argmax(axis=1)
        which = jumps[line, at].argmax(axis=1)
        first, last = over[line, at, which], over[line, at + 1, which]
        share = np.divide(first, first - last, out=np.full(len(x), np.nan), where=jumps[line, at, which] > 0)
        return x[line, at] + share * (x[line, at + 1] - x[line, at])

    def over_contact(self, strips: SolvedStrips, group: np.ndarray) -> np.ndarray:
        """Contributions averaged over the period, (m, q): the law's quantities from friction on, then their error."""
        carried = np.zeros((group.size, self.scales.size))
        index, contact = strips.touching
        carried[index] = self._contributions(contact, group[index]) / TWO_PI
        return carried

    def _contributions(self, contact: Contact, group) -> np.ndarray:
        laws = self.laws
        total = np.zeros((group.size, self.scales.size))
        breaks = laws.breaks[group]
        row, j = np.nonzero(breaks < contact.p_peak[:, None])
        # phases between which the pressure exceeds each break, nested about the peak
        ups, downs = (np.repeat(contact.top[:, None], breaks.shape[1] + 1, axis=1) for _ in range(2))
        ups[row, j], downs[row, j] = contact.passes(row, breaks[row, j])
        saturates = breaks[row, j] >= laws.p_sat[group[row]]
        saturated, jump = row[saturates], j[saturates]
        total[saturated, :-1] += (downs - ups)[saturated, jump, None] * laws.saturated[group[saturated], 1:]
        # where a break lies is known as well as the law's pressures: that much of the jump may fall on the wrong side
        crossing = ~saturates & (breaks[row, j] > np.minimum(contact.p_entry, contact.p_exit)[row])
        np.add.at(total[:, -1], row[crossing], self._misplaced(contact, group, row[crossing], j[crossing], ups, downs))
        inside = np.zeros(breaks.shape, bool)
        inside[row, j] = ~saturates
        self._integrate(contact, group, _parts_between(contact, inside, ups, downs), total)
        # what is not known of a law beyond the pressure that it was built for is about as much as it ever carries
        beyond = np.flatnonzero(contact.p_peak > laws.top[group])
        up, down = contact.passes(beyond, laws.top[group[beyond]])
        total[beyond, -1] += (down - up) * laws.greatest[group[beyond]][:, laws.frictions].sum(axis=1)
        return total

    def _misplaced(self, contact: Contact, group, row, j, ups, downs):
        jumps, known_to = self.laws.at_breaks
        shift = known_to[group[row], j] / contact.unit[row]
        reach = np.zeros(row.size)
        for phase, end in ((ups[row, j], contact.p_entry[row]), (downs[row, j], contact.p_exit[row])):
            slope = np.abs(contact.slope(row, phase))
            near = np.minimum(np.divide(shift, slope, out=np.full(row.size, np.inf), where=slope > 0), np.sqrt(shift))
            reach += np.where(self.laws.breaks[group[row], j] > end, near, 0.0)
        return jumps[group[row], j] * np.minimum(reach, (downs - ups)[row, j])

    def _integrate(self, contact: Contact, group, every: Parts, total) -> None:
        """Add the integrals of the law over ``every`` part of the contacts, on as many nodes as it takes, with their errors."""
        frictions = self.laws.frictions
        # those of a contact together
        ends = np.append(np.searchsorted(every.rows, every.rows[::_CHUNK]), every.size)
        for begin, end in pairwise(np.unique(ends)):
            parts = every.take(slice(begin, end))
            strip = parts.rows - parts.rows[0]
            spread, ready, own = (contact.a - contact.b)[parts.rows], np.zeros(parts.size, bool), np.zeros(parts.size)
            floor = 1e-3 * self.scales[frictions, None]
            best, miss = np.zeros((self.scales.size - 1, parts.size)), np.zeros((len(frictions), parts.size))
            for n in _NODES:
                left = np.flatnonzero(~ready)
                if not left.size:
                    break
                best[:, left], miss[:, left], own[left] = self._sums(contact, group, parts.take(left), n)
                # what a strip carries counts as a whole, its parts alike
                size = _by_strip(np.abs(best[frictions]), strip)
                allowed = _SHARE * self.rtol * (spread * floor + size)
                # there is no use in integrating better than the law is known
                ready = ((miss <= allowed / np.bincount(strip)[strip]) | (miss <= own)).all(axis=0)
                ready |= (_by_strip(miss, strip) <= allowed).all(axis=0)
            # the bound of a part that no rule was enough for need not be a hundredfold one
            unsure = np.where(ready, _SUMMED, 1.0) * miss.sum(axis=0)
            np.add.at(total, parts.rows, np.concatenate((best, (unsure + own)[None])).T)

    def _sums(self, contact: Contact, group, parts: Parts, n: int) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Integrals of the law over parts on n nodes each, what those of frictions miss, and what is not known of the law."""
        share, weight, projection = graded_gauss(n)
        p = contact.pressure(parts.rows, parts.low + parts.width * share[:, None])
        law, errors, span = self.laws.smooth(group[parts.rows], parts.interval, p)
        left = np.maximum(_ALIKE / np.maximum(span, _ALIKE), _CANCELLED)
        width, friction = parts.times * parts.width, law[self.laws.frictions]
        miss = left_out(projection, friction.swapaxes(0, 1))
        return width * summed(weight, law.swapaxes(0, 1)), width * miss, left * width * summed(weight, errors[0])


def _parts_between(contact: Contact, inside: np.ndarray, ups: np.ndarray, downs: np.ndarray) -> Parts:
    """Parts of all contacts, (n,), from the breaks ``inside`` (n, B) on: between the phases ``ups`` and ``downs`` (n, B + 1), the
    last of which is the peak, at which the pressure passes the breaks."""
    # on the way up, then down
    low, high = np.stack((ups[:, :-1], downs[:, 1:])), np.stack((ups[:, 1:], downs[:, :-1]))
    there = inside & (high > low)
    there[1] &= ~contact.full[:, None]
    row, interval, way = np.nonzero(np.moveaxis(there, 0, 2))
    times = np.where(contact.full[row], 2.0, 1.0)
    return Parts(low[way, row, interval], high[way, row, interval], row, interval, times)


def _by_strip(values, strip):
    """Sums (q, parts) of ``values`` over the parts of the same strip."""
    return np.stack([np.bincount(strip, row)[strip] for row in values])
