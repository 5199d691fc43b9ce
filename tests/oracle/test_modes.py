"""The reference march with several times against the one for a single time, quadrature, the energy balance and plain marching."""

import random

import pytest
from mpmath import mp

from . import march, modes
from .test_march import detachment, groups

BRANCHES = ("unloading", "loading")
MEANS = ("p_mean", "tau_mean", "contact_fraction", "adhesion_fraction")

# (theta, m, P0, Delta, delta), with a free part: discrete adhesion, snap-in, adhesion without contact
SCENES = {
    "acaf": ((0.3, 4.0), (2.0, 5.0), 1.5, 0.4, 0.2),
    "afc": ((0.5, 3.0, 20.0), (0.5, 0.3, 0.2), 1.5, 0.4, 0.3),
    "af": ((0.1, 1.0), (3.0, 1.0), 0.5, 0.8, -0.75),
}


@pytest.mark.parametrize("seed", range(20))
@pytest.mark.parametrize("split", [None, (0.25, 0.75)], ids=["one", "two equal times"])
def test_one_time_is_the_single_time(seed, split):
    rng = random.Random(seed)
    alpha, beta, P0, Delta, delta = groups(rng)
    alpha = alpha or 0.01
    for branch in BRANCHES:
        with mp.workdps(march.DIGITS + 10):
            m = mp.mpf(beta) / mp.mpf(alpha) - 1
            parts = [m] if split is None else [m * share for share in split]
        one = march.solve(alpha, beta, P0, Delta, delta, "constitutive", branch)
        many = modes.solve([alpha] * len(parts), parts, P0, Delta, delta, branch)
        assert one.sequence == many.sequence
        for name in MEANS:
            assert abs(getattr(one, name) - getattr(many, name)) < 1e-40
        assert one.edges.keys() == many.edges.keys()
        for name, value in one.edges.items():
            turns = (value - many.edges[name]) / (2 * mp.pi)
            assert abs(turns - mp.nint(turns)) < 1e-40


def fields(strip, zones):
    """(start, end, p, w, e) of each zone, functions of the phase."""
    for zone in zones:

        def e(s, zone=zone):
            return modes.advance(strip, zone.letter, zone.start, zone.e, s)

        def p(s, zone=zone, e=e):
            if zone.letter == "c":
                f = strip.foundation
                return strip.u(s) + mp.fsum(m * (strip.u(s) - each) for m, each in zip(f.m, e(s), strict=True))
            return -strip.P0 if zone.letter == "a" else mp.zero

        def w(s, p=p, e=e):
            f = strip.foundation
            return f.J * (p(s) + mp.fsum(m * each for m, each in zip(f.m, e(s), strict=True)))

        yield zone.start, zone.end, p, w, e


@pytest.mark.parametrize("scene", SCENES.values(), ids=SCENES)
def test_means_by_quadrature_and_energy_balance(scene):
    theta, m, P0, Delta, delta = scene
    with mp.workdps(40):
        strip = modes.ModesStrip(modes.Foundation(theta, m), P0, Delta, delta)
        zones, _, _ = modes.extremal(strip, "unloading")
        found = modes.solve(*scene, "unloading", digits=20)
        assert "f" in found.sequence and "a" in found.sequence
        pressure = friction = loss = mp.zero
        for start, end, p, w, e in fields(strip, zones):
            pressure += mp.quad(p, [start, end])
            friction += mp.quad(lambda s, p=p: -p(s) * mp.sin(s), [start, end])
            for i, (modulus, time) in enumerate(zip(strip.foundation.m, strip.foundation.theta, strict=True)):
                lag = lambda s, w=w, e=e, i=i: (w(s) - e(s)[i]) ** 2  # noqa: E731
                loss += modulus / time * mp.quad(lag, [start, end])
        assert abs(found.p_mean - pressure / (2 * mp.pi)) < 1e-25
        assert abs(found.tau_mean - friction / (2 * mp.pi)) < 1e-25
        assert abs(friction - loss - detachment(strip.P0, strip.Delta, 1 / strip.J)) < 1e-24


@pytest.mark.parametrize("seed", range(12))
def test_extremal_orbits_are_where_plain_iteration_ends(seed):
    """Period after period from far below and far above every state, without acceleration or Newton's method."""
    rng = random.Random(seed)
    theta, m = sorted(rng.uniform(0.1, 2) for _ in range(2)), [rng.uniform(0.2, 3) for _ in range(2)]
    P0, Delta, delta = rng.uniform(0.05, 3), rng.uniform(0.05, 1), rng.uniform(-1.5, 2)
    for branch in BRANCHES:
        found = modes.solve(theta, m, P0, Delta, delta, branch, digits=30)
        with mp.workdps(20):
            strip = modes.ModesStrip(modes.Foundation(theta, m), P0, Delta, delta)
            engaged = branch == "unloading"
            e = mp.matrix([-20 if engaged else 20] * 2)
            for _ in range(200):
                zones, engaged, after, _, _ = modes.period(strip, engaged, e, +mp.pi)
                moved, e = mp.norm(after - e, mp.inf), after
                if moved < 1e-13:
                    break
            assert moved < 1e-13
            contact = sum(zone.end - zone.start for zone in zones if zone.letter == "c") / (2 * mp.pi)
            assert abs(contact - found.contact_fraction) < 1e-9
            assert {zone.letter for zone in zones} == set(found.sequence)


def test_answers_do_not_depend_on_the_digits():
    scene = (2e-3, 1.0, 5e8), (3.0, 10.0, 0.5), 3.0, 0.02, -0.5
    short, long = modes.solve(*scene, digits=30), modes.solve(*scene, digits=60)
    assert short.sequence == long.sequence
    assert abs(short.tau_mean - long.tau_mean) < 1e-20
