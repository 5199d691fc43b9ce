"""The numerical methods of ``hystrip.numerics``, against functions whose roots, integrals, inverses and extremes are known."""

import numpy as np
import pytest

from hystrip.numerics import chebyshev, endpoints, quadrature
from hystrip.numerics.adaptive import Samples, approximate, integrate
from hystrip.numerics.intervals import Intervals
from hystrip.numerics.roots import falling_root, rising_root

RNG_SEED = 7


def test_nodes_are_nested_and_leave_out_the_ends():
    for n in (7, 15, 31):
        np.testing.assert_array_equal(chebyshev.nodes(2 * n + 1)[1::2], chebyshev.nodes(n))
        assert 0 < chebyshev.nodes(n)[0] and chebyshev.nodes(n)[-1] < 1


@pytest.mark.parametrize("flat", [(False, False), (True, False), (False, True), (True, True)])
def test_polynomials_are_interpolated_exactly(flat):
    """Of degree n - 1, and one more for each end where the derivative vanishes."""
    n = 7
    factors = [np.poly1d([1, -end]) for end, is_flat in zip((0.0, 1.0), flat, strict=True) if is_flat]
    slope = np.poly1d([0.3, -0.2, 0.4, 0.1, -0.5, 1.0])
    for factor in factors:
        slope *= factor
    polynomial = slope.integ()
    c = chebyshev.interpolation(n, *flat) @ polynomial(chebyshev.nodes(n))[:, None]
    t = np.linspace(0, 1, 50)
    np.testing.assert_allclose(chebyshev.clenshaw(c[:, :, None], np.zeros(50, int), t)[0], polynomial(t), rtol=0, atol=1e-14)
    np.testing.assert_allclose(
        chebyshev.clenshaw(chebyshev.derivative(c)[:, :, None], np.zeros(50, int), t)[0], slope(t), rtol=0, atol=1e-13
    )


@pytest.mark.parametrize("low", endpoints.STRENGTHS)
@pytest.mark.parametrize("high", endpoints.STRENGTHS)
def test_the_endpoint_map(low, high):
    t = np.linspace(0, 1, 41)
    share = endpoints.share(t, low, high)
    assert share[0] == 0 and share[-1] == 1 and (np.diff(share) > 0).sum() >= 38
    # close to 1 rounding of the share is all that is left of its distance from there
    np.testing.assert_allclose(endpoints.parameter(share, low, high)[:20], t[:20], rtol=1e-9)
    np.testing.assert_allclose(1 - endpoints.parameter(share, low, high), 1 - t, atol=2e-16 ** (1 / high) * 2)
    step = 1e-6
    rise = (endpoints.share(t[1:-1] + step, low, high) - endpoints.share(t[1:-1] - step, low, high)) / (2 * step)
    np.testing.assert_allclose(endpoints.slope(t[1:-1], low, high), rise, rtol=1e-6, atol=1e-9)
    tiny = np.array([1e-4, 2e-4])
    assert np.log2(np.divide(*endpoints.share(tiny, low, high)[::-1])) == pytest.approx(low, abs=1e-2)
    mixed = endpoints.share(np.stack((t, t)), np.array([low, 1]), np.array([high, 2]))
    np.testing.assert_array_equal(mixed[0], share)
    np.testing.assert_array_equal(mixed[1], endpoints.share(t, 1, 2))


def test_quadrature_is_exact_for_polynomials_and_says_what_it_misses():
    j = np.arange(40)
    for n in (7, 15):
        for low, high in ((1, 1), (2, 1), (1, 2), (2, 2)):
            x, w = quadrature.rule(n, low, high)
            exact = n - 1 if (low, high) == (1, 1) else (n - 1) // 2 - 1
            powers = j[: exact + 1]
            np.testing.assert_allclose((w[:, None] * x[:, None] ** powers).sum(axis=0), 1 / (1 + powers), atol=1e-15)
            # U_m alone, as a function of t: no larger than the bound, which at rate 0 is that of U_n
            t, fine = chebyshev.nodes(n), chebyshev.nodes(127)
            second = lambda t, m: np.sin((m + 1) * np.arccos(2 * t - 1)) / np.sin(np.arccos(2 * t - 1))  # noqa: E731
            miss = [
                (w * second(t, m)).sum() - (quadrature.weights(127, low, high) * second(fine, m)).sum() for m in range(n, n + 6)
            ]
            bound = quadrature.missed(n, low, high, np.array([0.0, 0.5]))
            assert abs(miss[0]) == pytest.approx(bound[0], abs=1e-14)
            assert (np.abs(miss) * 0.5 ** np.arange(6)).sum() <= bound[1] * (1 + 1e-3)


def test_square_roots_at_both_ends_are_integrated_to_rounding():
    x, w = quadrature.rule(31, 2, 2)
    assert (w * np.sqrt(x * (1 - x))).sum() == pytest.approx(np.pi / 8, abs=1e-14)
    x, w = quadrature.rule(63, 4, 4)
    assert (w * x * np.log(x)).sum() == pytest.approx(-0.25, abs=1e-12)


@pytest.mark.parametrize("with_slope", [True, False])
def test_roots_of_many_functions(with_slope):
    rng = np.random.default_rng(RNG_SEED)
    m = 500
    power, root, steep = rng.choice([1, 3, 5, 9], m), rng.uniform(-1, 1, m), 10 ** rng.uniform(-3, 3, m)

    def function(x, index):
        u, n = np.clip(steep[index] * (root[index] - x), -300, 300), power[index]
        value = np.sinh(u) ** n
        slope = -steep[index] * n * np.sinh(u) ** (n - 1) * np.cosh(u)
        return (value, slope) if with_slope else value

    with np.errstate(over="ignore", invalid="ignore"):
        found = falling_root(function, np.full(m, -1.5), np.full(m, 2.0))
    np.testing.assert_allclose(found.x, root, atol=1e-15 * 8)
    assert (found.low <= found.x).all() and (found.x <= found.high).all()
    simple = power == 1
    assert np.median(found.evaluations[simple]) < 25 and found.evaluations.max() < 160


def test_roots_of_functions_that_jump_or_do_not_cross():
    one = np.ones(1)
    jump = falling_root(lambda x, i: np.where(x < 0.3, 1.0, -1.0), 0 * one, one)
    assert jump.x == pytest.approx(0.3, abs=1e-15) and jump.high - jump.low <= 1e-15
    assert rising_root(lambda x, i: (x - 0.25, np.ones_like(x)), 0 * one, one).x == pytest.approx(0.25)
    assert falling_root(lambda x, i: one, one, one).x == 1 and falling_root(lambda x, i: 1 / 0, 2 * one, one).evaluations == 0
    # the caller's word is not kept: the search ends at an end
    assert falling_root(lambda x, i: one, 0 * one, one).x == pytest.approx(1.0, abs=1e-15)
    loose = falling_root(lambda x, i: np.cos(x), 0 * np.ones(2), 3 * np.ones(2), tolerance=np.array([1e-3, 0.0]))
    assert loose.evaluations[0] < loose.evaluations[1] and abs(loose.x[0] - np.pi / 2) < 1e-3


#: functions of x in [0, 1] with parameters a in (0, 1) and b, their integrals, and the strengths of their ends for ``integrate``
#: and for ``approximate`` (None: not well interpolated without a break)
FAMILIES = {
    "wave": (lambda x, a, b: np.cos(20 * a * x), lambda a, b: np.sinc(20 * a / np.pi), 1, 2),
    "layer": (lambda x, a, b: np.exp(-x / b), lambda a, b: b * -np.expm1(-1 / b), 1, 2),
    "pole": (
        lambda x, a, b: b / ((x - a) ** 2 + b * b),
        lambda a, b: np.arctan((1 - a) / b) + np.arctan(a / b),
        1,
        2,
    ),
    "root": (lambda x, a, b: np.sqrt(x) + a, lambda a, b: 2 / 3 + a, 2, 4),
    "near root": (lambda x, a, b: np.sqrt(x + b), lambda a, b: ((1 + b) ** 1.5 - b**1.5) / 1.5, 2, 4),
    "logarithm": (lambda x, a, b: a * x * np.log(x) + x, lambda a, b: 0.5 - 0.25 * a, 4, 4),
    "kink": (lambda x, a, b: np.abs(x - a), lambda a, b: 0.5 * (a**2 + (1 - a) ** 2), 1, None),
    "hidden root": (lambda x, a, b: np.sqrt(np.abs(x - a)), lambda a, b: (a**1.5 + (1 - a) ** 1.5) / 1.5, 1, None),
}


def parameters(m: int) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    rng = np.random.default_rng(RNG_SEED)
    return rng.uniform(0.02, 0.98, m), 10 ** rng.uniform(-2.5, 0.5, m), 10 ** rng.uniform(-9, -3, m)


@pytest.mark.parametrize("name", FAMILIES)
def test_integrals_are_as_accurate_as_asked_for_and_their_errors_honest(name):
    function, exact, strength, _ = FAMILIES[name]
    a, b, rtol = parameters(200)
    found = integrate(
        lambda i, x: np.stack((function(x, a[i], b[i]), 2 - function(x, a[i], b[i])), axis=1),
        Intervals.make(np.arange(a.size), 0.0, 1.0, strength, strength),
        rtol,
        np.full((a.size, 2), 1e-3),
    )
    truth = np.stack((exact(a, b), 2 - exact(a, b)), axis=1)
    miss, goal = np.abs(found.values - truth), rtol[:, None] * (np.abs(truth) + 1e-3)
    assert found.work.converged.all() and (found.errors <= 1.01 * goal).all()
    # a kink or a root that nobody marked may hide between an end and the node next to it
    hidden = name in ("kink", "hidden root")
    assert np.mean(miss > goal) <= (0.1 if hidden else 0.0)
    assert np.mean(miss > found.errors) <= (0.3 if hidden else 0.025)
    assert np.mean(found.work.evaluations) < (400 if hidden else 110)


@pytest.mark.parametrize("name", [name for name, family in FAMILIES.items() if family[3]])
def test_interpolants_are_as_accurate_as_asked_for_and_their_errors_honest(name):
    function, exact, _, strength = FAMILIES[name]
    a, b, rtol = parameters(100)
    f, work = approximate(
        lambda i, x: function(x, a[i], b[i])[:, None],
        Intervals.make(np.arange(a.size), 0.0, 1.0, strength, strength),
        rtol[:, None],
        a.size,
    )
    x = np.concatenate((np.linspace(0, 1, 101)[1:-1], [1e-9, 1e-5, 1 - 1e-5]))
    member = np.repeat(np.arange(a.size), x.size)
    truth = function(np.tile(x, a.size), a[member], b[member])
    miss = np.abs(f(member, np.tile(x, a.size))[:, 0] - truth).reshape(a.size, -1).max(axis=1)
    rounding = 1e-13 * np.abs(truth).reshape(a.size, -1).max(axis=1)
    assert work.converged.all() and np.mean(miss > rtol + rounding) <= 0.01
    assert np.mean(work.evaluations) < 160
    np.testing.assert_allclose(f.integrals()[:, 0], exact(a, b), rtol=0, atol=2 * rtol.max())


def test_changes_of_label_are_located():
    """A jump that nobody marked, told by labels alone; a member without one takes no part in the search."""
    a = np.array([0.3, 2 / 3, 2.0])

    def function(i, x):
        above = x > a[i]
        return Samples(np.where(above, np.sqrt(np.maximum(x - a[i], 0)) + 1, x)[:, None], above.astype(int))

    found = integrate(function, Intervals.make(np.arange(3), 0.0, 1.0), np.full(3, 1e-9), np.ones((3, 1)))
    low = np.minimum(a, 1)
    truth = 0.5 * low**2 + (1 - low) + (1 - low) ** 1.5 / 1.5
    np.testing.assert_allclose(found.values[:, 0], truth, rtol=0, atol=1e-9)
    assert (np.abs(found.values[:, 0] - truth) <= found.errors[:, 0] + 1e-15).all()
    np.testing.assert_array_equal(found.work.changes, [1, 1, 0])
    assert found.work.evaluations[2] < 10


def test_errors_of_values_are_passed_on_and_no_work_is_wasted_below_them():
    def function(errors):
        return lambda i, x: Samples(np.exp(-9 * x)[:, None], None, np.full((x.size, 1), errors))

    intervals = Intervals.make([0], 0.0, 2.0)
    fine, rough = (integrate(function(e), intervals, np.array([1e-12]), np.ones((1, 1))) for e in (0.0, 1e-3))
    assert rough.errors[0, 0] == pytest.approx(2e-3, rel=0.6) and rough.errors[0, 0] >= 2e-3
    assert rough.work.evaluations[0] < fine.work.evaluations[0]
    f, _ = approximate(function(1e-3), Intervals.make([0], 0.0, 2.0, 2, 2), np.array([1e-12]), 1)
    assert (f.error >= 1e-3).all()


def test_work_is_bounded_and_the_error_says_so():
    """White noise converges nowhere."""
    rng = np.random.default_rng(RNG_SEED)
    noise = lambda i, x: rng.uniform(-1, 1, (x.size, 1))  # noqa: E731
    found = integrate(noise, Intervals.make([0, 1], 0.0, 1.0), np.array([1e-9, 1e3]), np.ones((2, 1)), limit=500)
    assert not found.work.converged[0] and found.work.converged[1]
    assert found.work.evaluations[0] <= 500 and found.errors[0, 0] > abs(found.values[0, 0]) and found.errors[0, 0] > 0.1
    f, work = approximate(noise, Intervals.make([0], 0.0, 1.0, 2, 2), np.array([1e-9]), 1, limit=500)
    assert not work.converged[0] and f.error.max() > 1 and f.intervals.low[0] == 0 and f.intervals.high[-1] == 1


def test_nothing_depends_on_what_else_is_in_the_batch():
    a, b, rtol = parameters(40)
    function = lambda i, x: np.stack((np.abs(x - a[i]), np.exp(-x / b[i])), axis=1)  # noqa: E731
    every = Intervals.make(np.repeat(np.arange(40), 2), np.tile([0.0, 0.5], 40), np.tile([0.5, 1.0], 40))
    together = integrate(function, every, rtol, np.ones((40, 2)))
    pieces, _ = approximate(function, every, rtol[:, None] + np.zeros(2), 40)
    for k in (0, 17):
        one = Intervals.make([0, 0], [0.0, 0.5], [0.5, 1.0])
        alone = integrate(lambda i, x, k=k: function(i + k, x), one, rtol[[k]], np.ones((1, 2)))
        np.testing.assert_array_equal(alone.values[0], together.values[k])
        np.testing.assert_array_equal(alone.errors[0], together.errors[k])
        single, _ = approximate(lambda i, x, k=k: function(i + k, x), one, rtol[[k], None] + np.zeros(2), 1)
        x = np.linspace(0, 1, 200)
        np.testing.assert_array_equal(single(np.zeros(200, int), x), pieces(np.full(200, k), x))


def test_turning_points_minima_and_inverses_of_monotone_parts():
    shift = np.array([0.0, 1.0, 2.5])
    f, _ = approximate(
        lambda i, x: np.stack((np.sin(3 * x + shift[i]), x), axis=1),
        Intervals.between([np.array([0.0, 1.1, 3.0]), np.array([0.0, 3.0]), np.array([0.0, 0.4, 3.0])], 2),
        1e-11,
        3,
    )
    x, least = f.minima(0)
    np.testing.assert_allclose(least, -1, atol=1e-10)
    np.testing.assert_allclose(np.sin(3 * x + shift), -1, atol=1e-10)
    piece, t = f.turning_points(0)
    member = f.intervals.member[piece]
    np.testing.assert_allclose(np.cos(3 * f.place(piece, t) + shift[member]), 0, atol=1e-7)
    assert np.bincount(member).tolist() == [3, 3, 3]
    parts = f.monotone(0)
    every = np.arange(parts.piece.size)
    middle = 0.5 * (parts.place(every, parts.t_low) + parts.place(every, parts.t_high))
    rises = np.cos(3 * middle + shift[f.intervals.member[parts.piece]]) > 0
    np.testing.assert_array_equal(parts.high > parts.low, rises)
    which = np.repeat(np.arange(parts.piece.size), 40)
    value = parts.low[which] + (parts.high - parts.low)[which] * np.tile(np.linspace(0, 1, 40), parts.piece.size)
    t = parts.invert(which, value)
    back = np.sin(3 * parts.place(which, t) + shift[f.intervals.member[parts.piece[which]]])
    np.testing.assert_allclose(back, value, atol=1e-10)
    assert (np.diff(t.reshape(-1, 40)) >= 0).all()
    # beyond its values a part has its ends
    outside = np.array([-9.0, 9.0]) if rises[0] else np.array([9.0, -9.0])
    np.testing.assert_array_equal(parts.invert(np.zeros(2, int), outside), [parts.t_low[0], parts.t_high[0]])


def test_points_between_and_outside_of_pieces():
    f, _ = approximate(lambda i, x: np.where(x < 1, x, x + 10)[:, None], Intervals.make([0, 0], [0, 1], [1, 2], 2, 2), 1e-12, 2)
    np.testing.assert_allclose(f(np.zeros(4, int), np.array([-5.0, 0.5, 1.5, 99.0]))[:, 0], [0, 0.5, 11.5, 12], atol=1e-12)
    with pytest.raises(ValueError, match="no pieces"):
        f(np.ones(1, int), np.ones(1))
    assert np.isnan(f.minima(0)[0][1])
