r"""What is extremal with an n-dimensional state, and how the window of an orbit, the time that it is free, proves it.

*Order.* Under ``constitutive`` the motion of a material point preserves the order "engaged before free, then every dashpot
displacement ascending". Let ``z = J_0 sum K_i e_i`` (in units of K), ``y = z - u``. The dashpots obey ``alpha_i e_i' = w - e_i``,
``w = z + J_0 p``, and the traction is a relay in y: free (p = 0, gap y) until y falls to delta_0; engaged, in contact while
``y < J_0 p_0`` and else adhering, until y rises to ``delta_0 + J_0 p_0``. Engaged ``w = u + max(y - J_0 p_0, 0)``, free ``w =
u + y``, both nondecreasing in y, and y in each e_i; an engaged state below a free one has the lower w. So right-hand sides do
not fall when another e_j rises (Kamke), and the lower state is engaged whenever the upper one is. Nothing of this holds for
``continuous``. The period map is monotone: from a state below (above) all orbits, always engaged (free), iterates rise (fall)
to the most (least) engaged orbit. For n >= 2 unordered orbits are not excluded; all lie between these two.

*Forced orbits.* Let a strip be free in its window, from c to d, whatever its gap, with ``w = u + max(y, 0)``, and engaged
otherwise. That law contracts (``w - w'`` is at most ``sum K_i/K_g`` of the largest ``e_i - e_i'``), so it has one periodic
orbit F for each window, and F rises with the window, as w is nowhere less where it is free. An orbit is F of its own window
(or of all the parts of it), with y = delta_0 + J_0 p_0 at c, delta_0 at d. So where all orbits are free in a window they lie
above its F, and where all are engaged outside of one, below. The law is ``max`` over contacts of linear ones, so F with any
contact imposed lies no higher than F, and where the contact of a turn is imposed next that is Newton's method on a convex map
(``settled``).

*Response.* Let a window grow by u at c and by v at d. Then e grows by no more than a linear law makes it: w is higher by a step
J_0 p_0 at most where the window grew, which adds J_j/(J_0 beta_j) per time to z_j; else deviations fade as in contact where the
upper orbit touches, and as in a gap elsewhere, which keeps more in every entry. No less than that, if they fade in the contact of
the lower orbit. All are sums of decaying modes, bounded over ranges of phases: r >= 0, (2, 2), is what y gains at c and d per
growth at either (``responses``).

From d - v on the lower orbit has ``w >= u``: the upper one, free there, is higher by its gap y at most, a known curve, and
deviations fade no less than in contact. Where contact follows the onset closely that is the better bound (``apart``).

*Alone* (``alone``). Let all orbits be free in [c_0, d_0], and the orbit in [c, d], which is larger. Let the first orbit be
free from c + u to d - v. At c + u the orbit, had it stayed engaged, would be beyond the release by s_c u at least, where s_c
bounds the chords of a known curve; the other is not beyond it. So ``s_c u <= r_cc u + r_cd v``, likewise at d. If the
diagonal and the determinant of ``A = diag(s) - r`` are positive, A is an M-matrix, ``A (u, v) <= 0`` means u = v = 0, and the
orbit is the first. From above the same holds, u and v being growths; the orbit, had it stayed free behind d, may close its
gap: then ``w = u + max(y, 0)`` bounds the others, also those with another free part there.

*Links* (``links``). Let all orbits be free in a window, and gaps along F be beyond an orbit's at c and at d, strictly, for
all windows on a straight way to a larger one. Then all orbits are free in that one: at the last that is within an orbit's,
the orbit is released before c and engaged after d. Along the way these gaps are no less than linear ones, so the far end
decides. From above likewise. Links are as long as Newton's steps: next to a fold, where the map from window to window hardly
moves, each halves the way.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from hystrip.generated.modes import over_period
from hystrip.generated.modes import solved as solved_modes

from ...numerics.linear import solved
from .march import CONTACT, FREE, TWO_PI, march, one_zone
from .problem import ModeStrips, rates

#: cells in which a chord is bounded: more bound it closer, by as much work
_CELLS = np.linspace(0.0, 1.0, 7) ** 1.5
#: orbits are settled where a turn moves their edges by no more, as they err by the square of that; and after how many turns they
#: are given up: Newton's method takes three or four, and what it does not find in eight has more than one contact
_SETTLED, _SETTLING = 1e-7, 12


class Forced:
    """Periodic orbits of N strips forced by ``edges`` d, b, a, c (4, N), without contact b = a: free from c to d, in contact from
    b to a, and else in adhesion. ``states`` at a, c, d, b (n, N)."""

    def __init__(self, kernel, s: ModeStrips, edges: np.ndarray, states=None):
        self.kernel, self.s, self.edges = kernel, s, edges
        self.states = self._periodic() if states is None else states

    def _periodic(self):
        (d, b, a, c), kernel, s, m, none = self.edges, self.kernel, self.s, self.s.m, np.zeros((self.s.modes, 1))
        lost, driven = kernel.contact_map(b, a, kernel.profile(b, s.D) / m.J_0, m)
        # a contact that is entered with any state: the pressure there follows from it
        creep = [kernel.contact_increment(b, a, kernel.overstress(none, p, m), m) for p in (1.0, 0.0)]
        contact = lost + (creep[0] - creep[1])[:, None] / m.J_0, driven
        maps = (kernel.relaxation_map(a, c, -s.p_0, m), kernel.relaxation_map(c, d + TWO_PI, 0.0, m),
                kernel.relaxation_map(d, b, -s.p_0, m), contact)  # fmt: skip
        states = [solved_modes(*over_period(maps))]
        for lost, driven in maps[:-1]:
            states.append(states[-1] + driven - lost * states[-1])
        return np.stack(states)

    def take(self, index) -> Forced:
        return Forced(self.kernel, self.s.take(index), self.edges[:, index], self.states[..., index])

    @classmethod
    def settled(cls, kernel, s: ModeStrips, edges: np.ndarray, exactly: bool = True):
        """Orbits in the windows of ``edges`` with the contacts that they come to, and which settled; not ``exactly``: with
        those of one turn, bounds from below.

        The window that is returned ends with the contact that holds at its start, and where its gap closes."""
        found, left, good = cls(kernel, s, edges.copy()), np.arange(s.size), np.zeros(s.size, bool)
        for _ in range(_SETTLING if exactly else 1):
            left = left[np.isfinite(found.states[..., left]).all(axis=(0, 1))]
            if not left.size:
                break
            here = found.take(left)
            after, followed = here.turned(edges[[0, 3]][:, left], exactly)
            good[left] = followed & (np.abs(after - here.edges).max(axis=0) <= _SETTLED)
            left, after = left[~good[left]], after[:, ~good[left]]
            found.edges[:, left] = after
            found.states[..., left] = cls(kernel, s.take(left), after).states
        return found, good if exactly else np.isfinite(found.states).all(axis=(0, 1))

    def turned(self, wide, exactly: bool):
        """Edges of a turn that starts from the orbit at the onset, in the window ``wide`` (d, c); and whether it was followed.

        ``exactly``: a contact that holds at c, or begins in the free zone, is one without adhesion there: its pressure is not
        below zero up to the onset."""
        (d, b, a, c), s, kernel = self.edges, self.s, self.kernel
        d_0, c_0 = wide if exactly else (d, c)
        z_d, none = self.states[2], np.zeros(s.size)
        turn = march(kernel, replace(s, bare=True), np.ones(s.size, bool), z_d, d, c_0 - d)
        touching = z_d.sum(axis=0) - kernel.profile(d, s.D) < s.step
        b = np.where(touching, d, np.where(np.isnan(turn.entry), c_0, turn.entry))
        a = np.where(np.isnan(turn.exit), c_0, turn.exit)
        b, a = (np.where(touching | (turn.contacts > 0), edge, d) for edge in (b, a))
        if not exactly:
            return np.stack((d, b, a, c)), ~turn.lost
        dry, z, start, limit = replace(s, p_0=none, delta_0=none, snaps=none > 1), z_d + turn.dz, c_0, d_0 + TWO_PI
        held = np.flatnonzero(z.sum(axis=0) < kernel.profile(c_0, s.D))
        if held.size:
            start = start.copy()
            end, change, *_ = one_zone(
                kernel, dry.take(held), np.full(held.size, CONTACT), c_0[held], limit[held], z[:, held], None
            )
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

    def gaps(self):
        """y at release and onset."""
        (d, _, _, c), (_, z_c, z_d, _) = self.edges, self.states
        return z_c.sum(axis=0) - self.kernel.profile(c, self.s.D), z_d.sum(axis=0) - self.kernel.profile(d, self.s.D)

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
    """Least and greatest slope of chords of ``-cos x + sum_j amplitude_j exp(-(x - start) rate_j)`` from ``at`` to any x up
    to ``to``.

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


def responses(kernel, s: ModeStrips, contact, c, d, forcing, upper: bool, moved=None, apart=None):
    """Bounds (2, 2, N) of what y gains at release and onset, per growth of the window at either, by steps of w of heights
    ``forcing``.

    ``contact``: its first and last phase; ``c``, ``d``: ranges of the edges. ``moved``: where the contact moves with the
    onset, the least and greatest time between them, and what w gains where it begins. ``apart``: by how much w is higher
    at most, on average, where the window grew at its onset."""
    (b, a), (c_1, c_2), (d_1, d_2), n = contact, c, d, s.modes
    rate, kicks = rates(s.m.beta), s.m.J * rates(s.m.beta) / s.m.J_0
    back = np.stack([kernel.dashpots(np.eye(n)[:, j, None], 0.0, s.m) for j in range(n)], axis=1)

    def sums(matrix, amplitudes, short, long):
        near, far = (amplitudes * np.exp(-np.maximum(t, 0.0) * rate) for t in ((short, long) if upper else (long, short)))
        rising, falling = np.maximum(matrix, 0.0), np.minimum(matrix, 0.0)
        return np.maximum(np.einsum("ij...,j...->i...", rising, near) + np.einsum("ij...,j...->i...", falling, far), 0.0)

    share, one = np.swapaxes(s.m.share, 0, 1), np.ones((n, s.size))
    rows = sums(share, one, c_1 - a, c_2 - a), sums(share, one, d_1 + TWO_PI - a, d_2 + TWO_PI - a)
    soonest, latest, at_contact = (b - d_2, b - d_1, None) if moved is None else moved
    shift = 0.0 if moved is None else d_2 - d_1
    columns = [
        forcing[0] * sums(back, kicks, b + TWO_PI - c_2, b + shift + TWO_PI - c_1),
        forcing[1] * sums(back, kicks, soonest, latest),
    ]
    if apart is not None:
        columns[1] = np.minimum(columns[1], apart * sums(back, kicks, soonest, soonest))
    if moved is not None:
        columns[1] = np.maximum(columns[1] + at_contact * np.einsum("ij...,j...->i...", back, kicks), 0.0)
    # what a period forgets: small where foundations are slow, so it is added up by itself
    fade = np.expm1(-(a - b) * rates(s.m.alpha))
    forgets = np.moveaxis(back, -1, 0) @ (np.expm1((a - b - TWO_PI) * rate).T[:, :, None] * np.moveaxis(s.m.share, -1, 0))
    matrix = -(1 + fade.T)[:, :, None] * forgets
    matrix[:, range(n), range(n)] -= fade.T
    x = solved(matrix, np.moveaxis((1 + fade) * np.stack(columns), -1, 0).swapaxes(1, 2))
    r = np.einsum("kiN,Nij->kjN", np.stack(rows), x)
    between = d_1 + TWO_PI - c_2 if upper else d_2 + TWO_PI - c_1
    r[1, 0] += forcing[0] * (kicks * np.exp(-np.maximum(between, 0.0) * rate)).sum(axis=0)
    return r


def alone(orbit: Forced, window, contact, rising: bool, agree: float) -> np.ndarray:
    """Whether no orbit lies between ``orbit`` and those that are free in the ``window`` (d, c) (``rising``), or engaged
    outside of it and in contact in the ``contact`` (b, a) at least. Where it is within the window by no more than ``agree``,
    it is as if at its edge.

    From above the chord behind c may lead into the contact, where y is ``J_0 p_0`` less J_0 times the excess pressure: that
    rises to one peak, and its slope is concave where the harmonic part falls (``contact``)."""
    kernel, s = orbit.kernel, orbit.s
    (d, b, a, c), (d_0, c_0) = orbit.edges, window
    sign = 1.0 if rising else -1.0
    good = (sign * (c - c_0) <= agree) & (sign * (d_0 - d) <= agree)
    c_0, d_0 = (np.maximum(c_0, c), np.minimum(d_0, d)) if rising else (np.minimum(c_0, c), np.maximum(d_0, d))
    with np.errstate(all="ignore"):
        if rising:
            steep_c, steep_d = orbit.adhering(c_0)[0], -orbit.falling(d_0)[1]
            apart = s.delta_0 - 0.5 * orbit.falling(d_0)[0] * (d - d_0)
            contact, highest = (b, a), s.step
            c_range, d_range = (c, c_0), (d_0, d)
        else:
            z_b = orbit.states[3]
            entry = kernel.overstress(z_b, (kernel.profile(b, s.D) - z_b.sum(axis=0)) / s.m.J_0, s.m)
            within = kernel.excess_entry(b, entry, s.p_0, s.D, s.m)
            excess = lambda phase: kernel.excess_event(np.clip(phase, b, a), *within)  # noqa: E731
            storage, loss = kernel.storage(s.m), kernel.loss(s.m)
            lead = np.arctan2(loss, storage)
            steep_c, u = orbit.adhering(np.maximum(c_0, a))[0], c - c_0
            early = c_0 < a
            fall = s.m.J_0 * np.minimum(-excess(c_0)[1], -excess(a)[1])
            fall = np.where((c_0 > -lead) & (c_0 >= b), np.maximum(fall, 0.0), 0.0)
            steep_c = np.where(early, np.minimum(steep_c, (s.delta_0 + fall * (a - c_0)) / u), steep_c)
            q = orbit.closing(c, d_0 + TWO_PI, orbit.states[1]) - TWO_PI
            closes = q < d_0
            slope = lambda x: -(storage * np.sin(x) + loss * np.cos(x))  # noqa: E731
            rise = np.where((q > -np.pi - lead) & (d_0 < -lead), np.maximum(np.minimum(slope(q), slope(d_0)), 0.0), 0.0)
            steep_d = -orbit.falling(q)[1]
            steep_d = np.where(closes, np.minimum(steep_d, (s.delta_0 + s.m.J_0 * rise * (d_0 - q)) / (d_0 - d)), steep_d)
            good &= orbit.pressed(c, q + TWO_PI, d_0 + TWO_PI, orbit.states[1]) >= 0
            apart = None
            highest = np.where(excess(d_0)[0] >= excess(d)[0], s.delta_0, np.inf)
            c_range, d_range = (c_0, c), (d, d_0)
            good &= (d_0 <= contact[0] + agree) & (contact[1] <= c_0 + agree)
        forcing = s.step, np.where(s.snaps, np.minimum(s.step, highest), s.step)
        r = responses(kernel, s, contact, c_range, d_range, forcing, True, apart=apart)
        on, off = steep_d - r[1, 1], steep_c - r[0, 0]
        return good & (on > 0) & (off > 0) & (on * off > r[0, 1] * r[1, 0])


def links(orbit: Forced, target: Forced, rising: bool) -> np.ndarray:
    """Whether all orbits that are free in the window of ``orbit`` (``rising``), or engaged outside of it, are so for that of
    ``target``.

    Rising, the contact imposed along the way begins as long behind the onset as that of ``orbit``: it need not be the true
    one."""
    s, kernel = orbit.s, orbit.kernel
    (d, b, a, c), (d_1, b_1, a_1, c_1) = orbit.edges, target.edges
    u, v = np.abs(c_1 - c), np.abs(d_1 - d)
    with np.errstate(all="ignore"):
        y_c, y_d = orbit.gaps()
        (_, steep_c), (least, greatest) = orbit.adhering(c_1), orbit.falling(d_1)
        room = np.stack((y_c - s.delta_0 - s.step, y_d - s.delta_0)) * (1 if rising else -1)
        if rising:
            none = a <= b
            contact, good = (
                (np.where(none, d_1, b), np.where(none, d_1, a)),
                (a <= c_1) & (c_1 <= c) & (d_1 >= d) & (none | (b + v <= a)),
            )
            force_c, lowest = s.step, s.step
            rate, lead = rates(s.m.beta), b - d
            z_b = orbit.states[2] * np.exp(-lead * rate)
            y_b = orbit.states[3].sum(axis=0) - kernel.profile(b, s.D)
            enters = y_b - s.step + np.minimum(0.0, chords(z_b, rate, b, b, b + v)[0] * v)
            moved = np.where(none, 0.0, lead), np.where(none, v, lead), np.where(none, 0.0, np.minimum(enters, 0.0))
        else:
            moved = None
            contact, good = (b_1, a_1), (c_1 >= c) & (d_1 <= d)
            force_c, lowest = np.where(c >= a_1, s.step, 0.0), y_d - np.maximum(0.0, greatest * v)
            good &= target.gaps()[1] + target.falling(d)[0] * v >= 0
        forcing = force_c, np.clip(lowest, 0.0, s.step)
        order = lambda x, y: (np.minimum(x, y), np.maximum(x, y))  # noqa: E731
        r = responses(kernel, s, contact, order(c, c_1), order(d, d_1), forcing, False, moved)
        left = room + np.stack((-steep_c * u, least * v)) + r[:, 0] * u + r[:, 1] * v
        return good & (room > 0).all(axis=0) & (left > 0).all(axis=0) & (c_1 > d_1) & (c_1 < d_1 + TWO_PI)


def linearised(orbit: Forced, rising: bool):
    """How far the gaps at release and onset are beyond what would make the window an orbit's, (2, N), and by how much less
    that is per growth of the window at either edge, (2, 2, N)."""
    s = orbit.s
    d, b, a, c = orbit.edges
    y_c, y_d = orbit.gaps()
    room = np.stack((y_c - s.delta_0 - s.step, y_d - s.delta_0)) * (1 if rising else -1)
    falls = -responses(orbit.kernel, s, (b, a), (c, c), (d, d), (s.step, s.jump_on), True)
    falls[[0, 1], [0, 1]] += orbit.adhering(c)[0], -orbit.falling(d)[0]
    return room, falls


def newton(room, falls):
    """Growth of a window by Newton's method, or away from where orbits have vanished."""
    (p, q), (r, t) = falls
    step = np.stack((t * room[0] - q * room[1], p * room[1] - r * room[0])) / (p * t - q * r)
    ahead, away = (step > 0).all(axis=0), (step < 0).all(axis=0)
    return np.where(ahead, step, np.where(away, -step, np.maximum(room, 0.0) / np.abs((p, t))))


def balanced(growth, room, falls, first):
    """The ``growth`` (2, N) of windows, of one edge corrected so that both gaps are beyond an orbit's: next to a fold that is
    so in a narrow strip only. ``first``: whether that edge is the release."""
    pick = lambda one, other: np.where(first, one, other)  # noqa: E731
    (p, q), (r, t) = falls
    own, other = pick(room[0], room[1]), pick(room[1], room[0])
    steep, response = pick(p, t), -pick(r, q)
    left = np.maximum(other + response * own / steep, 0.0)
    step = np.where(steep > 0, own / steep - 0.5 * left / (steep + response), 0.0)
    return growth + np.where(np.isfinite(step), step, 0.0) * np.stack((first, ~first))
