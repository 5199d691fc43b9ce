"""Solvers with several relaxation times against what they must come to in their limits."""

from __future__ import annotations

import mpmath
import numpy as np
import pytest
from mode_solvers import orbits_of

import hystrip
from hystrip.derivation.functions import flat
from hystrip.generated import generalised, kelvin_voigt, modes, standard_linear_solid

PARTIAL = ("acaf", "afc", "af", "ac")
SHIPPED = (kelvin_voigt, generalised)


@pytest.mark.parametrize("sequence", PARTIAL)
def test_one_mode_is_the_standard_linear_solid(sequence: str) -> None:
    orbits = orbits_of(sequence)
    assert len(orbits.rows) > 5
    K, found = generalised.material_modes(1.0, *orbits.branch)
    assert orbits.held(generalised, found) < 1e-12


@pytest.mark.parametrize("sequence", PARTIAL)
def test_two_equal_times_are_one(sequence: str) -> None:
    orbits = orbits_of(sequence)
    K_1, tau_1 = orbits.branch
    _, found = generalised.material_modes(1.0, np.concatenate((0.3 * K_1, 0.7 * K_1)), np.concatenate((tau_1, tau_1)))
    assert orbits.held(generalised, found) < 1e-12


@pytest.mark.parametrize("sequence", PARTIAL)
@pytest.mark.parametrize("apart", [1e-15, 1e-12, 1e-9])
def test_two_nearly_equal_times_lose_nothing(sequence: str, apart: float) -> None:
    orbits = orbits_of(sequence)
    K_1, tau_1 = orbits.branch
    _, found = generalised.material_modes(
        1.0, np.concatenate((0.3 * K_1, 0.7 * K_1)), np.concatenate((tau_1, tau_1 * (1 + apart)))
    )
    assert orbits.held(generalised, found) < 1e-12 + 1e2 * apart


@pytest.mark.parametrize("sequence", PARTIAL)
@pytest.mark.parametrize("modulus", [0.0, 1e-300, 1e-15])
@pytest.mark.parametrize("slower", [1e-3, 0.8, 1e4])
def test_a_branch_without_modulus_does_not_count(sequence: str, modulus: float, slower: float) -> None:
    orbits = orbits_of(sequence)
    K_1, tau_1 = orbits.branch
    K_i, tau_i = np.concatenate((modulus * K_1, K_1)), np.concatenate((slower * tau_1, tau_1))
    _, found = generalised.material_modes(1.0, K_i, tau_i)
    assert orbits.held(generalised, found) < 1e-11
    nothing = np.zeros_like(K_1)
    _, found = generalised.material_modes(1.0, np.concatenate((K_i, nothing)), np.concatenate((tau_i, nothing)))
    assert orbits.held(generalised, found) < 1e-11


@pytest.mark.parametrize("sequence", ["acaf", "af", "ac"])
def test_a_vanishing_relaxation_time_is_kelvin_voigt(sequence: str) -> None:
    orbits = orbits_of(sequence, J=0.0)
    assert len(orbits.rows) > 5
    _, found = kelvin_voigt.material_modes(1.0, orbits.beta / orbits.k)
    assert orbits.held(kelvin_voigt, found) < 1e-12
    viscosity = (orbits.beta / orbits.k)[None]
    for ratio in (1e-6, 1e-9, 1e-13):
        tau = viscosity * ratio
        _, found = generalised.material_modes(1.0, viscosity / tau, tau)
        assert orbits.held(generalised, found) < 1e-11 + 1e4 * ratio


@pytest.mark.parametrize("sequence", ["acaf", "afc", "af", "ac"])
def test_without_moduli_the_strip_is_elastic(sequence: str) -> None:
    orbits = orbits_of(sequence, J=1.0)
    assert len(orbits.rows)
    nothing = np.zeros((2, len(orbits.rows)))
    _, found = generalised.material_modes(1.0, nothing, np.ones_like(nothing))
    assert orbits.held(generalised, found) < 1e-12
    p_0, delta_0 = orbits.p_0, orbits.delta_0
    m = generalised.at_speed(found, np.full(len(orbits.rows), orbits.k))
    _, tau_mean = generalised.REGIMES[sequence]["means"](*orbits.edges, m, *orbits.parameters)
    snaps = p_0 >= delta_0
    detached = np.where(snaps, p_0 * delta_0 + p_0**2 / 2 - delta_0**2 / 2, p_0**2)
    assert np.allclose(2 * np.pi * tau_mean, 0.0 if sequence == "ac" else detached, rtol=1e-10, atol=1e-12)


@pytest.mark.parametrize("count", [2, 3, 8])
def test_a_light_contact_under_strong_adhesion_is_that_without_raised_by_p_0(count: int) -> None:
    """Its friction lost the digits by which p_0 is larger than the pressure that contact adds."""
    moduli, times = np.full(count, 10.0 / count), np.logspace(-3, 2, count)
    added, p_0 = 2.0 ** np.arange(-50, -9, 5), 4.0  # exact, and so is their difference
    material, adhesion = hystrip.Prony(K=1.0, moduli=moduli, times=times), hystrip.Dugdale(p_0=p_0, delta_0=8.0)
    strips = hystrip.solve_strip(material, adhesion, l=2 * np.pi, A=1.0, D=added - p_0, V=1.0, edge="constitutive")
    assert set(strips.regime) == {"ac"} and 0.0 < strips.contact_fraction[0] < 1e-6
    m = generalised.at_speed(generalised.material_modes(1.0, moduli, times)[1], np.ones(added.size))
    p_mean, tau_mean = generalised.means_ac(-strips.b, strips.a, m, 0.0, 1.0, added)
    assert np.allclose(strips.tau_mean, tau_mean, rtol=1e-12, atol=0.0)
    assert np.allclose(strips.p_mean, p_mean - p_0, rtol=1e-15, atol=0.0)


def _material(solver, draw) -> tuple[dict, mpmath.mpf, list]:
    n = solver.MODES or 3
    if solver is kelvin_voigt:
        T_eps = 10 ** draw.uniform(-6, 2)
        return {"K": 1e9, "T_eps": T_eps}, mpmath.mpf(1e9), [(mpmath.mpf(T_eps), mpmath.mpf(0))]
    K_i, tau_i = 1e9 * 10 ** draw.uniform(-2, 3, n), 10 ** draw.uniform(-6, 2, n)
    K = mpmath.mpf(1e9)
    return (
        {"K": 1e9, "K_i": K_i, "tau_i": tau_i},
        K,
        [(mpmath.mpf(a) * mpmath.mpf(t) / K, mpmath.mpf(t)) for a, t in zip(K_i, tau_i, strict=True)],
    )


@pytest.mark.parametrize("solver", SHIPPED, ids=lambda s: s.MODEL)
def test_friction_of_full_contact_is_that_of_the_loss_modulus(solver) -> None:
    draw = np.random.default_rng(7)
    for _ in range(40):
        material, K, branches = _material(solver, draw)
        V, lengths, heights = 10 ** draw.uniform(-9, 2), 10 ** draw.uniform(-8, -4, 3), 10 ** draw.uniform(-9, -5, 3)
        stiffness, found = solver.material_modes(**material)
        with mpmath.workdps(50):
            total = mpmath.mpf(0)
            for length, height in zip(lengths, heights, strict=True):
                k = 2 * mpmath.pi / mpmath.mpf(length)
                omega = k * mpmath.mpf(V)
                loss = K * sum(eta * omega / (1 + (tau * omega) ** 2) for eta, tau in branches)
                # A wave surface is, along x, a wave of amplitude (h/4)(1 + cos ky): mean square 3/2 (h/4)^2.
                total += k / 2 * mpmath.mpf(3) / 2 * (mpmath.mpf(height) / 4) ** 2 * loss
            mu = solver.level_saturation_friction(stiffness, found, lengths, heights, V).sum() / 1e5
            assert abs(float(mu / (total / mpmath.mpf(1e5)) - 1)) < 1e-13


@pytest.mark.parametrize("solver", SHIPPED, ids=lambda s: s.MODEL)
def test_saturated_pressure_is_the_loss_and_storage(solver) -> None:
    draw = np.random.default_rng(8)
    material, _, _ = _material(solver, draw)
    _, found = solver.material_modes(**material)
    m = solver.at_speed(found, 3.0)
    s = np.linspace(-4, 4, 50)
    many = modes.for_batch(m, 1)
    expected = 0.7 - 1 + solver.storage(m) * np.cos(s) - solver.loss(m) * np.sin(s)
    assert np.allclose(solver.saturated_pressure(s, 0.7, many), expected, rtol=1e-13, atol=1e-12 * solver.modulus_ratio(m))


@pytest.mark.parametrize("n", (2, 3, 8))
@pytest.mark.parametrize("sequence", PARTIAL)
def test_jacobian_is_the_slope_of_the_residual(n: int, sequence: str) -> None:
    solver = generalised
    draw = np.random.default_rng(9)
    regime = solver.REGIMES[sequence]
    for _ in range(20):
        K_i, tau_i = 10 ** draw.uniform(-1, 1, n), 10 ** draw.uniform(-1.5, 1.5, n)
        _, m = solver.material_modes(1.0, K_i, tau_i)
        edges = np.sort(draw.uniform(-3, 3, len(regime["edges"])))
        rest = (m, *10 ** draw.uniform(-1, 0, 2), draw.uniform(-1, 2))
        residual, jacobian = map(np.array, regime["residual_and_jacobian"](*edges, *rest))
        assert np.allclose(residual, regime["residual"](*edges, *rest), rtol=1e-13, atol=1e-13)
        for k in range(len(edges)):
            step = np.zeros(len(edges))
            step[k] = 1e-4
            points = [np.array(regime["residual"](*(edges + n * step), *rest)) for n in (-2, -1, 1, 2)]
            slope = (points[0] - 8 * points[1] + 8 * points[2] - points[3]) / 12e-4
            assert np.allclose(jacobian[:, k], slope, rtol=1e-7, atol=1e-7 * (1 + np.abs(slope).max()))


@pytest.mark.parametrize("sequence", PARTIAL)
def test_the_return_map_of_one_mode_is_the_onset_slope(sequence: str) -> None:
    orbits = orbits_of(sequence)
    _, found = generalised.material_modes(1.0, *orbits.branch)
    m = generalised.at_speed(found, np.full(len(orbits.rows), orbits.k))
    (slope,) = generalised.REGIMES[sequence]["return_map"](*orbits.edges, m, *orbits.parameters)[0]
    alpha = orbits.J_0 * orbits.beta
    if sequence == "ac":
        width = orbits.edges[1] - orbits.edges[0]
        expected = np.exp(-width / alpha - (2 * np.pi - width) / orbits.beta)
    else:
        upper, lower, _ = standard_linear_solid.REGIMES[sequence]["onset_slope"](
            *orbits.edges, alpha, orbits.beta, orbits.J_0, 1 - orbits.J_0, *orbits.parameters, 1.0
        )
        expected = upper / lower
    assert np.allclose(slope, expected, rtol=1e-7, atol=1e-13)


def test_return_map_of_two_equal_times_has_the_slope_of_one_as_its_only_eigenvalue() -> None:
    orbits = orbits_of("acaf")
    K_1, tau_1 = orbits.branch
    _, one = generalised.material_modes(1.0, K_1, tau_1)
    _, two = generalised.material_modes(1.0, np.concatenate((K_1, 0 * K_1)), np.concatenate((tau_1, tau_1)))
    kV = np.full(len(orbits.rows), orbits.k)
    (slope,) = generalised.return_map_acaf(*orbits.edges, generalised.at_speed(one, kV), *orbits.parameters)[0]
    matrix = generalised.return_map_acaf(*orbits.edges, generalised.at_speed(two, kV), *orbits.parameters)
    largest = np.max(np.abs(np.linalg.eigvals(np.moveaxis(matrix, -1, 0))), axis=1)
    assert np.allclose(largest, np.abs(slope), rtol=1e-9, atol=1e-13)


def test_retardation_times_and_weights_against_60_digits() -> None:
    draw = np.random.default_rng(11)
    for n in (1, 2, 3, 5, 6):
        for _ in range(15):
            eta, tau = 10 ** draw.uniform(-4, 4, n), np.sort(10 ** draw.uniform(-6, 6, n))
            found = modes.spectrum(eta, tau)
            with mpmath.workdps(60):
                e, t = [mpmath.mpf(v) for v in eta], [mpmath.mpf(v) for v in tau]
                for j in range(n):
                    low, high = t[j], t[j + 1] if j + 1 < n else t[j] + sum(e)
                    for _ in range(220):
                        middle = (low + high) / 2
                        above = sum(x / (middle - y) for x, y in zip(e, t, strict=True)) > 1
                        low, high = (middle, high) if above else (low, middle)
                    J = 1 / (low * sum(x / (low - y) ** 2 for x, y in zip(e, t, strict=True)))
                    assert abs(float(found.beta[j] / low - 1)) < 1e-14 and abs(float(found.J[j] / J - 1)) < 2e-14
                    for i in range(n):
                        assert abs(float(found.enter[i, j] / (e[i] / (low - t[i])) - 1)) < 2e-14


@pytest.mark.parametrize("solver", SHIPPED, ids=lambda s: s.MODEL)
def test_no_warning_at_rest_and_far_apart_times(solver) -> None:
    edges = {"acaf": (-2.0, -1.5, 0.5, 1.0), "afc": (-2.0, 0.5, 1.0), "af": (-2.0, 1.0), "ac": (-2.0, 0.5)}
    if solver is kelvin_voigt:
        cases = [{"K": 1.0, "T_eps": time} for time in (0.0, 1e-200, 1.0, 1e200)]
    else:
        n = solver.MODES or 3
        cases = [
            {"K": 1.0, "K_i": np.full(n, stiff), "tau_i": 10.0 ** np.linspace(-spread, spread, n)}
            for stiff in (0.0, 1e-30, 1.0, 1e6)
            for spread in (0.0, 1.0, 9.0)
        ]
    with np.errstate(all="raise", under="ignore"):
        for material in cases:
            _, found = solver.material_modes(**material)
            for kV in (0.0, 1.0, 1e9):
                m = solver.at_speed(found, kV)
                for sequence, regime in solver.REGIMES.items():
                    if not regime["edges"]:
                        continue
                    for kind in ("state", "residual", "residual_and_jacobian", "means"):
                        values = regime[kind](*edges[sequence], m, 0.3, 0.1, 0.2)
                        assert np.all(np.isfinite(flat(values))), (material, kV, sequence, kind)


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"K": 0.0}, "K must be finite and above 0"),
        ({"K": np.nan}, "K must be finite and above 0"),
        ({"K_i": [1.0, -1.0]}, "K_i must be finite and at least 0"),
        ({"tau_i": [1.0, np.inf]}, "tau_i must be finite and at least 0"),
        ({"K_i": [1.0]}, "tau_i must have 1 value along its first axis, not 2 along it"),
        ({"K_i": []}, "K_i must have at least 1 value along its first axis, not 0 along it"),
        ({"tau_i": 1.0}, "tau_i must have 2 values along its first axis, not a single number"),
    ],
)
def test_what_is_no_passive_solid_is_refused(change: dict, message: str) -> None:
    with pytest.raises(ValueError, match=message):
        generalised.material_modes(**{"K": 1.0, "K_i": [1.0, 2.0], "tau_i": [0.1, 1.0], **change})
