"""Nodes stand as closely towards an end as what ends there asks for: their places, when they are taken to be enough, and that a
wrong guess costs no digits."""

import numpy as np
import pytest
from numpy.polynomial.chebyshev import chebval

import hystrip
from hystrip.level.averages import level_means
from hystrip.level.curve import smooth_intervals
from hystrip.level.interpolation import interpolate
from hystrip.level.strips import LevelBatch
from hystrip.numerics.chebyshev import flat_ended, lobatto
from hystrip.numerics.gauss import GENTLE, STEEP, graded_gauss, graded_share, left_out

POWERS = [(a, b) for a in (GENTLE, STEEP) for b in (GENTLE, STEEP)]


@pytest.mark.parametrize(("low", "high"), POWERS)
def test_shares_begin_and_end_like_the_powers(low, high):
    t = np.array([1e-6, 2e-6])
    start, end = graded_share(t, low, high), 1 - graded_share(1 - 1e3 * t, low, high)
    assert np.diff(np.log(start)) == pytest.approx(low * np.log(2), rel=1e-4)
    assert np.diff(np.log(end)) == pytest.approx(high * np.log(2), rel=1e-2)
    assert (graded_share(np.array([0.0, 1.0]), low, high) == [0, 1]).all()
    assert (np.diff(graded_share(np.linspace(0, 1, 999), low, high)) > 0).all()


def _missed(function, powers, n):
    """Error of the interpolant through n - 1 nodes of a function of the share."""
    t = np.linspace(0, 1, 1001)
    found = chebval(2 * t - 1, flat_ended(n) @ function(graded_share(lobatto(n)[1:-1], *powers)))
    return np.abs(found - function(graded_share(t, *powers))).max()


def test_ends_are_as_smooth_as_their_powers_make_them():
    """A square root asks for the steep end, a square root of a cube for the gentle one; what is smooth has more digits there."""
    root, cube = lambda s: np.sqrt(s) * np.exp(-s), lambda s: (1 - s) ** 1.5 * np.exp(s)
    assert _missed(root, (STEEP, GENTLE), 24) < 1e-9 and _missed(root, (GENTLE, GENTLE), 24) > 1e-4
    assert _missed(cube, (GENTLE, GENTLE), 16) < 1e-8
    assert _missed(np.exp, (GENTLE, GENTLE), 12) < 1e-2 * _missed(np.exp, (STEEP, STEEP), 12)


def _columns():
    material, adhesion = hystrip.StandardLinearSolid(K=1e9, T_eps=1e-2, T_sigma=1e-4), hystrip.Dugdale(gamma=2.5e-5, delta_0=1e-8)
    V = np.array([1e-2])
    return LevelBatch(material, adhesion, hystrip.Level(l=500e-9, h=100e-9), "continuous", "unloading", V, np.zeros(1))


def _intervals(columns):
    rtol = np.full(1, 1e-5)
    return smooth_intervals(columns, rtol, columns.atol(rtol), columns.saturated.D_sat)


def test_the_top_of_a_curve_ends_gently_and_no_break_does():
    found, _ = _intervals(_columns())
    assert found.size > 2 and not found.inner_low.any()
    assert found.inner_high.tolist() == [k == found.size - 1 for k in range(found.size)]


def test_a_wrong_guess_costs_no_digits():
    columns = _columns()
    found, (crest,) = _intervals(columns)
    hard = found.take(np.flatnonzero(found.low >= crest)[:1])
    hard.inner_low[:] = hard.inner_high[:] = True
    (pieces,) = interpolate(columns, hard)
    assert len(pieces) > 1
    t = np.array([0.13, 0.5, 0.87])
    D = np.concatenate([piece.penetration(t) for piece in pieces])
    means = level_means(columns.at(np.zeros(D.size, int), D), np.full(D.size, 1e-8))
    every, missed = (np.split(each, len(pieces)) for each in (means.values, means.errors))
    for piece, values, errors in zip(pieces, every, missed, strict=True):
        assert (np.abs(piece.values(t) - values) <= piece.errors.most + errors).all()


@pytest.mark.parametrize("n", [12, 20])
@pytest.mark.parametrize(
    "layer",
    [lambda x, d: x / (x + d), lambda x, d: np.sqrt(x + d), np.hypot, lambda x, d: x + 1e-2 * np.exp(-x / d)],
    ids=["pole", "root", "corner", "decay"],
)
def test_what_sums_miss_of_a_layer_is_told(layer, n):
    """A narrow layer next to an end shows in the last coefficients alone, which fall more slowly than those of the rest,
    and come and go: it is told to a factor of three."""
    (share, weight, projection), (fine, exact, _) = graded_gauss(n), graded_gauss(400)
    for d in np.geomspace(1e-4, 1e-1, 13):
        values = layer(share, d)
        missed = abs(exact @ layer(fine, d) - weight @ values)
        assert missed <= 3 * left_out(projection, values[:, None])[0] + 1e-15, d
