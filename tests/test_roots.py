"""Bracketed roots of ``hystrip.numerics``, of functions whose roots are known."""

import numpy as np
import pytest

from hystrip.numerics.roots import falling_root

RNG_SEED = 7


@pytest.mark.parametrize("with_slope", [True, False])
def test_roots_of_many_functions(with_slope):
    rng = np.random.default_rng(RNG_SEED)
    m = 500
    power, root, steep = rng.choice([1, 3, 5, 9], m), rng.uniform(-1, 1, m), 10 ** rng.uniform(-3, 3, m)
    evaluations = np.zeros(m)

    def function(x, index):
        evaluations[index] += 1
        u, n = np.clip(steep[index] * (root[index] - x), -300, 300), power[index]
        value = np.sinh(u) ** n
        slope = -steep[index] * n * np.sinh(u) ** (n - 1) * np.cosh(u)
        return (value, slope) if with_slope else value

    with np.errstate(over="ignore", invalid="ignore"):
        x = falling_root(function, np.full(m, -1.5), np.full(m, 2.0))
    np.testing.assert_allclose(x, root, atol=1e-15 * 8)
    simple = power == 1
    assert np.median(evaluations[simple]) < 25 and evaluations.max() < 160


def test_roots_of_functions_that_jump_or_do_not_cross():
    one = np.ones(1)
    assert falling_root(lambda x, i: np.where(x < 0.3, 1.0, -1.0), 0 * one, one) == pytest.approx(0.3, abs=1e-15)
    assert falling_root(lambda x, i: (0.25 - x, -np.ones_like(x)), 0 * one, one) == pytest.approx(0.25)
    assert falling_root(lambda x, i: 1 / 0, one, one) == 1 and falling_root(lambda x, i: 1 / 0, 2 * one, one) == 1
    # the caller's word is not kept: the search ends at an end
    assert falling_root(lambda x, i: one, 0 * one, one) == pytest.approx(1.0, abs=1e-15)
    asked = []
    loose = falling_root(lambda x, i: asked.append("loose") or np.cos(x), 0 * one, 3 * one, tolerance=1e-3)
    falling_root(lambda x, i: asked.append("close") or np.cos(x), 0 * one, 3 * one)
    assert asked.count("loose") < asked.count("close") and abs(loose - np.pi / 2) < 1e-3


@pytest.mark.filterwarnings("error")
def test_roots_of_functions_that_are_infinite():
    """As what a strip misses that stays engaged: no secant goes through two such values."""
    roots = np.array([0.31, 1e-9])
    found = falling_root(lambda x, index: np.where(x > roots[index], -np.inf, np.inf), np.zeros(2), np.ones(2))
    assert np.allclose(found, roots, rtol=1e-15, atol=0)
