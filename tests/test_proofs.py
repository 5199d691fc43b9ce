"""What the fast proofs claim about orbits, against a dense scan of the onset map and against the search, on hanging and slow
strips."""

from dataclasses import replace

import numpy as np
import pytest

import hystrip
from hystrip.generated import standard_linear_solid as kernel
from hystrip.orbit import engine
from hystrip.orbit.certificate import STABLE, saturates
from hystrip.orbit.engine import solve_strips
from hystrip.orbit.groups import Strips, adhesive_cycle, snaps_in
from hystrip.orbit.march import Orbit, march
from hystrip.orbit.orbit_bounds import bounds_after_contact, is_extremal, least_engaged_bounds, orbit_bounds
from hystrip.orbit.regimes import CODE
from hystrip.orbit.search import Search, excludes
from hystrip.orbit.sensitivity import falls, slope_excess, slope_grows

SCANNED = 300


def made(alpha, beta, J, p_0, delta_0, D, steps) -> Strips:
    """Strips of these groups; ``steps``: whether w does, under the constitutive closure."""
    return Strips(alpha, beta, J, 1 - J, p_0, delta_0, D, steps.astype(float), steps & snaps_in(J * p_0, delta_0))


def strips(seed: int, n: int, where: str) -> Strips:
    """Random strips out of reach of the undeformed foundation (``hanging``), within it (``pressed``) or just able to stay in
    contact all along."""
    rng = np.random.default_rng(seed)
    beta = 10 ** rng.uniform(0, 6, n)
    alpha = beta / 10 ** rng.uniform(0.1, 4, n)
    ratio = np.hypot(1, beta) / np.hypot(1, alpha)
    delta_0, deep = 10 ** rng.uniform(-2.5, 1, n), rng.random(n) ** 2
    p_0 = ratio * 10 ** rng.uniform(-1, 0.5, n) if where == "saturated" else 10 ** rng.uniform(-1, 3, n)
    D = {
        "hanging": -delta_0 - deep * np.maximum(p_0 - delta_0, 0),
        "pressed": -delta_0 + deep * (1.1 * (1 + ratio) + delta_0),
        "saturated": 1 + ratio * (1 + 0.2 * deep) - p_0,
    }[where]
    J = alpha / beta
    return made(alpha, beta, J, p_0, delta_0, D, rng.random(n) < 0.5)


def known_orbits(s: Strips, unloading: bool):
    """Stable orbits with contact and discrete adhesion, the most engaged ones of their strips or not, with their cycles."""
    solved = solve_strips(kernel, s, unloading)
    index = np.flatnonzero(solved.code == CODE["acaf"])
    cycle = adhesive_cycle(kernel, s.take(index))
    zero, x = np.zeros(index.size), solved.d[index]
    return cycle, Orbit(x, solved.b[index], solved.a[index], solved.c[index], zero > 0, zero)


def holds_an_orbit(cycle):
    """Which cycles have an orbit with an onset, by the exhaustive search."""
    return Search(kernel, cycle, False, Orbit.blank(cycle.size), np.nan).run()[0]


def crossed_before(cycle, x):
    """The last onset before x from which the onset map goes back, NaN if there is none: an orbit lies before it or, engaged all
    along, beyond the arc."""
    low = cycle.centre - cycle.half_d
    shares = (np.arange(SCANNED) + 0.5) / SCANNED
    onsets = low + 0.999 * shares[:, None] * (x - low)
    orbit = march(kernel, cycle.take(np.tile(np.arange(cycle.size), SCANNED)), onsets.ravel())
    back = ~orbit.engaged & (orbit.r < -1e-12 * np.tile(1 + np.abs(cycle.strips.D), SCANNED))
    return np.fmax.reduce(np.where(back, onsets.ravel(), np.nan).reshape(SCANNED, -1))


def bounds_from_engaged(cycle):
    """Bounds from the orbit that would be engaged all along if gaps had no limit; NaN where that saturates."""
    s = cycle.strips
    without_limit = replace(s, delta_0=np.full(s.size, 1e12), snaps=np.zeros(s.size, bool))
    return bounds_after_contact(kernel, cycle, solve_strips(kernel, without_limit, True).a + STABLE, np.zeros(s.size))


def proven(cycle, orbit):
    """By bounds on all orbits: from the one that is engaged all along, and from the most engaged state."""
    found = (bounds_from_engaged(cycle), orbit_bounds(kernel, cycle, np.inf))
    return [falls(kernel, cycle, bounds, orbit) for bounds in found]


@pytest.mark.parametrize("where", ["hanging", "pressed"])
def test_the_first_orbit_is_proven_to_be_the_first(where):
    cycle, orbit = known_orbits(strips(1, 4000, where), unloading=True)
    assert np.isnan(crossed_before(cycle, orbit.x)).all()
    from_orbit, from_state = proven(cycle, orbit)
    assert from_orbit.mean() > 0.96 and from_state.mean() > 0.5


@pytest.mark.parametrize("closure", [0.0, 1.0], ids=["continuous", "constitutive"])
@pytest.mark.parametrize("where", ["pressed", "saturated"])
def test_no_orbit_is_more_engaged_than_one_without_a_limit_to_the_gap(where, closure):
    """The unloading orbit of strips that have an orbit that is free once per period, which may be another one."""
    s = strips(21, 12_000, where)
    s = made(s.alpha, s.beta, s.J, s.p_0, s.delta_0, s.D, np.full(s.size, closure > 0))
    low, high = (solve_strips(kernel, s, unloading) for unloading in (False, True))
    index = np.flatnonzero(np.isfinite(low.c))
    low, high, cycle = low.take(index), high.take(index), adhesive_cycle(kernel, s.take(index))
    bounds = bounds_from_engaged(cycle)
    onset = np.where(np.isnan(high.d), high.b, high.d)
    let_go = np.isfinite(high.c)
    assert bounds.engaged[~let_go].all()
    assert not (onset < bounds.x - 1e-12)[let_go].any()
    assert not ((high.a > bounds.a + 1e-12) | (high.c > bounds.c + 1e-12))[let_go].any()
    assert np.isnan(low.a).any() == (where == "pressed")
    assert np.count_nonzero(~bounds.engaged) > 4000 if where == "pressed" else np.count_nonzero(~let_go) > 150


def test_contact_ends_before_what_the_engine_says_of_all_orbits(monkeypatch):
    asked, is_extremal = [], engine.is_extremal

    def spied(kernel, cycle, orbit, bounds, last):
        asked.append((bounds.a - orbit.a)[np.isnan(bounds.x)])
        return is_extremal(kernel, cycle, orbit, bounds, last)

    monkeypatch.setattr(engine, "is_extremal", spied)
    for where in ("hanging", "pressed"):
        solve_strips(kernel, strips(31, 30_000, where), unloading=True)
    later = np.concatenate(asked)
    later = later[np.isfinite(later)]
    assert (later > 0).all() and np.count_nonzero(later < 0.1) > 5


@pytest.mark.parametrize("last", [False, True], ids=["unloading", "loading"])
@pytest.mark.parametrize("share", [0.3, 1e-2, 1e-4])
def test_no_interval_that_ends_at_an_orbit_is_excluded(share, last):
    """Near its zero r is nearly linear, so bounds of its slope reach nearly as far as that, and no further."""
    cycle, orbit = known_orbits(strips(11, 4000, "pressed"), unloading=not last)
    toward = 1 if last else -1
    end = cycle.centre + toward * cycle.half_d
    beside = march(kernel, cycle, orbit.x + share * (end - orbit.x))
    left, right = (orbit, beside) if last else (beside, orbit)
    some = np.flatnonzero(~beside.engaged & (toward * beside.r < 0))
    left, right, cycle = left.take(some), right.take(some), cycle.take(some)
    assert some.size > 300 and not excludes(kernel, cycle, left, right, last).any()


@pytest.mark.parametrize("faster", [1.0, 1e-4])
def test_hanging_strips_that_let_go_have_no_orbit_with_an_onset(faster):
    s = strips(7, 6000, "hanging")
    s = replace(s, alpha=faster * s.alpha, beta=faster * s.beta)
    # at the very end of the reach an orbit may graze it
    lets_go = np.flatnonzero((solve_strips(kernel, s, unloading=True).code == CODE["f"]) & (s.D < -s.delta_0))
    assert lets_go.size > 300 and not holds_an_orbit(adhesive_cycle(kernel, s.take(lets_go))).any()


def test_next_to_the_end_of_a_branch_no_orbit_out_of_reach_is_passed_over():
    """Strips that hang as low as an orbit with an onset allows, to a thousandth, and lower by up to a tenth."""
    s = strips(8, 12_000, "hanging")
    s = s.take(np.flatnonzero(solve_strips(kernel, s, unloading=True).code == CODE["acaf"]))
    high, low = s.D, -s.delta_0 - s.p_0
    for _ in range(10):
        middle = 0.5 * (low + high)
        there = solve_strips(kernel, replace(s, D=middle), unloading=True).code == CODE["acaf"]
        low, high = np.where(there, low, middle), np.where(there, middle, high)
    assert s.size > 800
    for lower in (0.0, 0.003, 0.01, 0.03, 0.1):
        lowered = replace(s, D=high - lower * (s.p_0 + np.abs(high)))
        lets_go = np.flatnonzero(solve_strips(kernel, lowered, unloading=True).code == CODE["f"])
        assert not holds_an_orbit(adhesive_cycle(kernel, lowered.take(lets_go))).any()
    assert lets_go.size > 150


def test_what_has_an_orbit_before_it_is_not_proven_to_have_none():
    """Strips that may be in saturated contact, and the orbits that let go in spite of it: unstable ones lie before them."""
    cycle, orbit = known_orbits(strips(3, 10_000, "saturated"), unloading=False)
    onset = crossed_before(cycle, orbit.x)
    before = ~np.isnan(onset)
    assert before.sum() > 40
    assert not any((by & before).any() for by in proven(cycle, orbit))


def test_a_contact_too_short_to_be_solved_for_is_not_passed_over():
    """D + p_0/K is a few roundings: the crest just touches and the gap adheres all along (50-digit march); a less engaged orbit
    coexists."""
    material = hystrip.StandardLinearSolid(K=0.021065902767355846, T_eps=1.8002651076084792, T_sigma=0.0003038996102107568)
    adhesion = hystrip.Dugdale(p_0=1.9953655684318486e-16, delta_0=1.8191057539334315e-08)
    where = {"l": 2.0953111151686212e-06, "A": 1.732077011229234e-09, "D": -9.472015467212293e-15, "V": 52.86112388009897}
    strip = hystrip.solve_strip(material, adhesion, **where)
    assert strip.regime == "ac"
    assert strip.p_mean == pytest.approx(-1.9953655684318486e-16, rel=1e-11)
    assert strip.contact_fraction < 1e-6 and strip.adhesion_fraction == pytest.approx(1, abs=1e-6)


def test_bounds_on_all_orbits_hold_for_strips_that_snap_into_contact():
    """For every onset that a foundation can come to that was free as the load harmonic rose through ``-p_0``."""
    s = strips(5, 4000, "pressed")
    s = made(s.alpha, s.beta, s.J, np.maximum(s.p_0, 1.001 * s.delta_0 / s.J), s.delta_0, s.D, np.ones(s.size, bool))
    s = s.take(np.flatnonzero((s.beta < 300) & ~saturates(kernel, s)))
    cycle = adhesive_cycle(kernel, s)
    assert cycle.direct.all()
    bounds = orbit_bounds(kernel, cycle, np.inf)
    index = np.flatnonzero(~bounds.engaged & (cycle.half_d > 0))
    cycle, s, seen = cycle.take(index), s.take(index), 0
    for share in (0.9, 0.5, 0.0, -0.5):
        x, first = cycle.centre - share * cycle.half_d, cycle.centre - cycle.half_b
        before = (kernel.profile(x, s.D) + s.delta_0) * np.exp((x - first) / s.beta)
        met = before >= kernel.profile(first, s.D) + s.delta_0
        orbit = march(kernel, cycle, x)
        assert not orbit.engaged[met].any()
        assert (orbit.a <= bounds.a[index] + 1e-9)[met].all() and (orbit.c <= bounds.c[index] + 1e-9)[met].all()
        seen += np.count_nonzero(met)
    assert seen > 200


def test_no_orbit_adheres_longer_than_the_one_that_is_not_let_go_and_none_touches_where_that_does_not():
    """Strips that would adhere all along without contact if gaps had no limit, ``D <= -p_0``, against the search."""
    rng = np.random.default_rng(41)
    n = 6000
    beta, J, p_0 = 10 ** rng.uniform(-3, 5, n), 10 ** rng.uniform(-6, -0.01, n), 10 ** rng.uniform(-4, 2, n)
    delta_0 = np.where(rng.random(n) < 0.5, 10 ** rng.uniform(-4, 0.3, n), J * p_0 * 10 ** rng.uniform(-1, 1, n))
    D = -p_0 - delta_0 * 10 ** rng.uniform(-6, 0, n) * rng.random(n)
    s = made(beta * J, beta, J, p_0, delta_0, D, rng.random(n) < 0.5)
    solved, cycle = solve_strips(kernel, s, True), adhesive_cycle(kernel, s)
    code, bounds = solved.code, orbit_bounds(kernel, cycle)
    assert np.isin(code, [CODE[regime] for regime in ("a", "af", "f")]).all() and np.count_nonzero(s.snaps) > 300
    index = np.flatnonzero(code != CODE["a"])
    assert (holds_an_orbit(cycle.take(index)) == (code[index] == CODE["af"])).all()
    let_go = code == CODE["af"]
    assert np.count_nonzero(let_go) > 500
    assert (solved.c <= bounds.c)[let_go].all() and (solved.d >= bounds.x - 1e-12)[let_go].all()
    assert np.count_nonzero((bounds.c - solved.c)[let_go] < 1e-4) > 100


def within_reach(seed: int, n: int) -> Strips:
    """Strips within reach of the undeformed foundation, infinitely slow to infinitely fast, without instantaneous compliance or
    relaxation among them, ranges of adhesion up to far beyond the profile."""
    rng = np.random.default_rng(seed)
    beta, J = 10 ** rng.uniform(-3, 6, n), np.where(rng.random(n) < 0.15, 0.0, 10 ** -rng.uniform(0, 4, n))
    J[rng.random(n) < 0.03] = 1.0
    p_0, delta_0, alpha = 10 ** rng.uniform(-2, 2.5, n), 10 ** rng.uniform(-3, 1.5, n), beta * J
    ratio = np.hypot(1, beta) / np.hypot(1, alpha)
    D = -delta_0 + rng.random(n) ** 2 * (delta_0 + 1.1 * (1 + ratio))
    return made(alpha, beta, J, p_0, delta_0, D, rng.random(n) < 0.5)


def test_every_orbit_within_reach_is_more_engaged_than_the_least_engaged_state():
    s = within_reach(1, 6000)
    cycle, n = adhesive_cycle(kernel, s), 0
    bounds, certain = least_engaged_bounds(kernel, cycle), cycle.touched
    for unloading in (True, False):
        solved = solve_strips(kernel, s, unloading)
        onset = np.where(np.isnan(solved.d), solved.b, solved.d)
        index = np.flatnonzero(np.isfinite(solved.c) & (s.D > -s.delta_0))
        here, solved, onset = bounds.take(index), solved.take(index), onset[index]
        assert not np.isinf(here.x).any() and not (onset > here.x + 1e-12).any()
        assert not (solved.c < here.c - 1e-12).any() and not (solved.a < here.a - 1e-12).any()
        assert not (np.isnan(solved.b) & certain[index]).any()
        n += index.size
    engaged = np.isin(solve_strips(kernel, s, False).code, [CODE["c"], CODE["ac"], CODE["a"]])
    assert n > 4000 and np.isinf(bounds.x[engaged]).mean() > 0.6


def test_the_map_leads_back_from_the_last_onset_and_its_slope_grows_up_to_it():
    s = within_reach(2, 3000)
    cycle = adhesive_cycle(kernel, s)
    cycle = cycle.take(np.flatnonzero((s.D > -s.delta_0) & (cycle.half_d > 0)))
    n = cycle.size
    last = cycle.centre + cycle.half_d
    first = last - 2 * cycle.half_d * np.random.default_rng(3).random(n)
    many, share = np.tile(np.arange(n), 40), np.linspace(0, 1, 40)[:, None]
    orbit = march(kernel, cycle.take(many), (first + share * (last - first)).ravel())
    with np.errstate(all="ignore"):
        slope = slope_excess(kernel, cycle.take(many), orbit)[0].reshape(40, n)
        grows = slope_grows(kernel, cycle, orbit.take(slice(0, n))) & ~orbit.engaged[:n]
        sinks = np.diff(slope, axis=0) < -1e-9 * (1 + np.abs(slope[1:]))
        # as far as an orbit may have its onset the map contracts
        bounds, within = least_engaged_bounds(kernel, cycle), orbit.x.reshape(40, n)
        inside = falls(kernel, cycle, orbit.take(slice(0, n)), bounds) & (within <= bounds.x)
    assert not (inside & (slope >= 1e-9)).any() and np.count_nonzero(inside) > 3000
    assert (orbit.r[-n:] < 0).all()
    # an orbit that does not meet contact where that is certain is none
    lost = np.isnan(orbit.b.reshape(40, n)[1:]) & cycle.touched
    assert not (sinks & ~lost)[:, grows].any()
    apart = (orbit.x[:n] < cycle.centre) | (orbit.c[:n] > cycle.centre + np.pi)
    assert np.count_nonzero(grows & apart) > 200 and np.count_nonzero(grows & ~apart) > 200


def test_on_loading_few_orbits_are_left_to_the_search():
    s = within_reach(4, 6000)
    solved = solve_strips(kernel, s, unloading=False)
    index = np.flatnonzero(np.isfinite(solved.c))
    cycle, solved = adhesive_cycle(kernel, s.take(index)), solved.take(index)
    zero, x = np.zeros(index.size), np.where(np.isnan(solved.d), solved.b, solved.d)
    orbit = Orbit(x, solved.b, solved.a, solved.c, zero > 0, zero)
    assert is_extremal(kernel, cycle, orbit, least_engaged_bounds(kernel, cycle), last=True).mean() > 0.93
