"""The oracle against plain marching, quadrature, energy balances and closed forms."""

import itertools
import math
import random

import pytest
from mpmath import mp

from . import march
from .flow import GapFlow, Strip
from .naive import Naive
from .orbits import extremal_orbit
from .passage import RETURNED, ReturnMap

CLOSURES, BRANCHES = ("continuous", "constitutive"), ("unloading", "loading")

# (alpha, beta, P0, Delta, delta), with a free part: discrete adhesion, snap-in, adhesion without contact
SCENES = {
    "acaf": (0.3, 2.0, 1.5, 0.4, 0.2),
    "afc": (1.0, 3.0, 1.2, 0.3, 0.3),
    "af": (0.1, 0.8, 0.5, 0.8, -0.75),
}


def log_uniform(rng, low, high):
    return 10 ** rng.uniform(math.log10(low), math.log10(high))


def groups(rng, widest=1.0):
    """A random strip; with ``widest`` = 1 one that plain marching can settle in a few hundred periods."""
    alpha = rng.choice((0.0, *[log_uniform(rng, 0.03 / widest, 3 * widest)] * 9))
    beta = alpha + log_uniform(rng, 0.03 / widest, 3 * widest)
    P0, Delta = log_uniform(rng, 0.03, 10 * widest), log_uniform(rng, 0.03, 3)
    return alpha, beta, rng.choice((0.0, *[P0] * 9)), Delta, rng.uniform(-2 - Delta - 0.3 * P0, 3)


@pytest.mark.parametrize("seed", range(40))
def test_extremal_orbits_are_where_plain_marching_ends(seed):
    rng = random.Random(seed)
    strip, closure = groups(rng), rng.choice(CLOSURES)
    for branch in BRANCHES:
        found = march.solve(*strip, closure, branch)
        zones = Naive(*strip, closure).orbit(branch)
        letters = "".join(zone[0] for zone in zones)
        assert found.sequence in {letters[i:] + letters[:i] for i in range(len(letters))}
        for letter, fraction in (("c", found.contact_fraction), ("a", found.adhesion_fraction)):
            marched = sum(end - start for name, start, end, _ in zones if name == letter) / (2 * math.pi)
            assert marched == pytest.approx(float(fraction), abs=1e-8)


def fields(strip, orbit):
    """(start, end, w, p) of each zone of an orbit with a free part."""
    for letter, start, end in orbit.zones:
        if letter == "c":
            yield start, end, strip.u, orbit.contact.p
            continue
        before = next(zone[0] for zone in orbit.zones if mp.almosteq(mp.cos(zone[2] - start), 1))
        w = strip.u(start)
        if before != "c":
            w += strip.Delta + (strip.step if letter == "f" else -strip.step)
        traction = strip.P0 if letter == "a" else mp.zero
        yield start, end, GapFlow(strip, start, w, traction).w, lambda s, traction=traction: -traction


@pytest.mark.parametrize("closure", CLOSURES)
@pytest.mark.parametrize("scene", SCENES.values(), ids=SCENES)
def test_means_by_quadrature_and_energy_balance(scene, closure):
    with mp.workdps(40):
        strip = Strip(*scene, closure)
        orbit = extremal_orbit(strip, "unloading")
        found = march.solve(*scene, closure, digits=40)
        assert "f" in found.sequence and "a" in found.sequence
        pressure = friction = loss = mp.zero
        for start, end, w, p in fields(strip, orbit):
            pressure += mp.quad(p, [start, end])
            friction += mp.quad(lambda s, p=p: -p(s) * mp.sin(s), [start, end])
            loss += mp.quad(lambda s, p=p, w=w: (p(s) - w(s)) ** 2, [start, end]) / strip.beta
        assert abs(found.p_mean - pressure / (2 * mp.pi)) < 1e-30
        assert abs(found.tau_mean - friction / (2 * mp.pi)) < 1e-30
        branch = loss / (1 - strip.J)  # dashpot of the Kelvin element behind the glassy spring 1/J
        if closure == "continuous":
            d, c = -found.edges["d"], found.edges["c"]
            branch -= strip.J * strip.P0 / (1 - strip.J) * (strip.u(d) - strip.u(c))
        else:
            branch += detachment(strip.P0, strip.Delta, 1 / strip.J)
        assert abs(friction - branch) < 1e-30


def detachment(P0, Delta, stiffness):
    """Work lost in one snap in and out of contact over a spring."""
    if P0 >= stiffness * Delta:
        return P0 * Delta + P0**2 / (2 * stiffness) - stiffness * Delta**2 / 2
    return P0**2 / stiffness


@pytest.mark.parametrize("P0, Delta", [(1.5, 0.4), (0.3, 0.4)])
def test_elastic_strip_loses_what_its_snaps_lose(P0, Delta):
    found = march.solve(0.7, 0.7, P0, Delta, -0.2, "constitutive", "loading")
    assert "f" in found.sequence
    with mp.workdps(march.DIGITS):
        lost = detachment(mp.mpf(P0), mp.mpf(Delta), 1)
        assert abs(found.tau_mean - lost / (2 * mp.pi)) < 1e-40


def test_saturated_contact():
    found = march.solve(0.25, 4.0, 1.0, 0.5, 4.0)
    assert (found.sequence, found.edges) == ("c", {})
    assert found.tau_mean == pytest.approx((4.0 - 0.25) / (2 * (1 + 0.25**2)))
    assert found.p_mean == 3 and found.contact_fraction == 1


def test_local_pressure_is_the_limit_of_small_alpha():
    scene = 2.0, 0.5, 0.4, 0.2
    limit, near = march.solve(0.0, *scene), march.solve(1e-12, *scene)
    assert limit.sequence == near.sequence == "acaf"
    assert float(near.p_mean - limit.p_mean) == pytest.approx(0, abs=1e-10)


@pytest.mark.parametrize("seed", range(40))
def test_passages_are_monotone_and_their_slopes_bounded(seed):
    """The claims that the search for fixed points rests on: order of the events, slope of Y, bounds of the slope."""
    rng = random.Random(seed)
    with mp.workdps(40):
        returns = ReturnMap(Strip(*groups(rng, widest=30), rng.choice(CLOSURES)))
        if returns.onset is None or returns.release is None:
            return
        low, high = returns.onset
        onsets = sorted(low + (high - low) * rng.random() for _ in range(6))
        items = [item for item in map(returns.passage, onsets) if item.outcome == RETURNED]
        for first, second in itertools.pairwise(items):
            assert first.length >= second.length and first.c >= second.c and first.next <= second.next
            below, above = returns.advance_slope_bounds(first, second)
            for item in (first, second):
                assert below <= returns.advance_slope(item) <= above
            step = (second.d - first.d) * mp.mpf("1e-12")
            after = returns.passage(first.d + step)
            if after.outcome == RETURNED and (after.b is None) == (first.b is None):
                measured = (returns.advance(after) - returns.advance(first)) / step
                slope = returns.advance_slope(first)
                assert abs(measured - slope) < 1e-5 * (1 + abs(slope))


@pytest.mark.parametrize("closure", CLOSURES)
def test_answers_do_not_depend_on_the_digits(closure):
    scene = 2e3, 5e8, 3.0, 0.02, -0.5
    short, long = march.solve(*scene, closure, digits=40), march.solve(*scene, closure, digits=80)
    assert short.sequence == long.sequence
    assert abs(short.tau_mean - long.tau_mean) < 1e-20
