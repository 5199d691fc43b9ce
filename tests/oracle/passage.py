"""The passage of a material point from one onset of engagement to the next, and how it depends on the onset phase.

At an onset ``d`` the free gap falls to ``Delta``, so ``w = u(d) + Delta``: the phase alone is the state. The
onset-to-onset map ``T`` is increasing where it is finite, because a point that engages later has the larger
``z = w - J p`` from then on, hence enters contact later, leaves it earlier and is released earlier. With ``P0 = 0`` an
onset is the entry into contact at zero pressure, and the release is the exit from it.

``T`` is followed through ``Y(d) = m(T(d) - 2 pi) - m(d)`` with ``m' = Delta + H``. It has the sign of
``T(d) - d - 2 pi``, because ``m`` increases over the onset arc, but its slope

    Y' = X (rho E - 1) + Q rho E,     X = Delta + H(d),   rho = 1 + P' / -(P0 + Delta + H(c)),
    E = exp(-(T - d - L)/beta - L/alpha),  L = contact length,

holds no difference of large terms (X ~ beta) when the foundation is slow, and does not blow up where T grazes. ``Q``
and ``P'`` are the jumps that the rate of ``z`` makes at onset and release.
"""

from dataclasses import dataclass
from typing import Any

from mpmath import mp

from .flow import ContactFlow, GapFlow, crossing, decay

ENGAGED, MISSED, RETURNED = "engaged", "missed", "returned"


@dataclass(frozen=True)
class Passage:
    """Event phases: onset d, contact b to a (None without contact), release c, next onset. ``outcome`` says whether
    the point stays engaged (no c), misses the next onset (no next), or returns.

    Margins are (value, derivative by d): how far the gap, continued to the end of the release arc without release,
    passes ``Delta``; how far the free gap stays above ``Delta`` at the end of the next onset arc. They change sign
    where ``T`` ceases to be finite.
    """

    outcome: str
    d: Any
    b: Any = None
    a: Any = None
    c: Any = None
    next: Any = None
    contact: Any = None  # ContactFlow
    release_margin: Any = (None, None)
    return_margin: Any = (None, None)

    @property
    def length(self):
        """Length of the contact zone."""
        return self.a - self.b if self.b is not None else mp.zero


class ReturnMap:
    """Onset-to-onset map of one strip; onsets are taken in the arc around ``s = -lag``."""

    def __init__(self, strip):
        self.strip = strip
        self.onset = strip.arc_above(-strip.Delta)
        self.next_onset = strip.arc_above(-strip.Delta, turn=1)
        self.entry = strip.arc_above(-strip.P0)
        self.exit = strip.arc_below(-strip.P0)
        self.release = strip.arc_below(-strip.P0 - strip.Delta)
        self.release_jump = strip.P0 - strip.step  # P' of the module's docstring
        self.onset_jump = strip.Delta * (1 / strip.J - 1) if strip.snaps else self.release_jump  # Q

    # -- one passage ------------------------------------------------------------------------------------------------

    def passage(self, d):
        """Follow the point that engages at ``d`` until it engages again."""
        strip = self.strip
        b, p_b, adhesion = self._contact_entry(d)
        if b is None:
            return self._from_adhesion(d, None, None, None, adhesion)
        contact = ContactFlow(strip, b, p_b)
        a = self.contact_exit(contact)
        if a is None:
            return Passage(ENGAGED, d, b, contact=contact)
        if strip.P0 == 0:
            return self._from_release(d, b, a, a, contact, strip.u(a), (None, None))
        return self._from_adhesion(d, b, a, contact, GapFlow(strip, a, strip.u(a), strip.P0))

    def _contact_entry(self, d):
        """Phase of contact entry, pressure there, and the adhesion flow before it or instead of it."""
        strip = self.strip
        if strip.P0 == 0:
            return d, mp.zero, None
        if strip.snaps:
            return d, -strip.Delta / strip.J, None
        adhesion = GapFlow(strip, d, strip.u(d) + strip.Delta - strip.step, strip.P0)
        return crossing(adhesion.gap_above(0), d, self.entry, rising=False), -strip.P0, adhesion

    def contact_exit(self, contact):
        """Where the contact pressure falls to ``-P0``; None if it does not within this period."""
        if self.exit is None:
            return None
        if self.strip.alpha == 0:  # local pressure p = H
            return self.exit[0]
        return crossing(contact.pressure_above(-self.strip.P0), contact.start, self.exit, rising=False)

    def _from_adhesion(self, d, b, a, contact, adhesion):
        strip, event = self.strip, adhesion.gap_above(self.strip.Delta)
        if self.release is None:
            return Passage(ENGAGED, d, b, a, contact=contact)
        end = self.release[1]
        margin = event(end)[0], self._z_slope(d, b, a, end)
        c = crossing(event, adhesion.start, self.release, rising=True)
        if c is None:
            return Passage(ENGAGED, d, b, a, contact=contact, release_margin=margin)
        return self._from_release(d, b, a, c, contact, adhesion.w(c) + strip.step, margin)

    def _from_release(self, d, b, a, c, contact, w_c, release_margin):
        free, end = GapFlow(self.strip, c, w_c, mp.zero), self.next_onset[1]
        event = free.gap_above(self.strip.Delta)
        following = crossing(event, c, self.next_onset, rising=False)
        margin = event(end)[0], self._z_slope(d, b, a, c) * self._rho(self.strip.load(c)) * decay(end - c, self.strip.beta)
        return Passage(RETURNED if following is not None else MISSED, d, b, a, c, following, contact, release_margin, margin)

    # -- slopes -----------------------------------------------------------------------------------------------------

    def _z_slope(self, d, b, a, s):
        """Derivative of z at the phase ``s``, while engaged, by the onset phase."""
        onset = (self.strip.Delta + self.strip.load(d) + self.onset_jump) / self.strip.beta
        return onset * self._forgetting(s - d, a - b if b is not None else 0)

    def _forgetting(self, total, length):
        """``E``: what is left of a deviation after ``total``, of which ``length`` is contact."""
        return decay(total - length, self.strip.beta) * (decay(length, self.strip.alpha) if length > 0 else 1)

    def _rho(self, load):
        """Factor that a deviation gains at a release under the load harmonic ``load``."""
        if self.release_jump == 0:
            return mp.one
        speed = -(self.strip.P0 + self.strip.Delta + load)
        return 1 + self.release_jump / speed if speed > 0 else mp.inf

    def advance(self, passage):
        """``Y`` of a passage that returns."""
        return self._measure(passage.next - 2 * mp.pi) - self._measure(passage.d)

    def _measure(self, s):
        return self.strip.Delta * s + self.strip.load_integral(s)

    def advance_slope(self, passage):
        """``Y'`` of a passage that returns."""
        kept = self._rho(self.strip.load(passage.c)) * self._forgetting(passage.next - passage.d, passage.length)
        width = self.strip.Delta + self.strip.load(passage.d)
        return width * (kept - 1) + self.onset_jump * kept

    def map_slope(self, passage):
        """``T'`` of a passage that returns."""
        width = self.strip.Delta + self.strip.load(passage.d)
        return (self.advance_slope(passage) + width) / (self.strip.Delta + self.strip.load(passage.next))

    def advance_slope_bounds(self, first, second):
        """Bounds of ``Y'`` over the onsets between two passages that return.

        All event phases are monotone in d, so the two passages bound each of them, and with them each factor.
        """
        turning = mp.pi - self.strip.lag  # middle of the release arc; -lag is that of the onset arc
        widths = [self.strip.Delta + load for load in self._load_range(first.d, second.d, -self.strip.lag)]
        loads = self._load_range(second.c, first.c, turning)
        shortest, longest = first.next - second.d, second.next - first.d
        least = self._rho(loads[0]) * self._forgetting(max(longest, first.length), first.length)
        remaining = self._forgetting(max(shortest, second.length), second.length)
        most = self._rho(loads[1]) * remaining if remaining else mp.zero
        lower = min((least - 1) * width for width in widths) + self.onset_jump * least
        if most == mp.inf:
            return lower, mp.inf
        return lower, max((most - 1) * width for width in widths) + self.onset_jump * most

    def _load_range(self, low, high, turning):
        """Least and largest ``H`` on an interval of an arc whose only extremum lies at ``turning``."""
        values = [self.strip.load(s) for s in (low, high)]
        if low < turning < high:
            values.append(self.strip.load(turning))
        return min(values), max(values)
