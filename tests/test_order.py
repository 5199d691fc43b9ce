"""What is pressed deeper is engaged more, and what that spares: strips that are free because a deeper one is."""

from dataclasses import replace

import numpy as np
import pytest
import scenes

import hystrip
from hystrip.level.means import level_means
from hystrip.level.order import FREE, NARROWEST
from hystrip.level.strips import Columns

MATERIAL = hystrip.StandardLinearSolid(K=1e9, T_eps=1e-2, T_sigma=1e-4)
TWO_TIMES = hystrip.Prony(K=1e9, moduli=[3e9, 9e10], times=[1e-3, 1e-4])
WEAK = hystrip.Dugdale(gamma=2.5e-7, delta_0=1e-8)
SMALL = hystrip.Level(l=500e-9, h=100e-9)


@pytest.mark.parametrize("branch", scenes.BRANCHES)
@pytest.mark.parametrize("edge", scenes.EDGES)
def test_a_deeper_strip_is_engaged_more(edge, branch):
    rng = np.random.default_rng(20260501)
    scene = scenes.moderate(rng, 6000)
    deeper = scene | {"D": scene["D"] + scene["A"] * scenes.log_uniform(rng, 1e-9, 1, 6000)}
    one, two = (scenes.solve(s, edge, branch) for s in (scene, deeper))
    assert (one.regime[two.regime == "f"] == "f").all()
    for upper, lower in (
        (one.contact_fraction, two.contact_fraction),
        (one.contact_fraction + one.adhesion_fraction, two.contact_fraction + two.adhesion_fraction),
    ):
        assert (upper <= lower + 1e-9).all()
    # pairs of which nothing is known beforehand, and pairs that differ
    known = (scene["D"] <= -scene["delta_0"]) if branch == "loading" else two.regime != "f"
    assert branch == "loading" or np.count_nonzero(~known) > 500
    assert np.count_nonzero((one.regime == "f") & (two.regime != "f")) > 20


def _columns(edge="continuous", branch="unloading", material=MATERIAL):
    V, share = np.array([1e-4, 2e-3, 3e-2]), np.linspace(-0.3, 1.1, 14)
    V, share = np.repeat(V, share.size), np.tile(share, V.size)
    return Columns(material, WEAK, SMALL, edge, branch, V, share * SMALL.h)


@pytest.mark.parametrize("edge, material", [("continuous", MATERIAL), ("constitutive", MATERIAL), ("constitutive", TWO_TIMES)])
@pytest.mark.parametrize("branch", scenes.BRANCHES)
def test_means_are_bit_identical_without_it(edge, branch, material):
    columns = _columns(edge, branch, material)
    if material is TWO_TIMES:
        columns = columns.at(np.arange(14, 28), columns.D[14:28])
    on, off = (level_means(c, np.full(c.size, 1e-4)) for c in (columns, replace(columns, free=None)))
    assert np.array_equal(on.values, off.values) and np.array_equal(on.errors, off.errors)
    assert all(np.array_equal(one, two) for one, two in zip(on.zones, off.zones, strict=True))
    # the least engaged orbit is free by a threshold, which costs nothing
    assert columns.work.ordered > 25 if branch == "unloading" else columns.work.ordered == 0
    assert on.strips.sum() < off.strips.sum() if branch == "unloading" else np.array_equal(on.strips, off.strips)


def test_only_the_deepest_is_asked():
    columns = _columns().at(np.full(2, 20), np.array([0.5, 0.3]) * SMALL.h)
    zones = level_means(replace(columns, free=None), np.full(2, 1e-4)).zones
    (code, deep, _), (other, shallow, _) = zones[0][-1], zones[1][-1]
    assert code == other == FREE and deep > shallow
    column, low, high = np.arange(2), np.array([deep, shallow]), np.full(2, np.pi)
    question = columns.free.asked(columns, column, low, high)
    asked = [question.theta[question.column == i] for i in column]
    # what both cover is asked of the deeper one only
    assert asked[0].size >= 7 and 0 < asked[1].size < 7 and (asked[1] < deep).all()
    codes, _ = columns.integrand(question.column, question.theta)
    assert question.answered(codes).all() and columns.work.ordered + asked[1].size >= 7
    # and never again, nor of what lies higher
    assert not columns.free.asked(columns, column, low, high).theta.size
    higher = columns.at(np.zeros(1, int), np.array([0.1 * SMALL.h]))
    assert not higher.free.asked(higher, column[:1], low[:1], high[:1]).theta.size
    # but again of what lies deeper
    lower = columns.at(np.zeros(1, int), np.array([0.51 * SMALL.h]))
    assert lower.free.asked(lower, column[:1], low[:1], high[:1]).theta.size >= 7


def test_a_panel_that_is_not_free_is_found_out():
    columns = _columns().at(np.full(2, 20), np.array([0.5, 0.3]) * SMALL.h)
    question = columns.free.asked(columns, np.arange(2), np.zeros(2), np.full(2, np.pi))
    codes, _ = columns.integrand(question.column, question.theta)
    assert (codes != FREE).any() and (codes == FREE).any() and not question.answered(codes).any()


@pytest.mark.parametrize("width", [NARROWEST * (1 + 1e-12), 1.5 * NARROWEST, 1.0, np.pi])
def test_a_panel_is_looked_at_closely(width):
    """As closely as by the nodes of a panel, whose widest step is over a quarter of it."""
    columns = _columns().at(np.zeros(1, int), np.zeros(1))
    for low in np.linspace(0, np.pi - width, 5):
        theta = columns.free.asked(columns, np.zeros(1, int), np.array([low]), np.array([low + width])).theta
        assert theta.size >= 7
        assert np.diff([low, *np.sort(theta), low + width]).max() <= width / 8 * (1 + 1e-9)
