"""The claims that the choice of the extremal orbit rests on (``runtime/orbit/modes/windows.py``), on random states and windows,
and the orbits it leads to."""

from functools import cache

import numpy as np
import pytest

import hystrip
from hystrip.generated import generalised
from hystrip.inputs.model import modes_of
from hystrip.orbit.modes.engine import solve_modes
from hystrip.orbit.modes.extremal import in_order
from hystrip.orbit.modes.forced import Forced, chords
from hystrip.orbit.modes.march import CONTACT, march, zone_at
from hystrip.orbit.modes.problem import ModeStrips
from hystrip.orbit.modes.windows import alone, linearised, links, responses
from hystrip.orbit.regimes import SEQUENCES

# materials and orbits are had once
pytestmark = pytest.mark.xdist_group("windows")
TIMES = (2, 3)
N, MATERIALS = 1500, 500


@cache
def materials(n, kind):
    """Modes of foundations; ``fast``: the first time is so short that an onset is followed by contact almost at once; ``far``:
    times differ by eleven decades."""
    rng, size = np.random.default_rng(10 + n), MATERIALS
    tau_i = np.sort(_log(rng, 1e-9, 100, n, size) if kind == "far" else _log(rng, 0.01, 30, n, size), axis=0)
    if kind == "fast":
        tau_i[0] = _log(rng, 1e-5, 1e-3, size)
    K_i = _log(rng, 0.03, 300, n, size) if kind == "far" else _log(rng, 0.05, 30, n, size)
    return modes_of(generalised, {"K": np.ones(size), "K_i": K_i, "tau_i": tau_i})[1]


def _log(rng, low, high, *shape):
    return 10 ** rng.uniform(np.log10(low), np.log10(high), shape)


def strips(rng, n, size=N, kind=""):
    """Strips that are often engaged and often not, a third of them snapping into contact, on foundations of a ``kind``; ``snap``:
    on those with times far apart, and most snap."""
    kernel, far = generalised, kind in ("far", "snap")
    # each foundation bears several strips
    modes = materials(n, "far" if far else kind)
    modes = type(modes)(*(each[..., np.arange(size) % MATERIALS] for each in modes))
    P0 = _log(rng, 0.05, 20, size) if far else _log(rng, 0.05, 5, size)
    Delta = _log(rng, *{"far": (1e-3, 10), "snap": (1e-6, 0.1)}.get(kind, (0.03, 2)), size)
    m = kernel.at_speed(modes, np.ones(size))
    return kernel, ModeStrips(m, P0, Delta, rng.uniform(-1 - Delta, 3), m.J_0 * P0 >= Delta)


class Order:
    """Dashpot displacements e, in which a period preserves the order, and states z."""

    def __init__(self, kernel, s):
        self.kernel, self.m = kernel, s.m

    def to_z(self, e):
        return np.einsum("ij...,j...->i...", self.m.share, e)

    def to_e(self, z):
        return self.kernel.dashpots(z, 0.0, self.m)


def states(rng, s):
    """A state and one that is nowhere below it: engaged before free, then every dashpot displacement."""
    n, size = s.modes, s.size
    lower = rng.uniform(-2, 3, (n, size))
    # half of the pairs differ in one component only, and by little
    apart = 10 ** rng.uniform(-6, 0.5, (n, size)) * (rng.random((n, size)) < 0.5)
    engaged = rng.random(size) < 0.6
    return engaged, lower, engaged & (rng.random(size) < 0.6), lower + apart


@pytest.mark.parametrize("n", TIMES)
def test_a_period_preserves_the_order(n):
    rng = np.random.default_rng(n)
    kernel, s = strips(rng, n)
    order = Order(kernel, s)
    h, e, h_up, e_up = states(rng, s)
    start = rng.uniform(0, 2 * np.pi, N)
    one, two = (march(kernel, s, engaged, order.to_z(state), start) for engaged, state in ((h, e), (h_up, e_up)))
    assert not one.lost.any() and not two.lost.any()
    after, after_up = e + order.to_e(one.dz), e_up + order.to_e(two.dz)
    assert np.all(after <= after_up + 1e-12 * (1 + np.abs(after)))
    assert np.all(one.engaged | ~two.engaged)
    # the test has seen all there is: snap-ins, releases of one but not the other, ordered pairs that stay apart
    snaps = s.step >= s.delta_0
    assert snaps.sum() > N / 10 and (one.engaged & ~two.engaged).sum() > N / 400 and np.any(after < after_up - 1e-3)


def test_order_fails_where_a_free_state_lies_below_an_engaged_one():
    """The order's first part is needed: pairs with e ascending but the free one below are not preserved."""
    rng = np.random.default_rng(5)
    kernel, s = strips(rng, 2, 300)
    order = Order(kernel, s)
    e = rng.uniform(-2, 3, (2, s.size))
    start, held = np.full(s.size, np.pi), np.ones(s.size, bool)
    free, engaged = (march(kernel, s, h, order.to_z(state), start) for h, state in ((~held, e), (held, e + 1e-3)))
    assert np.any(order.to_e(free.dz) > 1e-3 + order.to_e(engaged.dz) + 1e-3)


def nested(rng, n, kind=""):
    """Forced orbits in random windows and in larger ones, with the growths (2, N) at release and onset."""
    kernel, s = strips(rng, n, N, kind)
    c, d = rng.uniform(0.6, 2.5, N), -rng.uniform(0.6, 2.5, N)
    grow = 10 ** rng.uniform(-4, -0.8, (2, N)) * (rng.random((2, N)) < 0.8)
    found = []
    for u, v in (np.zeros((2, N)), grow):
        edges = np.stack((d + v, np.clip(-0.3, d + v, c - u), np.clip(0.3, d + v, c - u), c - u))
        found.append(Forced.settled(kernel, s, edges))
    (inner, settled), (outer, too) = found
    kept = np.abs(np.stack((inner.edges[3] - c, outer.edges[3] - c + grow[0], inner.edges[0] - d, outer.edges[0] - d - grow[1])))
    known = settled & too & (kept.max(axis=0) < 1e-9) & (inner.edges[2] < outer.edges[3]) & (outer.edges[1] >= outer.edges[0])
    k = np.flatnonzero(known & (inner.gaps()[1] > 0))
    assert k.size > N / 10
    return inner.take(k), outer.take(k), grow[:, k]


@pytest.mark.parametrize(("n", "kind"), [*((n, "") for n in TIMES), (3, "fast")])
def test_forced_orbits_rise_with_their_windows_as_responses_bound(n, kind):
    """By no less than in the contact of the lower orbit, by no more than in that of the upper one."""
    inner, outer, (u, v) = nested(np.random.default_rng(30 + n), n, kind)
    kernel, s = inner.kernel, inner.s
    (d, b, a, c), (d_1, b_1, a_1, c_1) = inner.edges, outer.edges
    rates, fast = 1 / s.m.beta, kind == "fast"
    adhering = kernel.gap_after(a, c_1, inner.states[0], -s.p_0, s.D, s.m) + s.step  # y of the lower orbit
    free = kernel.gap_after(c, d_1 + 2 * np.pi, inner.states[1], 0.0, s.D, s.m)
    gained = np.stack(outer.gaps()) - np.stack((adhering, free))
    assert np.all(gained > -1e-9)
    lowest = np.minimum(s.step, np.maximum(np.minimum(free, inner.gaps()[1]), 0.0))
    clear = b > d_1  # contact of neither where the window grows
    least = responses(s, (b, a), ((c_1, c), (d, d_1)), (s.step, lowest), False)
    most = responses(
        s, (np.where(b_1 < a_1, b_1, d_1), np.where(b_1 < a_1, a_1, d_1)), ((c_1, c), (d, d_1)), (s.step, s.step), True
    )
    # the outer one is higher by its gap at most where it alone is free
    apart = outer.gaps()[1] - 0.5 * outer.falling(d)[0] * v
    closer = responses(
        s, (np.where(b_1 < a_1, b_1, d_1), np.where(b_1 < a_1, a_1, d_1)), ((c_1, c), (d, d_1)), (s.step, s.step), True,
        apart=apart,
    )  # fmt: skip
    low, high, higher = (r[:, 0] * u + r[:, 1] * v for r in (least, closer, most))
    assert (high < 0.99 * higher).sum() > (0 if fast else 5)
    slack = 1e-9 * (1 + np.abs(gained)) + (1e-6 if fast else 0) * rates.max(axis=0) / rates.max()
    assert np.all((low <= gained + slack)[:, b < a])
    assert np.all((gained <= high + slack)[:, clear | (b == a)])
    # the bounds are those of a first order: close where windows hardly differ
    near = (np.maximum(u, v) < 1e-3) & (np.maximum(u, v) > 0) & clear & (b < a)
    assert near.sum() > 5 and (fast or np.median((high / np.maximum(low, 1e-300))[:, near]) < 1.3)


def test_chords_are_bounded():
    rng = np.random.default_rng(40)
    amplitude, rate = rng.normal(0, 1, (3, N)), 10 ** rng.uniform(-2, 2, (3, N))
    start, at = rng.uniform(-2, 0, N), rng.uniform(0, 2, N)
    to = at + rng.uniform(-1, 1, N) * np.minimum(1.0, at - start)
    least, greatest = chords(amplitude, rate, start, at, to)
    value = lambda x: (amplitude * np.exp((start - x) * rate)).sum(axis=0) - np.cos(x)  # noqa: E731
    for share in np.linspace(0.01, 1, 50):
        chord = (value(at + share * (to - at)) - value(at)) / (share * (to - at))
        assert np.all(chord >= least - 1e-8) and np.all(chord <= greatest + 1e-8)


@cache
def orbits(n, kind, count=1500):
    """Strips with an orbit that is free once a period, extremal on one branch, and that orbit."""
    kernel, s = strips(np.random.default_rng(50 + n), n, count, kind)
    index, edges = [], []
    for unloading in (True, False):
        found = solve_modes(kernel, s, unloading)
        k = np.flatnonzero(np.isin(SEQUENCES[found.code], ("acaf", "afc", "af")) & found.certified)
        one, none = found.take(k), np.isnan(found.b[k])
        d = np.where(np.isnan(one.d), one.b, one.d)
        edges.append(np.stack((d, np.where(none, d, one.b), np.where(none, d, one.a), one.c)))
        index.append(k)
    s = s.take(np.concatenate(index))
    return s, Forced(kernel, s, in_order(np.concatenate(edges, axis=1)))


@pytest.mark.parametrize("rising", [True, False])
@pytest.mark.parametrize(("n", "kind"), [*((n, "") for n in TIMES), (3, "far"), (3, "snap")])
def test_what_hides_an_orbit_is_never_proven(n, kind, rising):
    """An orbit is not alone where the window of a forced one, on the other side of it than it seems, tells of one between; and no
    link leads past an orbit."""
    s, orbit = orbits(n, kind)
    rng, rounds = np.random.default_rng(60 + n), 8 if kind else 16
    # every orbit in each round, all at once: most of the time of a call does not depend on how many there are
    orbit = orbit.take(np.tile(np.arange(s.size), rounds))
    s, (d, _, _, c) = orbit.s, orbit.edges
    # a share of the time that it is free, or engaged, from both its ends
    part = rng.random(s.size)
    total = 0.98 * 10 ** rng.uniform(-6, 0, s.size) * (d + 2 * np.pi - c if rising else c - d)
    away = np.stack((part, 1 - part)) * total
    sign = 1 if rising else -1
    window = d - sign * away[1], c + sign * away[0]
    guess = np.stack((window[0], *np.clip(orbit.edges[1:3], *window), window[1]))
    bound, known = Forced.settled(orbit.kernel, s, guess)
    known &= np.abs(bound.edges[[0, 3]] - window).max(axis=0) < 1e-9
    beyond, _ = linearised(bound, rising)
    between = known & (beyond < 0).all(axis=0)
    proven = known & alone(orbit, window, bound.edges[1:3], rising, 1e-7)
    assert not (between & proven).any()
    for reach in (0.3, 1 + 10 ** rng.uniform(-6, 0, s.size)):
        u, v = sign * away * (1 - reach)
        ends = d - v, c + u
        target, good = Forced.settled(orbit.kernel, s, np.stack((ends[0], *np.clip(orbit.edges[1:3], *ends), ends[1])))
        good &= known & links(bound, target, rising) & (np.abs(target.edges[[0, 3]] - ends).max(axis=0) < 1e-9)
        if np.ndim(reach):
            assert not (good & (sign * u < -1e-9)).any()
        else:
            linked = good
    assert (kind or between.sum() > 5) and proven.sum() > 1000 and linked.sum() > 1000


@pytest.mark.parametrize("n", TIMES)
def test_plain_iteration_ends_at_the_returned_orbits(n):
    """From far below and far above, period after period: the map alone, without bounds, candidates or boundary equations."""
    rng = np.random.default_rng(20 + n)
    kernel, s = strips(rng, n, 200)
    order = Order(kernel, s)
    start = np.full(s.size, np.pi)
    settled_in_all = 0
    for unloading in (True, False):
        solved = solve_modes(kernel, s, unloading)
        assert solved.certified.all()
        engaged = np.full(s.size, unloading)
        z = order.to_z(np.full((n, s.size), -30.0 if unloading else 30.0))
        contact, adhesion, settled = np.zeros(s.size), np.zeros(s.size), np.zeros(s.size, bool)
        left = np.arange(s.size)
        for _ in range(160):
            period = march(kernel, s.take(left), engaged[left], z[:, left], start[left])
            # iteration contracts: what moved this little is there, and need not be followed any further
            still = (np.abs(period.dz).max(axis=0) < 1e-10) & (period.engaged == engaged[left])
            engaged[left], z[:, left] = period.engaged, z[:, left] + period.dz
            onset, entry, leaves, release = period.edges
            touched = np.mod(leaves - entry, 2 * np.pi) / (2 * np.pi)
            all_along = zone_at(kernel, s.take(left), engaged[left], z[:, left], start[left])[0] == CONTACT
            held = np.where(
                period.never_free, 1.0, np.where(period.never_engaged, 0.0, np.mod(release - onset, 2 * np.pi) / (2 * np.pi))
            )
            touched = np.where(np.isnan(touched), np.where(period.never_free & all_along, 1.0, 0.0), touched)
            contact[left[still]], adhesion[left[still]] = touched[still], (held - touched)[still]
            settled[left[still]] = True
            left = left[~still]
            if not left.size:
                break
        off = np.maximum(np.abs(contact - solved.contact_fraction), np.abs(adhesion - solved.adhesion_fraction))
        assert np.flatnonzero(settled & (off > 1e-6)).tolist() == []
        assert {"acaf", "ac", "f", "afc"} <= set(SEQUENCES[solved.code[settled]])
        settled_in_all += settled.sum()
    assert settled_in_all > 0.8 * 2 * s.size


def test_next_to_where_orbits_vanish_nothing_is_refused():
    """Ever closer to where unloading lets go of a strip on three times: below it, iterates pass by the place of the orbits that
    have vanished ever more slowly, and no link of windows leads past it. Nothing touches there; above, adhesion holds a while."""
    moduli, times = [5.44134255e10, 1.5198808e10, 8.79312096e10], [5.3902384e-5, 9.85717043e-5, 7.69386906e-2]
    material, adhesion = hystrip.Prony(1.12859266e10, moduli, times), hystrip.Dugdale(p_0=633.854681, delta_0=8.01046486e-08)
    given = {"l": 1.10813026e-06, "A": 1.19878806e-07, "V": 4.94028286e-06, "edge": "constitutive"}
    low, high = -8.28e-8, -8.26e-8
    while high - low > 1e-21:
        D = np.linspace(low, high, 16)
        regime = hystrip.solve_strip(material, adhesion, D=D, **given).regime.tolist()
        free = regime.count("f")
        assert 0 < free < 16 and regime == free * ["f"] + (16 - free) * ["af"]
        low, high = D[free - 1 : free + 1]
