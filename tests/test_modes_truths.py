"""Strips with two to fifteen relaxation times against the 50-digit march; ``tools/modes.py`` does hundreds."""

import mode_scenes as ms
import numpy as np
import pytest


@pytest.mark.parametrize("wide", [False, True], ids=["near 1", "wide"])
@pytest.mark.parametrize("n, count, regimes", [(2, 10, 4), (3, 8, 4), (8, 3, 2), (15, 2, 2)])
def test_random_strips(n, count, regimes, wide):
    """To 1e-11 of the natural scales, more only as far as rounding of the inputs demands it."""
    rng = np.random.default_rng((8, n, wide))
    scenes = [ms.draw(rng, n, wide) for _ in range(count)]
    sequences, errors = set(), []
    for branch in ms.BRANCHES:
        with np.errstate(over="raise", divide="raise", invalid="raise"):
            found = ms.solve(scenes, branch)
        for i, scene in enumerate(scenes):
            error, allowed, sequence = ms.compare(scene, branch, found, i)
            assert error <= allowed, (scene, branch)
            sequences.add(sequence)
            errors.append(error)
    assert np.median(errors) < 1e-14
    assert len(sequences) >= regimes


@pytest.mark.parametrize("seed, place, branch, adhesion", [(12, 32, "unloading", 1e11), (3007, 31, "loading", 0.0)])
def test_contact_all_along_but_for_a_thousandth_of_the_period(seed, place, branch, adhesion):
    """With adhesion a trillion times its range a march from the orbit next to it loses its edges to rounding; with hardly any,
    marches from above leave edges from which Newton's method does not converge."""
    rng = np.random.default_rng((seed, 8, True))
    scene = [ms.draw(rng, 8, True) for _ in range(place + 1)][-1]
    assert scene["P0"] > adhesion * scene["Delta"]
    found = ms.solve([scene], branch)
    error, allowed, sequence = ms.compare(scene, branch, found, 0)
    assert error <= allowed and sequence == "ac" and 0 < found.adhesion_fraction[0] < 1e-3


@pytest.mark.parametrize("materials", [1000, 60, 40])
def test_an_orbit_beyond_one_that_windows_once_passed(materials):
    """Adhesion over 1e-4 of the amplitude, on foundations that forget within a period or in 1e5 of them: an earlier proof by
    windows took an orbit for the first from above that was not."""
    rng = np.random.default_rng((77, 8, True))
    scenes = [ms.draw(rng, 8, True) for _ in range(796)]
    scene = scenes[795] | {name: scenes[795 % materials][name] for name in ("m", "theta")}
    error, allowed, sequence = ms.compare(scene, "loading", ms.solve([scene], "loading"), 0)
    assert error <= allowed and sequence == "afc"


def test_a_foundation_that_forgets_next_to_nothing_in_a_period():
    """States below all orbits hardly move in a period, and what a period changes is lost in the gains of onset and release."""
    scene = {"m": np.array([1.2, 68.3, 11.4, 8.3, 16.8]), "theta": np.array([5.0, 500.0, 1700.0, 1e4, 9.3e4])}
    scene |= {"P0": 2.4332636, "Delta": 1.6691063, "delta": -1.7797235}
    error, allowed, sequence = ms.compare(scene, "unloading", ms.solve([scene], "unloading"), 0)
    assert error <= allowed and sequence == "af"


@pytest.mark.parametrize(("moduli", "times"), [([1.0, 1e5], [2.0, 10.0]), ([1.0, 1e6], [2.0, 1000.0])])
def test_a_contact_far_narrower_than_that_of_the_first_period(moduli, times):
    """Without adhesion, next to a glassy modulus 1e5 times the relaxed one: Newton's steps shrink the contact by a third each."""
    scene = {"m": np.array(moduli), "theta": np.array(times), "P0": 0.0, "Delta": 1.0, "delta": 1.0}
    for branch in ms.BRANCHES:
        error, allowed, sequence = ms.compare(scene, branch, ms.solve([scene], branch), 0)
        assert error <= allowed and sequence == "cf"


def test_random_strips_without_instantaneous_compliance():
    """Kelvin-Voigt, whose two closures are one."""
    rng = np.random.default_rng(9)
    scenes = [ms.draw(rng, 1, wide) | {"viscous": True} for wide in (False, True) for _ in range(25)]
    sequences = set()
    for branch in ms.BRANCHES:
        found = ms.viscous(scenes, branch)
        for i, scene in enumerate(scenes):
            error, allowed, sequence = ms.compare(scene, branch, found, i)
            assert error <= allowed, (scene, branch)
            sequences.add(sequence)
    assert len(sequences) >= 6


def test_fields_are_those_of_the_march():
    """Pressure and gap over the period: at the section of the march and across every zone, by its own flows."""
    from mpmath import mp
    from oracle import modes

    theta, m, P0, Delta, delta = (0.3, 4.0), (2.0, 5.0), 1.5, 0.4, 0.2
    scene = {"theta": np.array(theta), "m": np.array(m), "P0": P0, "Delta": Delta, "delta": delta}
    found = ms.solve([scene], "unloading")
    with mp.workdps(40):
        strip = modes.ModesStrip(modes.Foundation(theta, m), P0, Delta, delta)
        zones, _, _ = modes.extremal(strip, "unloading")
        assert found.regime.item() == "acaf"
        for zone in zones:
            for share in (0.1, 0.5, 0.9):
                s = zone.start + share * (zone.end - zone.start)
                e = modes.advance(strip, zone.letter, zone.start, zone.e, s)
                z = strip.J * mp.fsum(mp.mpf(a) * b for a, b in zip(m, e, strict=True))
                p = {"c": (strip.u(s) - z) / strip.J, "a": -strip.P0, "f": mp.zero}[zone.letter]
                gap = mp.zero if zone.letter == "c" else strip.J * p + z - strip.u(s)
                x = float(-s)
                assert found.pressure(x).item() == pytest.approx(float(p), abs=1e-12)
                assert found.gap(x).item() == pytest.approx(float(gap), abs=1e-12)
                assert found.displacement(x).item() == pytest.approx(float(gap + strip.u(s)), abs=1e-12)
