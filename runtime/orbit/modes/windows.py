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

From d - v on the lower orbit has ``w >= u``: the upper one, free there, is higher by its gap y at most, and deviations fade no
less than in contact. Where contact follows the onset closely that is the better bound (``apart``). The gap is a known curve, or
from above ``delta_0`` and what responses make of it.

*Alone* (``alone``). Let all orbits be free in [c_0, d_0], and the orbit in [c, d], which is larger. Let the first orbit be
free from c + u to d - v. At c + u the orbit, had it stayed engaged, would be beyond the release by s_c u at least, where s_c
bounds the chords of a known curve; the other is not beyond it. So ``s_c u <= r_cc u + r_cd v``, likewise at d. If the
diagonal and the determinant of ``A = diag(s) - r`` are positive, A is an M-matrix, ``A (u, v) <= 0`` means u = v = 0, and the
orbit is the first. From above the same holds, u and v being growths; the orbit, had it stayed free behind d, may close its
gap: then ``w = u + max(y, 0)`` bounds the others, also those with another free part there.

*Links* (``links``). Let all orbits be free in a window, and gaps along F be beyond an orbit's at c and at d, strictly, for
all windows on a straight way to a larger one. Then all orbits are free in that one: at the last that is within an orbit's,
the orbit is released before c and engaged after d. Along the way these gaps are no less than linear ones, so the far end
decides. From above likewise. There a contact that lasts up to c may last on, and y stays below ``J_0 p_0`` as its curve tells;
and gaps may close in their windows if that of F is too small to open again (pressures move y by ``1/J_0`` of it). Links are as
long as Newton's steps: next to a fold, where the map from window to window hardly moves, each halves the way.
"""

import numpy as np

from hystrip.generated.modes import across, sandwich

from ...numerics.linear import solve_each
from ..groups import TWO_PI
from .forced import Forced, chords
from .problem import ModeStrips, rates


def responses(s: ModeStrips, contact, ends, forcing, upper: bool, moved=None, apart=None):
    """Bounds (2, 2, N) of what y gains at release and onset, per growth of the window at either, by steps ``forcing`` of w.

    ``contact``: its first and last phase; ``ends``: ranges of the edges c and d. ``moved``: where the contact moves with the
    onset, the time between, and what w gains where it begins. ``apart``: by how much w is higher on average, at most, where the
    window grew at its onset."""
    (b, a), ((c_1, c_2), (d_1, d_2)), n = contact, ends, s.modes
    # no contact: as one of no length, where what the edges did to fast modes is forgotten
    none = b >= a
    b, a = (np.where(none, 0.5 * (d_2 + c_1), edge) for edge in contact)
    rate, kicks = rates(s.m.beta), s.m.J * rates(s.m.beta) / s.m.J_0
    back = 1 + s.m.S[:, None] * s.m.enter  # the dashpots of every z by itself, without load

    def sums(matrix, amplitudes, short, long):
        near, far = (amplitudes * np.exp(-np.maximum(t, 0.0) * rate) for t in ((short, long) if upper else (long, short)))
        rising, falling = np.maximum(matrix, 0.0), np.minimum(matrix, 0.0)
        return np.maximum(across(rising, near) + across(falling, far), 0.0)

    share, one = np.swapaxes(s.m.share, 0, 1), np.ones((n, s.size))
    rows = sums(share, one, c_1 - a, c_2 - a), sums(share, one, d_1 + TWO_PI - a, d_2 + TWO_PI - a)
    soonest, latest, shift = b - d_2, b - d_1, 0.0
    if moved is not None:
        soonest, latest, shift = np.where(none, (soonest, latest, 0.0 * b), (moved[0], moved[0], d_2 - d_1))
    columns = [
        forcing[0] * sums(back, kicks, b + TWO_PI - c_2, b + shift + TWO_PI - c_1),
        forcing[1] * sums(back, kicks, soonest, latest),
    ]
    if apart is not None:
        fills = -np.expm1(-(d_2 - d_1) * rates(s.m.alpha))  # the dashpots, in the contact of the lower orbit
        fills = np.divide(fills, d_2 - d_1, out=rates(s.m.alpha) * np.ones_like(fills), where=d_2 > d_1)
        z = across(s.m.share, apart * fills) * np.exp(-np.maximum(soonest, 0.0) * rate)
        columns[1] = np.minimum(columns[1], across(back, z))
    if moved is not None:
        columns[1] = np.maximum(columns[1] + moved[1] * across(back, kicks), 0.0)
    # what a period forgets: small where foundations are slow, so it is added up by itself
    fade = np.expm1(-(a - b) * rates(s.m.alpha))
    matrix = -(1 + fade)[:, None] * sandwich(back, np.expm1((a - b - TWO_PI) * rate), s.m.share)
    matrix[range(n), range(n)] -= fade
    x = solve_each(matrix.transpose(2, 0, 1), ((1 + fade) * np.stack(columns)).transpose(2, 1, 0))
    r = np.einsum("kiN,Nij->kjN", np.stack(rows), x)
    between = d_1 + TWO_PI - c_2 if upper else d_2 + TWO_PI - c_1
    r[1, 0] += forcing[0] * (kicks * np.exp(-np.maximum(between, 0.0) * rate)).sum(axis=0)
    return r


def alone(orbit: Forced, window, contact, rising: bool, agree: float) -> np.ndarray:
    """Whether no orbit lies between ``orbit`` and those that are free in the ``window`` (d, c) (``rising``), or engaged outside
    of it and in contact in ``contact`` (b, a) at least. Where it is within by no more than ``agree``, it is as if at its edge.

    From above the chord behind c may lead into the contact, where y is ``J_0 p_0`` less J_0 times the excess pressure: that
    rises to one peak, and its slope is concave where the harmonic part falls (``contact``)."""
    kernel, s = orbit.kernel, orbit.s
    (d, b, a, c), (d_0, c_0) = orbit.edges, window
    sign = 1.0 if rising else -1.0
    good = (sign * (c - c_0) <= agree) & (sign * (d_0 - d) <= agree)
    c_0, d_0 = (np.maximum(c_0, c), np.minimum(d_0, d)) if rising else (np.minimum(c_0, c), np.maximum(d_0, d))
    with np.errstate(all="ignore"):
        if rising:
            (least, greatest), steep_c = orbit.falling(d_0), orbit.adhering(c_0)[0]
            steep_d, apart = -greatest, s.delta_0 - 0.5 * least * (d - d_0)
            contact, highest = (b, a), s.step
        else:
            excess = lambda phase: orbit.excess(np.clip(phase, b, a))  # noqa: E731
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
            good &= (d_0 <= contact[0] + agree) & (contact[1] <= c_0 + agree)
        forcing = s.step, np.where(s.snaps, np.minimum(s.step, highest), s.step)
        ends = ((c, c_0), (d_0, d)) if rising else ((c_0, c), (d, d_0))
        r = responses(s, contact, ends, forcing, True, apart=apart)
        if not rising:
            apart = s.delta_0 + r[1, 0] * u + r[1, 1] * (d_0 - d)
            r = responses(s, contact, ends, forcing, True, apart=apart)
        on, off = steep_d - r[1, 1], steep_c - r[0, 0]
        return good & (on > 0) & (off > 0) & (on * off > r[0, 1] * r[1, 0])


def links(orbit: Forced, target: Forced, rising: bool) -> np.ndarray:
    """Whether all orbits free in the window of ``orbit`` (``rising``), or engaged outside of it, are so for that of ``target``.

    Rising, the imposed contact begins as long behind the onset all along: it need not be the true one."""
    s, kernel = orbit.s, orbit.kernel
    (d, b, a, c), (d_1, b_1, a_1, c_1) = orbit.edges, target.edges
    u, v = np.abs(c_1 - c), np.abs(d_1 - d)
    with np.errstate(all="ignore"):
        y_c, y_d = orbit.gaps()
        (_, steep_c), (least, greatest) = orbit.adhering(c_1), orbit.falling(d_1)
        room = np.stack((y_c - s.delta_0 - s.step, y_d - s.delta_0)) * (1 if rising else -1)
        if rising:
            none = a <= b
            contact, good = (b, a), (a <= c_1) & (c_1 <= c) & (d_1 >= d) & (none | (b + v <= a))
            force_c, lowest = s.step, s.step
            rate, lead = rates(s.m.beta), b - d
            z_b = orbit.states[2] * np.exp(-lead * rate)
            y_b = orbit.states[3].sum(axis=0) - kernel.profile(b, s.D)
            enters = y_b - s.step + np.minimum(0.0, chords(z_b, rate, b, b, b + v)[0] * v)
            rise = steep_c * u
            moved = lead, np.where(none, 0.0, np.minimum(enters, 0.0))
        else:
            moved = None
            contact, good = (b_1, a_1), (c_1 >= c) & (d_1 <= d)
            z_c = orbit.states[1]
            open_ = np.minimum(z_c, z_c * np.exp(-u * rates(s.m.beta))).sum(axis=0)
            open_ = open_ - np.maximum(kernel.profile(c, s.D), kernel.profile(c_1, s.D))
            held = (a >= c) & (c > -np.arctan2(kernel.loss(s.m), kernel.storage(s.m)))
            touching = s.delta_0 - s.m.J_0 * np.minimum(orbit.excess(c)[1], orbit.excess(c_1)[1]) * u
            rise = np.where(held, np.minimum(steep_c * u, touching), steep_c * u)
            force_c = np.where(c >= a_1, s.step, np.clip(open_, 0.0, s.step))
            lowest = y_d - np.maximum(0.0, greatest * v)
            good &= (target.gaps()[1] + target.falling(d)[0] * v >= 0) | (y_d < s.m.J_0 * s.delta_0)
        forcing = force_c, np.clip(lowest, 0.0, s.step)
        r = responses(s, contact, np.sort(((c, c_1), (d, d_1)), axis=1), forcing, False, moved)
        left = room + np.stack((-rise, least * v)) + r[:, 0] * u + r[:, 1] * v
        return good & (room > 0).all(axis=0) & (left > 0).all(axis=0) & (c_1 > d_1) & (c_1 < d_1 + TWO_PI)


def linearised(orbit: Forced, rising: bool):
    """How far the gaps at release and onset are beyond what would make the window an orbit's, (2, N), and by how much less
    that is per growth of the window at either edge, (2, 2, N)."""
    s, kernel = orbit.s, orbit.kernel
    d, b, a, c = orbit.edges
    y_c, y_d = orbit.gaps()
    room = np.stack((y_c - s.delta_0 - s.step, y_d - s.delta_0)) * (1 if rising else -1)
    jump = np.where(s.snaps, s.delta_0, s.step)  # of w at an onset: the whole gap where the point snaps into contact
    falls = -responses(s, (b, a), ((c, c), (d, d)), (s.step, jump), True)
    slope = lambda at, start, z, p: kernel.gap_event(at, *kernel.gap_entry(start, z, p, s.D, s.m))[1]  # noqa: E731
    steep_c = np.where(a < c, slope(c, a, orbit.states[0], -s.p_0), -s.m.J_0 * orbit.excess(c)[1])
    falls[[0, 1], [0, 1]] += steep_c, -slope(d + TWO_PI, c, orbit.states[1], 0.0)
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
