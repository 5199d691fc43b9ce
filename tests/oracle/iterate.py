"""Plain iteration of the period map, many strips at once: where a material point ends that starts in deep contact, or far below.

It follows every point from event to event through its zones, period after period, until a period repeats. It knows the
flows and the order of events, nothing of onset maps, boundary equations, candidates or exclusion: a check of *which*
orbit is extremal, for strips whose map contracts fast enough to wait for. Dimensionless as in ``flow.py``, in double
precision.
"""

from dataclasses import dataclass

import numpy as np

CONTACT, ADHESION, FREE = 0, 1, 2
LETTERS = "caf"
TURN = 2 * np.pi
SETTLED = 1e-11  # of its size, what a state may still be from its limit


@dataclass
class Settled:
    """Where the iteration ended, arrays of shape (n,).

    ``sequence``, ``contact``, ``adhesion``, ``pressure``: of the last period followed. ``remaining``: estimate of how
    far the state at the period's start (a displacement in units of A, or in contact a pressure in K A) still was from
    its limit; inf where the periods did not suffice. ``contraction``: ratio of the last two changes of that state.
    """

    sequence: np.ndarray
    contact: np.ndarray
    adhesion: np.ndarray
    pressure: np.ndarray
    remaining: np.ndarray
    contraction: np.ndarray

    def take(self, index):
        return Settled(*(values[index] for values in vars(self).values()))


class Points:
    """One material point for each strip. ``zone``; ``s``: phase; ``value``: p in contact, w elsewhere, at ``s``."""

    def __init__(self, alpha, beta, P0, Delta, delta, constitutive):
        self.alpha, self.beta, self.P0, self.delta = alpha, beta, P0, delta
        self.Delta = np.where(P0 > 0, Delta, 0.0)
        J = np.divide(alpha, beta, out=np.ones_like(beta), where=beta > 0)
        self.J = J
        self.step = np.where(constitutive, J * P0, 0.0)
        self.snaps = constitutive & (P0 > 0) & (self.step >= self.Delta)
        n = beta.size
        self.zone, self.s, self.value = np.zeros(n, int), np.zeros(n), np.zeros(n)
        # of the period that is being followed
        self.length = np.zeros((n, 3))
        self.force = np.zeros(n)
        self.order = np.full((n, 6), -1)
        self.count = np.zeros(n, int)

    def take(self, index):
        other = object.__new__(Points)
        other.__dict__ = {name: values[index] for name, values in self.__dict__.items()}
        return other

    def start(self, deep):
        """Deep contact (a pressure above that of any orbit), or far from the surface."""
        size = 3 + np.abs(self.delta) + np.hypot(1, self.beta) + self.P0 + self.Delta
        self.zone[:] = np.where(deep, CONTACT, FREE)
        # free: w tends to +inf is least engaged, but any w above all orbits does
        self.value[:] = 2 * size

    # -- flows and harmonics, elementwise for chosen strips -------------------------------------------------------------

    def load(self, i, s):
        return self.delta[i] - 1 + np.cos(s) - self.beta[i] * np.sin(s)

    def profile(self, i, s):
        return self.delta[i] - 1 + np.cos(s)

    def saturated(self, i, s):
        alpha, beta = self.alpha[i], self.beta[i]
        return self.delta[i] - 1 + ((1 + alpha * beta) * np.cos(s) - (beta - alpha) * np.sin(s)) / (1 + alpha * alpha)

    def flow(self, i, s):
        """Value at ``s`` by the flow of the present zone."""
        zone, start, value = self.zone[i], self.s[i], self.value[i]
        contact = zone == CONTACT
        time = np.where(contact, self.alpha[i], self.beta[i])
        kept = np.where(time > 0, np.exp(-np.divide(s - start, time, out=np.full_like(s, 1e3), where=time > 0)), 0.0)
        rest = np.where(zone == ADHESION, -self.P0[i], 0.0)
        from_rest = rest + (value - rest) * kept
        in_contact = self.saturated(i, s) + (value - self.saturated(i, start)) * kept
        return np.where(contact, in_contact, from_rest)

    def exit(self, i, s, target):
        """Event function whose rise through zero leaves the present zone for ``target``."""
        field = self.flow(i, s)
        gap = field - self.profile(i, s)
        zone = self.zone[i]
        return np.where(
            zone == CONTACT, -self.P0[i] - field,
            np.where(zone == FREE, self.Delta[i] - gap, np.where(target == CONTACT, -gap, gap - self.Delta[i])),
        )  # fmt: skip

    def arc(self, i, target):
        """Centre and half width of the phases where that rise can happen, by the sign of the load harmonic."""
        zone = self.zone[i]
        falling_gap = (zone == FREE) | ((zone == ADHESION) & (target == CONTACT))
        level = np.where(
            zone == CONTACT, -self.P0[i],
            np.where(zone == FREE, -self.Delta[i], np.where(target == CONTACT, -self.P0[i], -self.P0[i] - self.Delta[i])),
        )  # fmt: skip
        cosine = (level - (self.delta[i] - 1)) / np.hypot(1, self.beta[i])
        above = np.arccos(np.clip(cosine, -1, 1))
        lag = np.arctan(self.beta[i])
        return np.where(falling_gap, -lag, np.pi - lag), np.where(falling_gap, above, np.pi - above)

    # -- one period -----------------------------------------------------------------------------------------------------

    def period(self):
        """Follow every point to the same phase one turn on. Afterwards ``s`` is back in the first turn."""
        n = self.zone.size
        self.length[:], self.force[:], self.count[:] = 0.0, 0.0, 0
        self.order[:] = -1
        active = np.arange(n)
        end = self.s + TURN
        for _ in range(24):
            if not active.size:
                break
            self._record(active)
            following, phase = self._first_exit(active, end[active])
            self._advance(active, phase)
            leaves = following >= 0
            self._enter(active[leaves], following[leaves])
            active = active[leaves]
        else:
            raise ArithmeticError("too many events in one period")
        self.s -= TURN

    def _record(self, i):
        self.order[i, np.minimum(self.count[i], 5)] = self.zone[i]
        self.count[i] += 1

    def _first_exit(self, i, end):
        """Zone entered next and the phase of that; -1 and ``end`` where the zone lasts."""
        zone = self.zone[i]
        best, where = np.full(i.size, -1), end.copy()
        bare = self.P0[i] == 0
        for target in (CONTACT, ADHESION, FREE):
            if target == CONTACT:
                possible = (zone == ADHESION) | ((zone == FREE) & bare)
            elif target == ADHESION:
                possible = (zone != ADHESION) & ~bare
            else:
                possible = (zone == ADHESION) | ((zone == CONTACT) & bare)
            pick = np.flatnonzero(possible)
            if pick.size:
                phase, happens = self._crossing(i[pick], np.full(pick.size, target), end[pick])
                earlier = happens & ((phase < where[pick]) | (best[pick] < 0))
                best[pick[earlier]], where[pick[earlier]] = target, phase[earlier]
        return best, where

    def _crossing(self, i, target, end):
        """First phase up to ``end`` at which the zone is left for ``target``. Within its arc the event function rises
        through zero at most once."""
        centre, half = self.arc(i, target)
        start = self.s[i]
        found, happens = end.copy(), np.zeros(i.size, bool)
        turn = np.floor((start - centre + half) / TURN)
        for shift in (-1, 0, 1):
            low = centre + TURN * (turn + shift) - half
            high = np.minimum(low + 2 * half, end)
            low = np.maximum(low, start)
            # what is left of an arc but for rounding is over
            ask = np.flatnonzero(~happens & (half > 0) & (high - low > 1e-14 * (1 + np.abs(high))))
            if not ask.size:
                continue
            # next to no memory: the function follows the harmonic and vanishes at the end of the arc; it is largest half way
            for last in (high, 0.5 * (low + high)):
                rises = ~happens[ask] & (self.exit(i[ask], last[ask], target[ask]) > 0)
                these = ask[rises]
                if these.size:
                    happens[these] = True
                    found[these] = self._root(i[these], target[these], low[these], last[these])
        return found, happens

    def _root(self, i, target, low, high):
        """Bisection with secant steps (Illinois) between ``low``, where the event function is not positive, and
        ``high``, where it is."""
        f_low, f_high = self.exit(i, low, target), self.exit(i, high, target)
        result = np.where(f_low >= 0, low, high)
        active = np.flatnonzero(f_low < 0)
        side = np.zeros(i.size, int)
        for step in range(120):
            if not active.size:
                break
            lo, hi, fl, fh = low[active], high[active], f_low[active], f_high[active]
            x = lo + (hi - lo) * np.clip(-fl / (fh - fl), 1e-3, 1 - 1e-3) if step % 4 != 3 else 0.5 * (lo + hi)
            f = self.exit(i[active], x, target[active])
            up = f > 0
            high[active], f_high[active] = np.where(up, x, hi), np.where(up, f, np.where(side[active] < 0, 0.5 * fh, fh))
            low[active], f_low[active] = np.where(up, lo, x), np.where(up, np.where(side[active] > 0, 0.5 * fl, fl), f)
            side[active] = np.where(up, 1, -1)
            result[active] = high[active]
            active = active[high[active] - low[active] > 4e-16 * (1 + np.abs(high[active]))]
        return result

    def _advance(self, i, phase):
        before, start = self.value[i], self.s[i]
        after = self.flow(i, phase)
        zone, length = self.zone[i], phase - start
        # integral of p: the law p + alpha p' = H integrated, or the constant traction
        load = (self.delta[i] - 1) * length + np.sin(phase) - np.sin(start) + self.beta[i] * (np.cos(phase) - np.cos(start))
        force = np.where(
            zone == CONTACT, load - self.alpha[i] * (after - before), np.where(zone == ADHESION, -self.P0[i] * length, 0.0)
        )
        self.force[i] += force
        np.add.at(self.length, (i, zone), length)
        self.s[i], self.value[i] = phase, after

    def _enter(self, i, following):
        zone, profile = self.zone[i], self.profile(i, self.s[i])
        contact = following == CONTACT
        snap = (zone == FREE) & (following == ADHESION) & self.snaps[i]
        w = np.where(
            zone == CONTACT,
            profile,
            np.where(following == FREE, profile + self.Delta[i] + self.step[i], profile + self.Delta[i] - self.step[i]),
        )
        p = np.where(zone == ADHESION, -self.P0[i], 0.0)
        reach = np.divide(-self.Delta[i], self.J[i], out=np.zeros(i.size), where=snap)
        self.value[i] = np.where(snap, reach, np.where(contact, p, w))
        self.zone[i] = np.where(snap, CONTACT, following)


def iterate(alpha, beta, P0, Delta, delta, constitutive, deep, periods):
    """Iterate the period map from deep contact (``deep``, of each strip) or from far below until every strip repeats, or for
    ``periods``."""
    arrays = [np.asarray(v, float) for v in (alpha, beta, P0, Delta, delta)]
    points = Points(*arrays, np.asarray(constitutive, bool))
    points.start(deep)
    n = points.zone.size
    out = Settled(np.empty(n, object), *(np.full(n, np.nan) for _ in range(3)), np.full(n, np.inf), np.full(n, np.nan))
    index = np.arange(n)
    zone, value, change = points.zone.copy(), points.value.copy(), np.full(n, np.inf)
    for number in range(1, periods + 1):
        points.period()
        moved = np.abs(points.value - value)
        same = points.zone == zone
        ratio = np.divide(moved, change, out=np.ones(index.size), where=(change > 0) & np.isfinite(change))
        left = moved * np.divide(ratio, 1 - ratio, out=np.full(index.size, np.inf), where=ratio < 1)
        left = np.where(same, np.where(moved == 0, 0.0, left), np.inf)
        size = 1 + np.abs(points.value)
        # changes at the level of rounding no longer shrink; the first few say nothing of the contraction
        still = same & (moved <= 4e-16 * size)
        done = still | ((left <= SETTLED * size) & (number > 4))
        if number == periods:
            done[:] = True
        finished = np.flatnonzero(done)
        if finished.size:
            _write(out, index[finished], points, finished, np.where(still, 0.0, left)[finished], ratio[finished])
            keep = np.flatnonzero(~done)
            points, index = points.take(keep), index[keep]
            moved = moved[keep]
            if not index.size:
                break
        zone, value, change = points.zone.copy(), points.value.copy(), moved
    return out


def _write(out, index, points, pick, left, ratio):
    out.contact[index] = points.length[pick, CONTACT] / TURN
    out.adhesion[index] = points.length[pick, ADHESION] / TURN
    out.pressure[index] = points.force[pick] / TURN
    out.remaining[index], out.contraction[index] = left, ratio
    for j, i in zip(index, pick, strict=True):
        out.sequence[j] = cyclic([LETTERS[z] for z in points.order[i, : points.count[i]]])


def cyclic(letters):
    """Cyclic order of zones without repeats, rotated to its alphabetically first form."""
    merged = [z for z, before in zip(letters, letters[-1:] + letters[:-1], strict=True) if z != before] or letters[:1]
    text = "".join(merged)
    return min(text[i:] + text[:i] for i in range(len(text)))
