"""Strips with several times next to saturated contact: what is in contact all but for a moment, or in the valley."""

import numpy as np
import pytest

import hystrip

TURN = 2 * np.pi
STEEP = [1904.876013494642, 905.5296108447778], [5.356858381216193e-06, 0.0006887056918480498]
WEAK = hystrip.Dugdale(p_0=0.0011448933147595415, delta_0=0.05014987757811806)
#: moduli and times beside K = 1 at k V = 1, p_0, delta_0: the glassy modulus is thousands of times the relaxed one
NARROW = [
    ([9105.94, 12.975, 2.644], [8.12519e-07, 1.215561e-06, 0.0006959811], 0.00150576, 0.00128871),
    (
        [8028.31, 10.4656, 7536.45, 8.5092, 106.868],
        [1.27558e-07, 1.421e-07, 2.43363e-06, 6.841e-06, 0.00382085],
        0.0035141,
        0.399,
    ),
    ([148.0293, 9545.9208, 28.1108], [8.16472e-07, 1.183666e-06, 0.0410829], 0.00266318, 0.0639107),
]


def test_a_search_from_states_in_contact_finds_the_contact_that_begins_later():
    """Every state below all orbits is in contact in the valley here, and the orbit is not; edges by a march with 30 digits."""
    material = hystrip.Prony(1.0, *STEEP)
    given = {"V": 1.0, "edge": "constitutive"}
    strip = hystrip.solve_strip(material, WEAK, l=TURN, A=1.0, D=2.083874910518454, **given)
    b, a, c, d = 3.26602314388753, 8.44761156241268, 9.07976522262713, 9.21419904331175 - TURN
    assert strip.contact_fraction == pytest.approx((a - b) / TURN, abs=1e-12)
    assert strip.adhesion_fraction == pytest.approx((b - d + c - a) / TURN, abs=1e-12)
    D = np.linspace(2.0, 2.1, 6)
    level = hystrip.solve_level(material, WEAK, hystrip.Level(l=TURN, h=2.0), D=D, rtol=1e-6, **given)
    assert (np.diff(level.p_mean) > 0).all() and level.converged.all()


@pytest.mark.parametrize("branch", ["loading", "unloading"])
@pytest.mark.parametrize("number", range(3))
def test_next_to_saturated_contact_no_strip_is_refused(number, branch):
    """The gap of a strip that is all but saturated opens by less than rounding leaves of its pressures."""
    moduli, times, p_0, delta_0 = NARROW[number]
    material, adhesion = hystrip.Prony(1.0, moduli, times), hystrip.Dugdale(p_0=p_0, delta_0=delta_0)
    R = abs(1 + sum(K * 1j * t / (1 + 1j * t) for K, t in zip(moduli, times, strict=True)))
    short = np.concatenate(([0.0], np.geomspace(1e-15, 1e-7, 150)))
    D = 1 + R - p_0 - short * (1 + R)
    strips = hystrip.solve_strip(material, adhesion, l=TURN, A=1.0, D=D, V=1.0, edge="constitutive", branch=branch)
    # the pressure of saturated contact but for what is missing to it, over the time that it is missing
    missing = (short * (1 + R)) ** 1.5 / np.sqrt(R)
    assert (np.abs(strips.p_mean - (D - 1)) <= missing + 1e-12 * (1 + R)).all()
    # edges are known to 1e-6 there
    assert (strips.contact_fraction >= 1 - 2 * np.sqrt(short * (1 + R) / R) - 1e-6).all()


def test_rubber_between_discrete_and_saturated_adhesion():
    """Thirteen times, adhesion of a few nanometres: refused within 1e-6 of where the gap begins to be released."""
    moduli = [3.93038e11, 4.62615e11, 5.43374e11, 5.63179e11, 5.1537e11, 4.1238e11, 2.87784e11, 1.82925e11, 1.03667e11]
    moduli += [5.52229e10, 2.65143e10, 1.10779e10, 4.02003e9]
    times = [1.82199e-9, 1.73022e-8, 1.4246e-7, 1.12997e-6, 9.07703e-6, 6.86447e-5, 5.05829e-4, 3.63322e-3]
    times += [0.024416, 0.15994, 1.07138, 7.37024, 48.5586]
    material, adhesion = hystrip.Prony(1.00186e11, moduli, times), hystrip.Dugdale(p_0=2500.0, delta_0=1e-8)
    D = 1.250951517096797e-06 * (1 + np.concatenate((-np.logspace(-3, -9, 15), np.logspace(-9, -3, 15))))
    strips = hystrip.solve_strip(
        material, adhesion, l=7.04449e-5, A=3.7728192665e-7, D=D, V=3.2903445623e-4, edge="constitutive", branch="unloading"
    )
    change = np.flatnonzero(strips.regime[1:] != strips.regime[:-1])
    assert change.size == 1 and (np.delete(np.diff(strips.p_mean), change) > 0).all()


@pytest.mark.parametrize("apart", [1e-14, 1e-12, 1e-9])
def test_times_that_differ_by_rounding_are_one(apart):
    """Refused within 1e-10 of each other: rounding leaves nothing to tell the displacements of two such dashpots apart."""
    moduli, times = [179.0, 0.354, 4.79, 187.0], [1.44e-8, 1.44e-8 * (1 + apart), 0.0819, 5.29]
    adhesion, D = hystrip.Dugdale(p_0=1.74e-4, delta_0=7.14e-4), np.linspace(-8.88e-4, 185.83251566986925, 100)
    p_mean = [
        hystrip.solve_strip(material, adhesion, l=TURN, A=1.0, D=D, V=1.0, edge="constitutive", branch="loading").p_mean
        for material in (hystrip.Prony(1.0, moduli, times), hystrip.Prony(1.0, [179.354, 4.79, 187.0], times[1:]))
    ]
    assert p_mean[0] == pytest.approx(p_mean[1], rel=1e-9, abs=1e-12)
