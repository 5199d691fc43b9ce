"""Friction laws at few and many digits: what a digit costs, and that all of them are right; breaks that several pieces share."""

import numpy as np
import pytest

import hystrip

# what these tests share is solved once, and not in every process
pytestmark = pytest.mark.xdist_group("law digits")

MATERIAL = hystrip.StandardLinearSolid(K=1e9, T_eps=1e-2, T_sigma=1e-4)
ADHESION = hystrip.Dugdale(gamma=2.5e-5, delta_0=1e-8)
LEVEL = hystrip.Level(l=500e-9, h=100e-9)


def law(V, rtol):
    return hystrip.friction_law(MATERIAL, ADHESION, LEVEL, V=V, rtol=rtol)


@pytest.fixture(scope="module")
def laws():
    """The crest lets go at a square root, with its neighbours still holding, and the level is drawn down to its rims."""
    return {rtol: law(1e-4, rtol) for rtol in (1e-4, 1e-6, 1e-8, 1e-10)}


def test_more_digits_take_more_strips_but_not_many(laws):
    strips = [one.strips for one in laws.values()]
    assert sorted(strips) == strips
    # the square of the digits: 1, 2.25, 4, 6.25
    assert strips[3] <= 6.25 * strips[0] * 1.5


def test_digits_are_right(laws):
    finest = laws[1e-10]
    p = np.linspace(finest.pull_off, finest.p_sat, 402)[1:-1]
    size = np.abs(finest(p)) + 1e-3 * (MATERIAL.K * LEVEL.h + ADHESION.p_0) * LEVEL.h / LEVEL.l
    for rtol in (1e-4, 1e-6, 1e-8):
        error = np.abs(laws[rtol](p) - finest(p))
        assert (error <= rtol * size).all()
        assert abs(laws[rtol].pull_off - finest.pull_off) <= rtol * MATERIAL.K * LEVEL.h


def test_pieces_that_share_a_break_have_one_pressure_there():
    """Curves on both sides of the break know its pressure to within their errors only: two breaks a hair apart once put a third
    on top of the friction."""
    coarse, fine = law(1e-3, 1e-3), law(1e-3, 1e-6)
    assert coarse.breaks.size == fine.breaks.size
    # a thousandth of what the coarse one allows
    assert np.allclose(coarse.breaks, fine.breaks, rtol=1e-3 * 1e-3, atol=0)
    assert coarse.breaks[-1] == coarse.p_sat and (coarse.breaks <= coarse.p_sat).all()


def test_a_law_asks_no_more_strips_than_its_pieces_need():
    """Zones of a thousandth of a period, and a curve that turns: means that miss them would be halved down to rounding."""
    found = hystrip.friction_law(MATERIAL, ADHESION, hystrip.Level(l=10e-6, h=1e-6), V=1e-3, rtol=1e-4)
    assert found.strips < 20_000 and found.error_estimate < 1e-3


@pytest.mark.filterwarnings("error")
def test_islands_are_met_as_close_to_their_end_as_nodes_come():
    """Free strips between crest and valley vanish where their fold turns back: 1e-9 before that the level's means still hold a
    share of 1e-4 of them, and those that missed it were halved to rounding (159,034 strips, not converged)."""
    level, at = hystrip.Level(l=10e-6, h=1e-6), {"V": 1e-2, "edge": "constitutive", "below": 0.0}
    found = [hystrip.friction_law(MATERIAL, ADHESION, level, **at, rtol=rtol) for rtol in (1e-4, 1e-6)]
    assert found[1].converged and found[1].strips < 40_000
    # another ends between two curves, and moves by more than it is wide: where it left the window of a search was no break
    assert hystrip.friction_law(MATERIAL, ADHESION, level, V=3e-3, rtol=1e-4).strips < 16_000
    # the least pressure of a hundred penetrations next to where it is, at 1e-10
    assert found[0].pull_off == pytest.approx(-240.3017560, rel=1e-6)
    assert found[1].pull_off == pytest.approx(-240.3017560, rel=1e-9)


@pytest.mark.filterwarnings("error")
def test_pieces_beyond_saturation_are_none():
    """Next to it curves are known to their errors: small pieces end, or even begin, at pressures above."""
    material, adhesion = (
        hystrip.StandardLinearSolid(1e9, 1e-2, 4.125599759e-5),
        hystrip.Dugdale(gamma=1.51068207e-12, delta_0=2.75025e-10),
    )
    levels = [hystrip.Level(1e-5, 1.31396e-6), hystrip.Level(1.94459e-6, 2.30941e-9), hystrip.Level(2.33219e-7, 1.83657e-9)]
    at = {"pressure": 0.0331885, "velocity": 4.53034546e-8, "branch": "loading", "edge": "constitutive"}
    one, other = (hystrip.solve(material, adhesion, levels, **at, rtol=rtol) for rtol in (1.3981e-5, 1e-4))
    assert one.converged and other.converged and abs(one.tau - other.tau) <= one.tau_error + other.tau_error
