"""High-precision reference solution of one strip, by following one material point from event to event.

It shares nothing with the library: no boundary equations of regimes, no generated code. ``solve`` is dimensionless,
``solve_si`` takes SI values and converts floats exactly. See ``flow.py`` for the units and ``orbits.py`` for the
method.
"""

from dataclasses import dataclass, replace
from typing import Any

from mpmath import mp

from .flow import CONTINUOUS, Strip, decay
from .orbits import UNLOADING, attracting_orbits, extremal_orbit

DIGITS = 50


@dataclass(frozen=True)
class Solution:
    """One periodic orbit. In units of ``solve``: p_mean in ``K A``, tau_mean in ``K k A^2``; in SI from ``solve_si``.

    sequence: zones that a material point meets (f free, a adhesion, c contact), rotated to its alphabetically first
    form. edges: paper's edges as phases ``theta = k x``: d and b, and a and c such that contact ends at -a and adhesion
    at -c, all in the one period whose onset lies within pi of ``theta = atan(beta)``. An edge that the sequence lacks
    is missing, and so is d where the point snaps straight into contact at b. slope: of the onset-to-onset map (of the
    phase map of contact entry for "ac", of z for "a", "c", "f"). Errors are amplified by 1/(1 - slope); at a fold it is
    1.
    """

    sequence: str
    edges: dict
    p_mean: Any
    tau_mean: Any
    contact_fraction: Any
    adhesion_fraction: Any
    slope: Any


def solve(alpha, beta, P0, Delta, delta, closure=CONTINUOUS, branch=UNLOADING, digits=DIGITS, J=None):
    """Extremal orbit of a dimensionless strip (see ``flow.Strip``), computed with the given number of digits.

    ``J`` is ``alpha/beta``; give it where that quotient would be rounded and ``J P0 = Delta`` matters.
    """
    with mp.workdps(digits):
        strip = Strip(alpha, beta, P0, Delta, delta, closure, J)
        return _solution(strip, extremal_orbit(strip, branch))


def coexisting(alpha, beta, P0, Delta, delta, closure=CONTINUOUS, digits=DIGITS, J=None):
    """All attracting orbits, from the most to the least engaged."""
    with mp.workdps(digits):
        strip = Strip(alpha, beta, P0, Delta, delta, closure, J)
        return [_solution(strip, orbit) for orbit in attracting_orbits(strip)]


def groups(K, T_eps, T_sigma, V, l, A, D, p_0, delta_0, digits=DIGITS):
    """Arguments of ``solve`` for a strip given in SI: K in Pa/m, times in s, V in m/s, lengths in m, p_0 in Pa."""
    with mp.workdps(digits):
        K, T_eps, T_sigma, V, l, A, D, p_0, delta_0 = map(mp.mpf, (K, T_eps, T_sigma, V, l, A, D, p_0, delta_0))
        rate = 2 * mp.pi / l * V
        return {
            "alpha": rate * T_sigma,
            "beta": rate * T_eps,
            "P0": p_0 / (K * A),
            "Delta": delta_0 / A,
            "delta": D / A,
            "J": T_sigma / T_eps,
        }


def solve_si(K, T_eps, T_sigma, V, l, A, D, p_0, delta_0, edge=CONTINUOUS, branch=UNLOADING, digits=DIGITS):
    """Extremal orbit of a strip given in SI; ``D`` is the strip's own penetration. p_mean and tau_mean in Pa."""
    strip = groups(K, T_eps, T_sigma, V, l, A, D, p_0, delta_0, digits)
    found = solve(**strip, closure=edge, branch=branch, digits=digits)
    with mp.workdps(digits):
        pressure = mp.mpf(K) * mp.mpf(A)
        stress = pressure * mp.mpf(A) * 2 * mp.pi / mp.mpf(l)
        return replace(found, p_mean=found.p_mean * pressure, tau_mean=found.tau_mean * stress)


# -- from an orbit to its means ----------------------------------------------------------------------------------------


def _solution(strip, orbit):
    turn = 2 * mp.pi
    lengths = {letter: mp.zero for letter in "caf"}
    pressure = friction = mp.zero
    for letter, start, end in orbit.zones:
        lengths[letter] += end - start
        if letter != "f":
            integrals = _contact_integrals if letter == "c" else _adhesion_integrals
            force, work = integrals(strip, orbit.contact, start, end)
            pressure, friction = pressure + force, friction + work
    sequence = "".join(letter for letter, _, _ in orbit.zones)
    return Solution(
        min(sequence[i:] + sequence[:i] for i in range(len(sequence))),
        edges_of(orbit.zones),
        pressure / turn,
        friction / turn,
        lengths["c"] / turn,
        lengths["a"] / turn,
        +orbit.slope,
    )


def _adhesion_integrals(strip, _, start, end):
    """Integrals of ``p`` and ``p u'`` over ``p = -P0``."""
    return -strip.P0 * (end - start), -strip.P0 * (mp.cos(end) - mp.cos(start))


def _contact_integrals(strip, contact, start, end):
    """Integrals of ``p`` and ``p u'`` over contact.

    The friction is the mean of ``p u'``: with ``u' = du/ds = -(1/k) du/dx`` it is positive where the foundation takes
    up work, as for the saturated field, ``(beta - alpha)/(2 (1 + alpha^2))``.
    """
    (cos_0, sin_0), (cos_1, sin_1) = mp.cos_sin(start), mp.cos_sin(end)
    in_phase, out_of_phase, length = strip.in_phase, strip.out_of_phase, end - start
    force = strip.mean * length + in_phase * (sin_1 - sin_0) + out_of_phase * (cos_1 - cos_0)
    work = (
        strip.mean * (cos_1 - cos_0)
        + in_phase * (cos_1**2 - cos_0**2) / 2
        + out_of_phase * (length - sin_1 * cos_1 + sin_0 * cos_0) / 2
    )
    if contact.excess:
        alpha, left = strip.alpha, decay(length, strip.alpha)
        force += contact.excess * alpha * (1 - left)
        # alpha (sin s + alpha cos s)/(1 + alpha^2) exp(-(s - start)/alpha) has the derivative -sin s exp(...)
        work += contact.excess * alpha / (1 + alpha**2) * (left * (sin_1 + alpha * cos_1) - (sin_0 + alpha * cos_0))
    return force, work


def edges_of(zones):
    """Paper's edges of the zones; phases are ``theta = -s``, and a, c are minus the phases where their zones end."""
    edges = {}
    if len(zones) > 1:
        for (letter, start, _), (before, _, _) in zip(zones, zones[-1:] + zones[:-1], strict=True):
            if letter == "c":
                edges["b"] = -start
            elif before == "c":
                edges["a"] = +start
            elif letter == "a":
                edges["d"] = -start
            if letter == "f" and before == "a":
                edges["c"] = +start
    return edges
