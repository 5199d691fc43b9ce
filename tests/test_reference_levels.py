"""Level means of the reference, at given penetration.

Natural scales: ``K h + p_0`` for pressure, ``h/l`` times that for friction, 1 for fractions; each reference value is known to
``uncertainty (|value| + 1e-3 scale)``.
"""

import functools
import json
from pathlib import Path

import numpy as np
import pytest

import hystrip

LEVELS = json.loads((Path(__file__).parent / "data" / "levels.json").read_text())
NAMES = [f"{i}-{c['edge']}-{c['branch']}-V={c['V']:g}" for i, c in enumerate(LEVELS)]
QUANTITIES = ("p_mean", "tau_mean", "contact_fraction", "adhesion_fraction")


def solved(case, **options):
    material = hystrip.StandardLinearSolid(case["K"], case["T_eps"], case["T_sigma"])
    adhesion = hystrip.Dugdale(p_0=case["p_0"], delta_0=case["delta_0"])
    inputs = {name: case[name] for name in ("V", "D", "edge", "branch")}
    return hystrip.solve_level(material, adhesion, hystrip.Level(case["l"], case["h"]), **inputs | options)


@functools.cache
def closest(number):
    """At the penetration of a case, as accurately as may be."""
    return solved(LEVELS[number], rtol=1e-12)


def sizes(case):
    """``|value| + 1e-3 scale`` of every quantity."""
    p = case["K"] * case["h"] + case["p_0"]
    scales = (p, p * case["h"] / case["l"], 1, 1)
    return np.array([abs(case[name]) + 1e-3 * scale for name, scale in zip(QUANTITIES, scales, strict=True)])


def differences(case, solution):
    return np.array([abs(float(getattr(solution, name)) - case[name]) for name in QUANTITIES])


@pytest.mark.parametrize("case", LEVELS, ids=NAMES)
def test_level(case):
    s = solved(case)
    allowed = (3 * case["uncertainty"] + 1e-6) * sizes(case)
    assert np.all(differences(case, s) <= allowed)
    # what the solver says of itself has to cover what it differs by, as far as the reference can tell
    assert np.all(differences(case, s) <= np.ravel(s.error_estimate) + 3 * case["uncertainty"] * sizes(case))


@pytest.mark.parametrize("number", range(len(LEVELS)), ids=NAMES)
@pytest.mark.parametrize("given", ["D", "p_mean"])
@pytest.mark.xdist_group("closest")  # which are solved once
def test_ten_digits(number, given):
    """At 1e-10 means are what they are at 1e-12. Unloading, those at the pressure of a penetration are those at the
    penetration."""
    case, at = LEVELS[number], closest(number)
    load = {"D": case["D"]} if given == "D" else {"D": None, "pressure": float(at.p_mean)}
    coarse, fine = solved(case, rtol=1e-10, **load), at if given == "D" else solved(case, rtol=1e-12, **load)
    for name, size in zip(QUANTITIES, sizes(case), strict=True):
        assert abs(getattr(coarse, name) - getattr(fine, name)) <= 1e-10 * size
        # loading comes to a pressure below zero somewhere else
        assert case["branch"] == "loading" or abs(getattr(fine, name) - getattr(at, name)) <= 1e-10 * size
    assert np.all(np.ravel(coarse.error_estimate)[:2] <= 1e-10 * sizes(case)[:2])


@pytest.mark.parametrize("case", LEVELS, ids=NAMES)
def test_strips_change_regime_where_the_reference_says(case):
    """Strips on both sides of every transition have the sequences of its neighbours. A transition at a fold is as uncertain as
    the means."""
    y = np.array(case["transitions_y_over_half_period"])
    away = 1e-6 + 2 * case["uncertainty"]
    sides = np.sort(np.concatenate((y - away, y + away)))
    level = hystrip.Level(case["l"], case["h"])
    material = hystrip.StandardLinearSolid(case["K"], case["T_eps"], case["T_sigma"])
    adhesion = hystrip.Dugdale(p_0=case["p_0"], delta_0=case["delta_0"])
    s = hystrip.solve_strip(
        material,
        adhesion,
        l=level.l,
        A=level.amplitude(np.pi * sides),
        D=case["D"] - level.drop(np.pi * sides),
        V=case["V"],
        edge=case["edge"],
        branch=case["branch"],
    )
    expected = np.repeat(case["strip_sequences"], 2)[1:-1]
    assert s.regime.tolist() == expected.tolist()


def test_equal_strips_converge_slowly_towards_it():
    """The paper's equal strips: jumps between regimes leave an error that falls like 1/N only, inside the error estimate."""
    case = LEVELS[0]
    errors = []
    for strips in (30, 100, 1000):
        s = solved(case, strips=strips)
        errors.append(differences(case, s) / sizes(case))
        assert np.all(differences(case, s) <= np.ravel(s.error_estimate) + 3 * case["uncertainty"] * sizes(case))
    worst = np.max(errors, axis=1)
    assert worst[0] < 0.2 and worst[1] < 0.05 and worst[2] < 5e-3
    assert worst[2] > 1e-7  # panels between the transitions do better with a few hundred strips: see test_level
