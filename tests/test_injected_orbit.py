"""A wrong orbit that balances: the repelling one between two attracting ones is refused by the certificate."""

from dataclasses import replace

import numpy as np
import pytest
from mpmath import mp
from oracle.flow import Strip
from oracle.orbits import returning_orbits

import hystrip
from hystrip.generated import standard_linear_solid as kernel
from hystrip.orbit import certificate
from hystrip.orbit.chain import refined
from hystrip.orbit.groups import Strips, adhesive_cycle
from hystrip.orbit.march import Orbit
from hystrip.orbit.sensitivity import slope_excess

# alpha, beta, P0, Delta, delta: a repelling orbit between an attracting one with an onset and another without
SCENES = {
    "continuous": (5.35, 14.9, 2.4, 1.13, -1.0),
    "constitutive": (0.2, 7.5, 6.3, 0.64, -2.4),
}
#: the way in D to where the repelling orbit meets an attracting one
DIRECTION = 1.0


def orbits_of(groups, closure):
    """All orbits with an onset, from the most engaged on, by the oracle."""
    with mp.workdps(50):
        return list(returning_orbits(Strip(*groups, closure)))


def as_input(groups, closure, orbit):
    """The orbit and its cycle as the certificate takes them."""
    alpha, beta, P0, Delta, delta = groups
    steps, J = closure == "constitutive", alpha / beta
    values = (alpha, beta, J, 1 - J, P0, Delta, delta, float(steps), steps and J * P0 >= Delta)
    cycle = adhesive_cycle(kernel, Strips(*(np.array([v]) for v in values)))
    ends = {letter: (float(start), float(end)) for letter, start, end in orbit.zones if letter != "a"}
    x = ends["f"][1] - 2 * np.pi
    b, a, c = *ends["c"], ends["f"][0]
    shift = 2 * np.pi * np.round((x - cycle.centre[0]) / (2 * np.pi))
    edges = [np.array([v - shift]) for v in (x, b, a, c)]
    return cycle, Orbit(*edges, np.zeros(1, bool), np.zeros(1))


def residual(groups, closure, orbit):
    alpha, beta, P0, Delta, delta = groups
    edges = [e[0] for e in (orbit.x, orbit.b, orbit.a, orbit.c)]
    return kernel.residual_acaf(
        *edges, alpha, beta, alpha / beta, 1 - alpha / beta, P0, Delta, delta, float(closure == "constitutive")
    )


@pytest.mark.parametrize("closure", SCENES)
def test_only_the_repelling_orbit_is_refused(closure):
    groups = SCENES[closure]
    orbits = orbits_of(groups, closure)
    assert any(orbit.slope > 1 for orbit in orbits) and any(orbit.slope < 1 for orbit in orbits)
    for found in orbits:
        cycle, orbit = as_input(groups, closure, found)
        assert np.max(np.abs(residual(groups, closure, orbit))) < 1e-12  # it balances
        assert certificate.edges_admissible(kernel, cycle, orbit).all()  # and keeps every inequality
        assert certificate.stable(kernel, cycle, orbit).all() == (found.slope < 1)


def test_a_repelling_orbit_next_to_the_fold_is_refused_too():
    """Followed towards the fold, where its slope comes down to one: as long as that is above one by more than rounding."""
    groups = SCENES["continuous"]
    repelling = next(orbit for orbit in orbits_of(groups, "continuous") if orbit.slope > 1)
    cycle, orbit = as_input(groups, "continuous", repelling)
    seen = []
    for delta in groups[4] + np.linspace(0, 0.1, 400)[1:, None] * DIRECTION:
        cycle = adhesive_cycle(kernel, replace(cycle.strips, D=delta))
        found, converged, *_ = refined(kernel, "acaf", cycle, orbit)
        if not converged.all() or abs(found.x - orbit.x)[0] > 0.1:
            break
        orbit = found
        slope = float(slope_excess(kernel, cycle, orbit)[0][0])
        if slope <= 0:
            break
        seen.append(slope)
        assert not certificate.stable(kernel, cycle, orbit).any()
    assert min(seen) < 0.08


def test_an_orbit_that_newton_finds_a_period_later_is_none():
    """On a foundation that hardly moves, strong adhesion snaps in: Newton's method may come to the right orbit a period on, which
    is past all onsets that a search looks at."""
    material, adhesion = hystrip.StandardLinearSolid(1e9, 1e-2, 1.198267784e-4), hystrip.Dugdale(p_0=165.418, delta_0=7.9344e-11)
    D = 3.911971639541966e-9 * (1 + np.linspace(-1e-3, 1e-3, 5))
    how = {"edge": "constitutive", "branch": "loading"}
    s = hystrip.solve_strip(material, adhesion, l=1.087e-7, A=1.9291445e-9, D=D, V=3388.345, **how)
    assert (s.regime == "afc").all() and (np.diff(s.p_mean) > 0).all() and (np.abs(s.b) < 1.087e-7 / 2).all()
